// A guidance virtual fixture: a spring that pulls the hand towards a goal pose in front of a class of points,
// 7.3.2 and 7.4.
#pragma once

#include <optional>
#include <string>

#include "core/dissertation/tool/dynamics/tool_pose.h"
#include "core/dissertation/virtual_fixtures/guidance_target.h"
#include "core/parameters/parameter.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// Decides whether a guidance fixture pulls, and how strongly. If a target is not visible in a frame, the last
// one is used for a while. The force rises and falls gradually. Neither is in the dissertation.

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

enum class GuidedOrientation { fixed, plane };

struct GuidanceSettings {
  GuidedOrientation orientation = GuidedOrientation::fixed;
  Vec3 rotation_deg{0, 0, 0};
  Vec3 approach_axis{1, 0, 0};
  double standoff_m = 0.1;
  Vec3 offset_m{0, 0, 0};
  int min_points = 20;
  double hold_s = 0, fade_s = 0;  // times of GuidancePresence; not in the dissertation
  double stiffness_N_per_m = 200;
  double gyration_radius_m = 0.03;
  double max_force_N = 4;
  double max_torque_Nm = 0.2;
  double reached_deg = 5;
};

Parameters parameters(GuidanceSettings& s);
std::string validate(const GuidanceSettings& s);

// Returns the goal pose of the tool, base frame; nullopt if the target has fewer than min_points points. The
// position is the target's mean, moved back by standoff_m along the approach axis, plus both offsets. The
// orientation is rotation_deg. If GuidedOrientation is plane and the target is flat, it is followed by the
// shortest rotation that turns the approach axis against the normal of the target's plane.
std::optional<ToolPose> guidance_goal(const GuidanceSettings& settings, const GuidanceTarget& target,
                                      const Vec3& more_offset_m = Vec3::Zero());

// Returns the wrench on the hand towards the goal, about the device's position, world frame; limited to
// max_force_N and max_torque_Nm. stiffness_N_per_m: the fixture's own stiffness; if negative, that of the
// settings is used.
Wrench guidance_wrench(const GuidanceSettings& settings, double stiffness_N_per_m, const ToolPose& goal,
                       const ToolPose& device);

}  // namespace remote_touch
