// A guidance virtual fixture: a spring that pulls the hand towards a pose in front of what a class of points
// shows, 7.3.2 and 7.4.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "core/tool/dynamics/tool_pose.h"
#include "core/tool/dynamics/wrench_coupling.h"
#include "core/virtual_fixtures/guidance_target.h"

namespace remote_touch {

enum class GuidedOrientation { fixed, plane };

struct GuidanceSettings {
  GuidedOrientation orientation = GuidedOrientation::fixed;
  Vec3 rotation_deg{0, 0, 0};
  Vec3 approach_axis{1, 0, 0};
  double standoff_m = 0.1;
  Vec3 offset_m{0, 0, 0};
  int min_points = 20;
  double stiffness_N_per_m = 200;
  double gyration_radius_m = 0.03;
  double max_force_N = 4;
  double max_torque_Nm = 0.2;
  double reached_deg = 5;
};

Parameters parameters(GuidanceSettings& s);
std::string validate(const GuidanceSettings& s);

// Where the tool is to go: the approach axis as rotation_deg turns it (fixed), or turned on by the shortest
// way against the normal of the target's plane (plane; as fixed, where the target is not flat); standoff_m
// before the mean against that axis, plus the offset in the base frame. None for fewer points than
// min_points.
std::optional<ToolPose> guidance_goal(const GuidanceSettings& settings, const GuidanceTarget& target,
                                      const Vec3& more_offset_m = Vec3::Zero());

// Towards the goal, on the hand and about the device; force and torque are cut to their largest lengths.
// stiffness: of the fixture; negative: that of the settings.
Wrench guidance_wrench(const GuidanceSettings& settings, double stiffness_N_per_m, const ToolPose& goal,
                       const ToolPose& device);

}  // namespace remote_touch
