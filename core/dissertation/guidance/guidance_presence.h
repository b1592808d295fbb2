// Decides whether a guidance fixture pulls, and how strongly. If a target is not visible in a frame, the last
// one is used for a while. The force rises and falls gradually. Neither is in the dissertation.
#pragma once

#include <optional>

#include "core/dissertation/virtual_fixtures/guidance_target.h"

namespace remote_touch {

class GuidancePresence {
 public:
  // hold_s: time for which the last target is still used after it is lost; it is lost when a frame arrives
  // that has fewer than min_points of its points. fade_s: time in which the force rises from zero to its full
  // value, and in which it falls to zero again; 0: within one tick.
  GuidancePresence(std::size_t min_points, double hold_s, double fade_s)
      : min_points_(min_points), hold_s_(hold_s), fade_s_(fade_s) {}

  // Adds the target of the newest frame, which arrives at arrives_s. A target of fewer than min_points points
  // counts as lost. A target of strength 0 is switched off by its rule: it and the last target are not used.
  void on_frame(const GuidanceTarget& target, double arrives_s);
  // Returns the newest target with min_points points or more, as long as it is visible and for hold_s after
  // it was lost; null after that, before there was one, and when it is switched off.
  const GuidanceTarget* target(double time_s) const;
  // Returns the factor of the force, 0 to 1. Call it once a tick. wanted: the fixture is active and has a
  // target.
  double advance(bool wanted, double time_s);

 private:
  std::size_t min_points_;
  double hold_s_, fade_s_;
  GuidanceTarget seen_;
  bool is_seen_ = false;
  double lost_s_ = 0;  // arrival of the first frame in which it is lost
  double level_ = 0;
  std::optional<double> level_at_s_;  // time of the previous tick
};

}  // namespace remote_touch
