#include "core/dissertation/tool/contact/continuous_contacts.h"

#include <algorithm>
#include <limits>

namespace remote_touch {

namespace {

constexpr std::size_t kMaxStops = 64;
constexpr double kSamePoint_m = 1e-9;
constexpr double kMinSlope = 0.3;  // a smaller slope is at a ridge, where the field is not reliable

// Returns the nearest of the points that can stop the tool; 0 if there is none. pre: there is a point.
std::size_t nearest_outside(const NearPoints& points) {
  std::size_t nearest = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance_m = points.distance_m(i);
    if (distance_m >= -ClearWay::kInside_m && distance_m < least_m) least_m = distance_m, nearest = i;
  }
  return nearest;
}

}  // namespace

ContinuousContacts::ContinuousContacts(const ToolParameters& parameters, const VoxelTool& tool)
    : tool_(tool),
      reach_m_(tool.reach_m + kFieldMargin_m + 3 * tool.grid.size_m),
      way_(tool),
      max_motion_m_(way_.safe_motion_m(parameters.look_ahead_m)) {
  contacts_.reserve(MotionProgram::kMaxContacts + kMaxStops);
  stops_W_.reserve(kMaxStops);
}

void ContinuousContacts::begin(ContactList& points) {
  points_ = &points;
  stops_W_.clear();
}

void ContinuousContacts::add_stops(const ToolPose& pose) {
  for (const Vec3& p_W : stops_W_) {
    const Vec3 p_T = pose.q_WT.conjugate() * (p_W - pose.p_W);
    const FieldSample at = sample_field(tool_, p_T);
    const double slope = at.gradient_T.norm();
    if (slope < kMinSlope) continue;
    contacts_.push_back({p_T, -at.gradient_T / slope, (kGap_m - at.distance_m) / slope, 0});
  }
}

void ContinuousContacts::add_stop(const Vec3& p_W) {
  const bool is_known = std::any_of(stops_W_.begin(), stops_W_.end(),
                                    [&](const Vec3& stop_W) { return (stop_W - p_W).norm() < kSamePoint_m; });
  if (!is_known && stops_W_.size() < kMaxStops) stops_W_.push_back(p_W);
}

NearContacts ContinuousContacts::near(const ToolPose& pose, double side, double) {
  const NearContacts found = points_->near(pose, side);
  contacts_.clear();
  for (ToolContact contact : found.contacts) {
    contact.depth_m += kGap_m;
    contacts_.push_back(contact);
  }
  thinning_.thin(contacts_, ContactThinning::kMaxCount - stops_W_.size());
  add_stops(pose);
  return {contacts_, found.deepest_m + kGap_m};
}

bool ContinuousContacts::has_points_inside(const ToolPose& pose) const {
  return points_->has_point_below(pose, -ClearWay::kInside_m);
}

double ContinuousContacts::known_fraction(const Vector6& a_g) const {
  const double motion_m = max_point_displacement_m(a_g, reach_m_);
  return motion_m > max_motion_m_ ? max_motion_m_ / motion_m : 1;
}

// ahead_W: direction away from which the normals of points can be left out; zero: all matter.
const NearPoints& ContinuousContacts::on_way(const ToolPose& pose, const ClearWay::Motion& motion,
                                             const Vec3& ahead_W) const {
  SlabWay way = way_.slab_way(motion, way_.far_m(motion, reach_m_));
  std::copy_n(ahead_W.data(), 3, way.ahead_W);
  return points_->points_on_way(pose, way);
}

double ContinuousContacts::clear_fraction(const ToolPose& pose, const Vector6& a_g) {
  const ClearWay::Motion motion(pose, a_g);
  double clear = known_fraction(a_g);
  const NearPoints& points = on_way(pose, motion, Vec3::Zero());
  const TiledCloud& cloud = points_->finder().cloud().packed();
  std::size_t first = points.size();
  const auto add = [&](std::size_t i) {
    const double fraction = way_.fraction(motion, points.p_T(i), points.distance_m(i), clear);
    // The stop does not depend on the order: of equal ones it is the first point of the cloud.
    const bool is_first =
        fraction < clear || (fraction == clear && first < points.size() &&
                             cloud.number(points.number(i)) < cloud.number(points.number(first)));
    if (is_first) clear = fraction, first = i;
  };
  // The nearest point often stops the tool first. Then most others need no search.
  if (points.size() > 0) add(nearest_outside(points));
  for (std::size_t i = 0; i < points.size(); ++i) add(i);
  if (first < points.size()) add_stop(pose.p_W + pose.q_WT * points.p_T(first));
  return clear;
}

double ContinuousContacts::fraction_ahead(const ToolPose& pose, const Vector6& a_g, double side) const {
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  const ClearWay::Motion motion(pose, a_g);
  double clear = known_fraction(a_g);
  const NearPoints& points = on_way(pose, motion, side * a_g.head<3>());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 n_T = R_TW * points_->finder().cloud().packed().normal(points.number(i));
    if (!(side * n_T.dot(motion.a_T) < 0)) continue;
    if (points.distance_m(i) < -ClearWay::kInside_m) return 0;
    clear = std::min(clear, way_.fraction(motion, points.p_T(i), points.distance_m(i), clear));
  }
  return clear;
}

}  // namespace remote_touch
