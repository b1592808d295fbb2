#include "core/rivals/inner_sphere_motion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>

namespace remote_touch {
namespace {

// A sphere whose points have less weight than this in sum does not collide: they are on its rim, and the
// rounding of exact sums would show.
constexpr double kMinWeightInSphere = 1e-6;
// A sphere passes no plane on if the mean of its points' normals is shorter than this, as between two walls.
constexpr double kMinMeanNormal = 0.5;
// Largest distance by which points are searched outside the tool. The search has no larger reach.
constexpr double kLargestReach_m = 0.9 * kFieldMargin_m;
constexpr double kUnitBall = 4.0 / 3 * std::numbers::pi;  // volume

Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Weight of the earlier steps in the sum to which the next step is compared.
constexpr double kTrend = 0.5;

}  // namespace

BallCap cap_behind(double radius_m, double height_m) {
  const double h = std::clamp(radius_m - height_m, 0.0, 2 * radius_m);
  return {std::numbers::pi / 3 * h * h * (3 * radius_m - h), std::numbers::pi * h * (2 * radius_m - h)};
}

// offset_of_point: (p - c) / r, shorter than 1. Everything here is in units of the radius.
void PenetrationQuery::PointSums::add(const Vec3& offset_of_point, const Vec3& n_T) {
  const double w = 1 - offset_of_point.squaredNorm();
  const BallCap cap = cap_behind(1, -n_T.dot(offset_of_point));
  const double share = w * cap.volume_m3 / kUnitBall;
  weight.add(w), volume.add(share);
  offset.add(w * offset_of_point), normal.add(w * n_T);
  push.add(share * n_T);
  cut.add(w * cap.disk_m2 / std::numbers::pi, n_T);
}

PenetrationQuery::PenetrationQuery(std::shared_ptr<const InnerSpheres> spheres)
    : made_(std::move(spheres)), locator_(made_->spheres) {
  const std::size_t count = made_->spheres.size();
  sums_.assign(count, PointSums(sum_grid_for(1)));
  has_points_.assign(count, 0), is_queued_.assign(count, 0);
  plane_of_.assign(count, kNoPlane);
  beside_m_.assign(count, 0);
  queue_.assign(count, 0);
  with_points_.reserve(count), planes_.reserve(count), inside_.reserve(count);
}

// Adds every point in a sphere to the sums of that sphere. The field of a point in a sphere is less than a
// voxel above 0, because its errors are smaller than that.
void PenetrationQuery::gather(const ToolPose& pose, const TouchFinder& finder) {
  const TiledCloud& cloud = finder.cloud();
  const VoxelTool& tool = finder.tool();
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  const PointSums none(sum_grid_for(cloud.padded_size()));
  for (const std::uint32_t point : finder.within(pose, std::min(tool.grid.size_m, kLargestReach_m))) {
    const Vec3 p_T = R_TW * (cloud.point(point) - pose.p_W);
    const std::optional<std::uint32_t> i = locator_.at(p_T);
    if (!i) continue;
    const Sphere& sphere = made_->spheres[*i];
    const Vec3 offset = (p_T - sphere.centre) / sphere.radius_m;
    const Vec3 n_W = cloud.normal(point);
    Vec3 n_T = R_TW * n_W;
    if (!n_W.allFinite()) n_T = -sample_field(tool, p_T).gradient_T.normalized();
    if (!(offset.squaredNorm() < 1)) continue;
    if (!has_points_[*i]) has_points_[*i] = 1, sums_[*i] = none, with_points_.push_back(*i);
    sums_[*i].add(offset, n_T);
    sums_[*i].spacing_m = std::max(sums_[*i].spacing_m, cloud.spacing_m(point));
  }
}

// Removes the spheres that do not collide from the list, and computes the planes of the others.
void PenetrationQuery::fit_planes() {
  std::sort(with_points_.begin(), with_points_.end());  // the order of the points has no effect
  std::erase_if(with_points_, [&](std::uint32_t i) {
    if (sums_[i].weight.value() > kMinWeightInSphere) return false;
    has_points_[i] = 0;
    return true;
  });
  for (const std::uint32_t i : with_points_) {
    const double weight = sums_[i].weight.value();
    const Vec3 normal = sums_[i].normal.value();
    const double length = normal.norm();
    if (!(length > kMinMeanNormal * weight)) continue;
    const Sphere& sphere = made_->spheres[i];
    const Vec3 a_T = sphere.centre + sphere.radius_m / weight * sums_[i].offset.value();
    plane_of_[i] = static_cast<std::uint32_t>(planes_.size());
    planes_.push_back({a_T, normal / length, sums_[i].spacing_m, i});
  }
}

// Returns t - r_k.
double PenetrationQuery::distance_beside_m(const Plane& plane, const Sphere& sphere) const {
  const Sphere& from = made_->spheres[plane.sphere];
  const Vec3 offset = sphere.centre - from.centre;
  return (offset - plane.n_T.dot(offset) * plane.n_T).norm() - from.radius_m;
}

// Returns true if a sphere without points of its own takes over a plane.
bool PenetrationQuery::is_inside(const Plane& plane, const Sphere& sphere, double beside_m) const {
  const double height_m = plane.n_T.dot(sphere.centre - plane.a_T);
  if (height_m >= sphere.radius_m) return false;
  const double cut_m2 = sphere.radius_m * sphere.radius_m - height_m * height_m;  // squared radius of the cut
  if (cut_m2 > plane.spacing_m * plane.spacing_m) return false;
  return beside_m <= sphere.radius_m + std::max(0.0, -height_m);
}

// Passes the planes of colliding spheres on, along the neighbours. A sphere is queued again when it takes a
// nearer plane. Each time t - r_k becomes smaller, and there are only as many values of it as planes, so this
// ends.
void PenetrationQuery::spread() {
  std::size_t first = 0, waiting = 0;
  const auto enqueue = [&](std::uint32_t i) {
    if (is_queued_[i]) return;
    is_queued_[i] = 1;
    queue_[(first + waiting++) % queue_.size()] = i;
  };
  for (const Plane& plane : planes_) enqueue(plane.sphere);
  while (waiting > 0) {
    const std::uint32_t i = queue_[first];
    first = (first + 1) % queue_.size(), --waiting;
    is_queued_[i] = 0;
    const Plane& plane = planes_[plane_of_[i]];
    for (const std::uint32_t to : made_->neighbours(i)) {
      if (has_points_[to]) continue;
      const std::uint32_t own = plane_of_[to];
      const Sphere& sphere = made_->spheres[to];
      const double beside_m = distance_beside_m(plane, sphere);
      if (own != kNoPlane && beside_m >= beside_m_[to]) continue;
      if (!is_inside(plane, sphere, beside_m)) continue;
      if (own == kNoPlane) inside_.push_back(to);
      plane_of_[to] = plane_of_[i], beside_m_[to] = beside_m;
      enqueue(to);
    }
  }
}

PenetrationQuery::Effect PenetrationQuery::effect_of_points(std::uint32_t i) const {
  const PointSums& sums = sums_[i];
  const double r = made_->spheres[i].radius_m, weight = sums.weight.value();
  const double volume_m3 = kUnitBall * r * r * r / weight, area_m2 = std::numbers::pi * r * r / weight;
  return {volume_m3 * sums.volume.value(), volume_m3 * sums.push.value(), area_m2 * sums.cut.over(1)};
}

PenetrationQuery::Effect PenetrationQuery::effect_of_plane(std::uint32_t i) const {
  const Sphere& sphere = made_->spheres[i];
  const Plane& plane = planes_[plane_of_[i]];
  const BallCap cap = cap_behind(sphere.radius_m, plane.n_T.dot(sphere.centre - plane.a_T));
  return {cap.volume_m3, cap.volume_m3 * plane.n_T, cap.disk_m2 * plane.n_T * plane.n_T.transpose()};
}

void PenetrationQuery::reset() {
  for (const Plane& plane : planes_) plane_of_[plane.sphere] = kNoPlane;
  for (const std::uint32_t i : inside_) plane_of_[i] = kNoPlane;
  for (const std::uint32_t i : with_points_) has_points_[i] = 0;
  with_points_.clear(), planes_.clear(), inside_.clear();
}

SpherePenetration PenetrationQuery::penetration(const ToolPose& pose, const TouchFinder& finder) {
  gather(pose, finder);
  fit_planes();
  spread();
  SpherePenetration all;
  const auto add = [&](std::uint32_t i, const Effect& effect) {
    if (!(effect.volume_m3 > 0)) return;
    const Vec3& c = made_->spheres[i].centre;
    ++all.spheres;
    all.volume_m3 += effect.volume_m3;
    all.wrench_T.head<3>() += effect.push_T, all.wrench_T.tail<3>() += c.cross(effect.push_T);
    Eigen::Matrix<double, 6, 3> lines;
    lines << Eigen::Matrix3d::Identity(), cross_matrix(c);
    all.slope_T += lines * effect.cut_T * lines.transpose();
  };
  for (const std::uint32_t i : with_points_) add(i, effect_of_points(i));
  for (const std::uint32_t i : inside_) add(i, effect_of_plane(i));
  reset();
  return all;
}

Parameters parameters(InnerSphereParameters& p) {
  const Parameters own = {
      {"inner_spheres", &p.inner_spheres, 1, kMaxInnerSpheres,
       "largest number of spheres that fill the tool without overlap; fewer if no more of 0.9 voxels fit"},
      {"volume_stiffness_N_per_m3", &p.volume_stiffness_N_per_m3, 1e3, 1e13,
       "k_V: force of a sphere per volume of its part in the scene"},
      {"steps_per_tick", &p.steps_per_tick, 1, 1000,
       "maximum number of steps in a tick, each half a voxel or less; a tick that needs more sets budget_exhausted"},
      {"rest_threshold_m", &p.rest_threshold_m, 0, 1e-3, "the tick ends when a step is shorter than this"},
  };
  return appended(own, parameters(p.coupling));
}

ToolParameters tool_parameters(const InnerSphereParameters& p) {
  ToolParameters tool = tool_parameters(p.coupling);
  tool.contact_rule = ContactRule::voxels;  // points touch, and not disks
  tool.rest_threshold_m = p.rest_threshold_m;
  return tool;
}

InnerSphereMotion::InnerSphereMotion(const InnerSphereParameters& parameters, const VoxelTool& tool)
    : InnerSphereMotion(
          parameters, tool,
          std::make_shared<const InnerSpheres>(make_inner_spheres(tool, parameters.inner_spheres))) {}

InnerSphereMotion::InnerSphereMotion(const InnerSphereParameters& parameters, const VoxelTool& tool,
                                     std::shared_ptr<const InnerSpheres> spheres)
    : p_(parameters),
      reach_m_(tool.reach_m),
      max_step_m_(0.5 * tool.grid.size_m),
      query_(std::move(spheres)) {}

// Returns the step in world axes. The linearisation: a displacement of the tool moves the cut of each sphere,
// which changes the volume by the area of the cut times the motion along the normal.
Vector6 InnerSphereMotion::balancing_step(const ToolPose& pose, const ToolPose& device,
                                          const SpherePenetration& in) const {
  const double k = p_.coupling.stiffness_N_per_m, k_V = p_.volume_stiffness_N_per_m3;
  const double turning = k * p_.coupling.gyration_radius_m * p_.coupling.gyration_radius_m;
  Vector6 spring;
  spring << k, k, k, turning, turning, turning;
  const Vector6 wanted_T = rotated(pose.q_WT.conjugate(), displacement(pose, device));
  Eigen::Matrix<double, 6, 6> stiffness = k_V * in.slope_T;
  stiffness.diagonal() += spring;
  return rotated(pose.q_WT, stiffness.ldlt().solve(spring.cwiseProduct(wanted_T) + k_V * in.wrench_T));
}

bool InnerSphereMotion::turns_back(const Vector6& step, const Vector6& trend) const {
  return step.head<3>().dot(trend.head<3>()) + reach_m_ * reach_m_ * step.tail<3>().dot(trend.tail<3>()) < 0;
}

// Points that enter and leave spheres can move the balance to and fro forever. So the limit of the steps is
// halved whenever a step in contact turns back, until it is below the rest threshold.
ToolMotionReport InnerSphereMotion::move(ToolPose& pose, const ToolPose& device, ContactList& contacts,
                                         bool) {
  ToolMotionReport report;
  const Vec3 start_W = pose.p_W;
  double limit_m = max_step_m_;
  Vector6 trend = Vector6::Zero();
  while (!report.at_rest && report.steps < p_.steps_per_tick) {
    const SpherePenetration in = query_.penetration(pose, contacts.finder());
    Vector6 step = balancing_step(pose, device, in);
    if (in.spheres > 0 && turns_back(step, trend)) limit_m *= 0.5;
    step = capped(step, reach_m_, limit_m);
    trend = kTrend * trend + step;
    ++report.detections, ++report.steps;
    report.active_count = in.spheres;
    report.push_W = pose.q_WT * Vec3(in.wrench_T.head<3>());
    report.at_rest = max_point_displacement_m(step, reach_m_) <= p_.rest_threshold_m;
    pose = in.spheres == 0 && report.at_rest ? device : moved(pose, step);
  }
  report.first_step_m = pose.p_W - start_W;
  return report;
}

}  // namespace remote_touch
