#include "core/dissertation/guidance/guidance_spring.h"

#include <algorithm>
#include <utility>

#include "core/dissertation/tool/dynamics/wrench_coupling.h"

namespace remote_touch {

void GuidancePresence::on_frame(const GuidanceTarget& target, double arrives_s) {
  const bool is_off = target.strength == 0;
  const bool was_seen = std::exchange(is_seen_, !is_off && target.points >= min_points_);
  if (is_off)
    seen_ = {};
  else if (is_seen_)
    seen_ = target;
  else if (was_seen)
    lost_s_ = arrives_s;
}

const GuidanceTarget* GuidancePresence::target(double time_s) const {
  if (is_seen_) return &seen_;
  const bool is_held = hold_s_ > 0 && seen_.is_visible() && time_s - lost_s_ < hold_s_;
  return is_held ? &seen_ : nullptr;
}

double GuidancePresence::advance(bool wanted, double time_s) {
  const double since_s = time_s - level_at_s_.value_or(time_s);
  level_at_s_ = time_s;
  const double change = fade_s_ > 0 ? since_s / fade_s_ : 1;
  level_ = std::clamp(wanted ? level_ + change : level_ - change, 0.0, 1.0);
  return level_;
}

namespace {

// Returns the shortest rotation that turns one unit vector into another. If the vectors are opposite, every
// half-turn about a perpendicular axis is the shortest, and one of them is returned.
Eigen::Quaterniond shortest_rotation(const Vec3& from, const Vec3& to) {
  constexpr double kOpposite = 1e-9;
  const double w = 1 + from.dot(to);
  if (w > kOpposite) {
    const Vec3 v = from.cross(to);
    return Eigen::Quaterniond(w, v.x(), v.y(), v.z()).normalized();
  }
  int min = 0;
  from.cwiseAbs().minCoeff(&min);
  const Vec3 axis = from.cross(Vec3::Unit(min)).normalized();
  return {0, axis.x(), axis.y(), axis.z()};
}

}  // namespace

Parameters parameters(GuidanceSettings& s) {
  return {
      {"orientation", choice(s.orientation, {"fixed", "plane"}), 0, 0,
       "orientation of the goal: fixed: rotation_deg; plane: perpendicular to the plane of the target's points, if they lie in a plane"},
      {"rotation_deg", &s.rotation_deg, -360, 360,
       "rotation vector (axis times angle) from the axes of the tool to the goal, base frame"},
      {"approach_axis", &s.approach_axis, -1, 1, "axis of the tool that points at the target, tool frame"},
      {"standoff_m", &s.standoff_m, 0, 1, "distance of the goal from the target, against the approach axis"},
      {"offset_m", &s.offset_m, -1, 1, "offset added to the goal, base frame"},
      {"min_points", &s.min_points, 1, 1000000,
       "minimum number of points of a target; with fewer, the target is lost"},
      {"hold_s", &s.hold_s, 0, 10,
       "time for which guidance uses the last target after it was lost; 0: the guidance force ends with the frame in "
       "which it is lost"},
      {"fade_s", &s.fade_s, 0, 10,
       "time over which the guidance force rises when it begins, and falls when it ends; 0: in one tick"},
      {"stiffness_N_per_m", &s.stiffness_N_per_m, 0, 10000,
       "stiffness of the spring to the goal, for fixtures without their own"},
      {"gyration_radius_m", &s.gyration_radius_m, 0, 1,
       "rotational stiffness = stiffness times this squared"},
      {"max_force_N", &s.max_force_N, 0, 1000, "maximum magnitude of the guidance force"},
      {"max_torque_Nm", &s.max_torque_Nm, 0, 100, "maximum magnitude of the guidance torque"},
      {"reached_deg", &s.reached_deg, 0, 180,
       "the goal counts as reached when the tool is within radius_m (of the fixture rule) and within this angle of it"},
  };
}

std::string validate(const GuidanceSettings& s) {
  if (s.approach_axis.norm() < 1e-3) return "approach_axis: expected a vector of length 0.001 or more";
  return {};
}

std::optional<ToolPose> guidance_goal(const GuidanceSettings& s, const GuidanceTarget& target,
                                      const Vec3& more_offset_m) {
  if (target.points < static_cast<std::size_t>(s.min_points)) return {};
  ToolPose goal;
  goal.q_WT = rotation(kRadiansPerDegree * s.rotation_deg);
  Vec3 approach_W = goal.q_WT * s.approach_axis.normalized();
  if (s.orientation == GuidedOrientation::plane && target.is_flat()) {
    goal.q_WT = (shortest_rotation(approach_W, -target.normal_W) * goal.q_WT).normalized();
    approach_W = -target.normal_W;
  }
  goal.p_W = target.mean_W - s.standoff_m * approach_W + s.offset_m + more_offset_m;
  return goal;
}

Wrench guidance_wrench(const GuidanceSettings& s, double stiffness_N_per_m, const ToolPose& goal,
                       const ToolPose& device) {
  const WrenchSpring spring{stiffness_N_per_m >= 0 ? stiffness_N_per_m : s.stiffness_N_per_m,
                            s.gyration_radius_m, s.max_force_N, s.max_torque_Nm};
  return coupling_wrench(spring, Eigen::Matrix3d::Identity(), goal, device);
}

}  // namespace remote_touch
