// Decides whether a guidance fixture pulls, and how strongly. A target that a frame does not show is
// remembered for a while, and the force rises and falls gradually. Neither is in the dissertation.
#pragma once

#include <optional>

#include "core/dissertation/virtual_fixtures/guidance_target.h"

namespace remote_touch {

class GuidancePresence {
 public:
  // hold_s: time for which the last target is used after the arrival of the first frame with fewer than
  // min_points of its points. fade_s: time in which the force rises from zero to its full value, and falls
  // again; 0: in one tick.
  GuidancePresence(std::size_t min_points, double hold_s, double fade_s)
      : min_points_(min_points), hold_s_(hold_s), fade_s_(fade_s) {}

  // Adds the target of the newest frame, which arrives at arrives_s. A target of fewer than min_points points
  // counts as lost.
  void on_frame(const GuidanceTarget& target, double arrives_s);
  // Returns the newest target with min_points points or more, while it is visible and for hold_s after it was
  // lost; else null.
  const GuidanceTarget* target(double time_s) const;
  // Returns the factor of the force, 0 to 1. Call it once a tick. wanted: the fixture is active and has a
  // target.
  double advance(bool wanted, double time_s);

 private:
  std::size_t min_points_;
  double hold_s_, fade_s_;
  GuidanceTarget seen_;
  bool is_seen_ = false;
  double lost_s_ = 0;  // arrival of the first frame without it
  double level_ = 0;
  std::optional<double> level_at_s_;  // time of the previous tick
};

}  // namespace remote_touch
