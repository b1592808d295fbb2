// The steps of 4.2.3 that were computed before. On noisy points they often end in a cycle: the proxy returns
// to exactly the same positions, tick after tick, while the HIP and the frame stay the same.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/vector.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// One step of the proxy, world frame.
struct KnownStep {
  Vec3 proxy_W;                  // where the step begins
  Vec3 normal_W;                 // (4.1); zero if it has no direction there
  Vec3 motion_m = Vec3::Zero();  // (4.4) to (4.12)
  ContactState state;            // 4.2.1
  double stiffness_N_per_m;      // (5.8)
};

// A table of steps by their first position. It is a cache: a step that it does not return is computed again.
class KnownSteps {
 public:
  KnownSteps();
  // Forgets all steps. Call it when the cloud or the settings change.
  void forget() { ++generation_; }
  // Forgets all steps if the HIP has moved, compared bit for bit.
  void set_hip(const Vec3& hip_W);
  // Returns the step from this position, compared bit for bit, or null. Valid until the next remember().
  const KnownStep* from(const Vec3& proxy_W) const;
  // Stores a step. It may replace one from another position.
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
