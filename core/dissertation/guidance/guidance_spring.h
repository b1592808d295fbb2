// A guidance virtual fixture: a spring that pulls the hand towards a goal pose in front of a class of points,
// 7.3.2 and 7.4.
#pragma once

#include <string>

#include "core/dissertation/tool/dynamics/tool_pose.h"
#include "core/dissertation/virtual_fixtures/guidance_target.h"
#include "core/parameters/parameter.h"
#include "core/rendering/wrench.h"

namespace remote_touch {

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
