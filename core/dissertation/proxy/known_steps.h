// A cache of the steps of the proxy (4.2.3). On noisy points the proxy often moves in a cycle: it returns to
// exactly the same positions, tick after tick, while the HIP and the frame do not change.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/vector.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// One step of the proxy, world frame.
struct KnownStep {
  Vec3 proxy_W;                  // position at which the step begins
  Vec3 normal_W;                 // (4.1) at this position; zero if it has no direction
  Vec3 motion_m = Vec3::Zero();  // (4.4) to (4.12)
  ContactState state;            // 4.2.1
  double stiffness_N_per_m;      // (5.8)
};

// A table of steps, each of which is found by the position at which it begins. The table is a cache: it may
// lose a step, which then has to be computed again.
class KnownSteps {
 public:
  KnownSteps();
  // Forgets all steps. Call it when the cloud or the settings change.
  void forget() { ++generation_; }
  // Forgets all steps if the HIP has another position than in the last call, compared bit for bit.
  void set_hip(const Vec3& hip_W);
  // Returns the step that begins at this position, compared bit for bit; null if the table does not hold it.
  // Valid until the next remember().
  const KnownStep* from(const Vec3& proxy_W) const;
  // Stores a step. It may replace a step that begins at another position.
  void remember(const KnownStep& step);

 private:
  struct Entry {
    std::uint64_t generation = 0;
    KnownStep step;
  };
  std::vector<Entry> entries_;
  std::uint64_t generation_ = 1;
  Vec3 hip_W_ = Vec3::Zero();
};

}  // namespace remote_touch
