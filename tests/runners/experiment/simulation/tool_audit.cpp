#include "tests/runners/experiment/simulation/tool_audit.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {
// Halving ends at this length: no interval would be short enough for a point exactly as deep as the
// tolerance.
constexpr double kRounding_m = 1e-12;
constexpr std::size_t kGroupPoints = 32;
}  // namespace

// Position of a point in the tool frame while the tool moves; s from 0 to 1.
struct ToolAuditor::Way {
  const ToolPose& from;
  const Vec3 shift_W, turn_W;
  const Vec3 p_W;
  const Vec3 point_shift_W = Vec3::Zero();

  Vec3 at(double s) const {
    const Eigen::Quaterniond q_WT = rotation(s * turn_W) * from.q_WT;
    return q_WT.conjugate() * (p_W + s * point_shift_W - from.p_W - s * shift_W);
  }
};

ToolAuditor::ToolAuditor(const TriangleMesh& mesh, double tolerance_m)
    : tree_(mesh), tolerance_m_(tolerance_m) {
  for (const Vec3& v : mesh.vertices) reach_m_ = std::max(reach_m_, v.norm());
}

void ToolAuditor::on_frame(const PointCloud& cloud) {
  points_.clear();
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.point(i).allFinite()) points_.push_back({cloud.point(i)});
  gather_groups();
}

void ToolAuditor::gather_groups() {
  groups_.clear();
  for (std::size_t first = 0; first < points_.size(); first += kGroupPoints) {
    const std::size_t last = std::min(first + kGroupPoints, points_.size());
    Group group{Vec3::Zero(), 0, first, last, false};
    for (std::size_t i = first; i < last; ++i) group.centre_W += points_[i].p_W;
    group.centre_W /= static_cast<double>(last - first);
    for (std::size_t i = first; i < last; ++i)
      group.radius_m = std::max(group.radius_m, (points_[i].p_W - group.centre_W).norm());
    groups_.push_back(group);
  }
}

double ToolAuditor::signed_distance_m(const Vec3& p_T, int& face) const {
  const TriangleTree::Nearest nearest = tree_.nearest(p_T, face);
  face = nearest.face;
  const double distance_m = std::sqrt(nearest.squared_m2);
  return tree_.winding_number(p_T) > 0.5 ? -distance_m : distance_m;
}

double ToolAuditor::signed_distance_m(const Vec3& p_T) {
  int face = 0;
  return signed_distance_m(p_T, face);
}

// Returns the depth of a position on this part of the way that is deeper than the tolerance, 0 if none is.
// max_m: upper bound of the point's motion on the whole way.
double ToolAuditor::depth_on(const Way& way, double from, double until, double max_m, int& face) {
  const double middle = 0.5 * (from + until), half_m = 0.5 * (until - from) * max_m;
  const double distance_m = signed_distance_m(way.at(middle), face);
  if (distance_m < -tolerance_m_) return -distance_m;
  if (distance_m + tolerance_m_ >= half_m || half_m < kRounding_m) return 0;
  const double before = depth_on(way, from, middle, max_m, face);
  return before > 0 ? before : depth_on(way, middle, until, max_m, face);
}

void ToolAuditor::check(Point& point, const Way& way, double max_m) {
  if (!point.is_known) {
    point.is_inside = signed_distance_m(way.at(0), point.face) < -tolerance_m_;
    point.is_known = true;
  }
  if (point.is_inside) {
    ++audit_.inside;
  } else if (const double depth_m = depth_on(way, 0, 1, max_m, point.face); depth_m > 0) {
    ++audit_.entered;
    audit_.deepest_m = std::max(audit_.deepest_m, depth_m);
  }
  const double end_m = signed_distance_m(way.at(1), point.face);
  point.is_inside = end_m < -tolerance_m_;
  point.clear_m = end_m;
}

void ToolAuditor::tick(Group& group, const ToolPose& from, const Vec3& shift_W, const Vec3& turn_W) {
  const double shift_m = shift_W.norm(), turn_rad = turn_W.norm();
  audit_.point_ticks += static_cast<std::int64_t>(group.last - group.first);
  // The tool cannot reach a far group, however it turns.
  const bool is_far = (group.centre_W - from.p_W).norm() - group.radius_m - shift_m > reach_m_ + tolerance_m_;
  for (std::size_t i = group.first; i < group.last && !is_far; ++i) {
    Point& point = points_[i];
    if (group.was_far) point.is_known = true, point.is_inside = false, point.clear_m = 0;
    const double from_centre_m = (point.p_W - from.p_W).norm();
    const double max_m = shift_m + turn_rad * (from_centre_m + shift_m);
    point.clear_m = std::max(point.clear_m - max_m, from_centre_m - shift_m - reach_m_);
    if (point.clear_m > 0)
      point.is_known = true, point.is_inside = false;
    else
      check(point, {from, shift_W, turn_W, point.p_W}, max_m);
  }
  group.was_far = is_far;
}

void ToolAuditor::tick_with_frame(const PointCloud& cloud, const ToolPose& from, const ToolPose& to) {
  const Vec3 shift_W = to.p_W - from.p_W;
  const Vec3 turn_W = rotation_vector(to.q_WT * from.q_WT.conjugate());
  std::size_t next = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.point(i).allFinite()) continue;
    Point& point = points_.at(next++);
    const Vec3 point_shift_W = cloud.point(i) - point.p_W;
    const double relative_m = (shift_W - point_shift_W).norm();
    point.is_known = false;
    ++audit_.point_ticks;
    check(point, {from, shift_W, turn_W, point.p_W, point_shift_W},
          relative_m + turn_W.norm() * ((point.p_W - from.p_W).norm() + relative_m));
    point.p_W = cloud.point(i), point.clear_m = 0;
  }
  gather_groups();
}

void ToolAuditor::tick(const ToolPose& from, const ToolPose& to) {
  const Vec3 shift_W = to.p_W - from.p_W;
  const Vec3 turn_W = rotation_vector(to.q_WT * from.q_WT.conjugate());
  for (Group& group : groups_) tick(group, from, shift_W, turn_W);
}

}  // namespace remote_touch
