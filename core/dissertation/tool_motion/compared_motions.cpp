#include "core/dissertation/tool_motion/compared_motions.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/dissertation/tool_motion/tool_renderer.h"

namespace remote_touch {
namespace {

// A contact counts as touched if its distance exceeds the gap by no more than this.
constexpr double kTouching_m = 1e-6;
// A contact at which more than this distance is missing was put there by a frame.
constexpr double kTolerance_m = 2 * ContinuousContacts::kGap_m;
// A tick ends after this number of successive steps without progress, or of steps that contacts stop at once.
constexpr int kGodObjectPatience = 8;

constexpr int kAxisBits = 21;
constexpr double kMaxVoxels = 1 << (kAxisBits - 1);
constexpr std::uint64_t kFree = ~std::uint64_t{0};  // no key has its highest bit

// The multiplier of splitmix64.
constexpr std::uint64_t kMix = 0xbf58476d1ce4e5b9;

constexpr int kFullPoints = 10;  // if more points push, all are scaled as if this many did

struct PreparedVoxmap final : FramePreparation {
  PreparedVoxmap(const PointCloud& cloud, double voxel_m) : map(cloud, voxel_m) {}
  Voxmap map;
};

}  // namespace

Parameters parameters(ToolGodObjectParameters& p) {
  const Parameters own = {
      {"steps_per_tick", &p.steps_per_tick, 1, 1000,
       "maximum number of steps in a tick, each up to the first new contact; a tick that needs more sets budget_exhausted"},
      {"max_step_m", &p.max_step_m, 1e-5, 2e-3, "maximum displacement of any point of the tool in a step"},
      {"rest_threshold_m", &p.rest_threshold_m, 0, 1e-3, "the tick ends when a step is shorter than this"},
      {"disk_radius_ratio", &p.disk_radius_ratio, 0, 2,
       "each point is a disk, a small face of the scene; its radius is this value times the point spacing; 0: points only"},
  };
  return appended(own, parameters(p.coupling));
}

std::string validate(const ToolGodObjectParameters& p) {
  if (10 * p.rest_threshold_m > p.max_step_m)
    return "rest_threshold_m = " + std::to_string(p.rest_threshold_m) +
           ": expected a tenth of max_step_m or less";
  return {};
}

ToolParameters tool_parameters(const ToolGodObjectParameters& p) {
  ToolParameters tool = tool_parameters(p.coupling);
  tool.contact_rule = ContactRule::continuous;  // disks are counted
  tool.max_step_m = p.max_step_m;
  tool.rest_threshold_m = p.rest_threshold_m;
  tool.disk_radius_ratio = p.disk_radius_ratio;
  return tool;
}

GodObjectMotion::GodObjectMotion(const ToolGodObjectParameters& parameters, const VoxelTool& tool)
    : p_(parameters),
      reach_m_(tool.reach_m),
      max_step_m_(parameters.max_step_m),
      near_(tool_parameters(parameters), tool),
      program_(even_inertia_m2(parameters.coupling.gyration_radius_m)) {
  touched_.reserve(static_cast<std::size_t>(MotionProgram::kMaxContacts));
}

void GodObjectMotion::gather_touched(const NearContacts& near) {
  touched_.clear();
  for (ToolContact contact : near.contacts) {
    if (contact.depth_m < -kTouching_m) continue;
    if (settling_ || contact.depth_m > kTolerance_m) contact.depth_m = 0;
    touched_.push_back(contact);
  }
}

Vector6 GodObjectMotion::constrained(const Vector6& a_gu, const ToolPose& pose, ToolMotionReport& report) {
  report.active_count = 0, report.push_W.setZero();
  has_failed_ = false;
  if (touched_.empty()) return a_gu;
  const Vector6 desired_T = rotated(pose.q_WT.conjugate(), a_gu);
  ConstrainedMotion motion = program_.solve(desired_T, touched_);
  if (motion.is_relaxed) {  // two walls leave no room for the gap; J a >= 0 is always feasible, with a = 0
    for (ToolContact& contact : touched_) contact.depth_m = 0;
    motion = program_.solve(desired_T, touched_);
  }
  has_failed_ = motion.failed;
  report.active_count = motion.active_count;
  report.push_W = pose.q_WT * motion.push_T;
  if (!settling_ && motion.side != 0) side_ = motion.side > 0 ? 1 : -1;
  return rotated(pose.q_WT, motion.a_g);
}

// The new contact can be with a disk or with a point.
double GodObjectMotion::free_fraction(const Vector6& a_c, const ToolPose& pose, const NearContacts& near) {
  const Vector6 a_T = rotated(pose.q_WT.conjugate(), a_c);
  const Vec3 shift_T = a_T.head<3>(), turn_T = a_T.tail<3>();
  double free = near_.clear_fraction(pose, a_c);
  for (const ToolContact& contact : near.contacts) {
    if (contact.depth_m >= -kTouching_m) continue;
    const double approach_m = -contact.n_T.dot(shift_T) - contact.r_T.cross(contact.n_T).dot(turn_T);
    if (approach_m > -contact.depth_m) free = std::min(free, -contact.depth_m / approach_m);
  }
  return free;
}

ToolMotionReport GodObjectMotion::move(ToolPose& pose, const ToolPose& device, ContactList& contacts,
                                       bool updated) {
  ToolMotionReport report;
  const Vec3 start_W = pose.p_W;
  MotionProgress progress(p_.rest_threshold_m, kGodObjectPatience);
  int stopped = 0;
  bool is_stopped = false;  // a new contact ended the last step
  near_.begin(contacts);
  settling_ |= updated;
  while (true) {
    const NearContacts near = near_.near(pose, settling_ ? side_ : 0);
    ++report.detections;
    if (near.deepest_m <= kTolerance_m) settling_ = false;
    if (near.contacts.empty()) side_ = 1;  // the tool has left the surface that held it
    gather_touched(near);
    const Vector6 a_gu = displacement(pose, device);
    // An error of second order can end the touch of the contact that ended the last step. It holds the tool
    // all the same, so the report stays.
    const bool is_off = is_stopped && touched_.empty();
    const Vector6 a_c = is_off ? a_gu : constrained(a_gu, pose, report);
    report.allowed_W = a_c;
    progress.update(max_point_displacement_m(a_gu, reach_m_));
    const bool stops = max_point_displacement_m(a_c, reach_m_) <= p_.rest_threshold_m ||
                       progress.has_ended() || stopped >= kGodObjectPatience;
    report.at_rest = stops && !has_failed_;
    if (stops || report.steps >= p_.steps_per_tick) break;
    const Vector6 step = capped(a_c, reach_m_, max_step_m_);
    const double free = free_fraction(step, pose, near);
    is_stopped = free < 1;
    stopped = free * max_point_displacement_m(step, reach_m_) <= p_.rest_threshold_m ? stopped + 1 : 0;
    pose = free == 1 && step == a_gu ? device : moved(pose, free * step);
    ++report.steps;
    if (report.steps == 1) report.first_step_m = pose.p_W - start_W;
  }
  if (report.at_rest) report.allowed_W.setZero();  // contacts prevent all that is left
  return report;
}

Voxmap::Voxmap(const PointCloud& cloud, double voxel_m)
    : voxel_m_(voxel_m), slots_(std::bit_ceil(2 * cloud.size() + 2), kFree) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::optional<std::uint64_t> key = key_of(cloud.point(i));
    if (key) slots_[slot_of(*key)] = *key;
  }
}

std::optional<std::uint64_t> Voxmap::key_of(const Vec3& p_W) const {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double voxel = std::floor(p_W[axis] / voxel_m_);
    if (!(voxel >= -kMaxVoxels && voxel < kMaxVoxels)) return {};
    key = key << kAxisBits | static_cast<std::uint64_t>(voxel + kMaxVoxels);
  }
  return key;
}

// Returns the slot that holds the key, or the one in which it would be put.
std::size_t Voxmap::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::uint64_t mixed = (key ^ key >> 30) * kMix;
  mixed ^= mixed >> 31;
  std::size_t slot = mixed & mask;
  while (slots_[slot] != key && slots_[slot] != kFree) slot = (slot + 1) & mask;
  return slot;
}

std::optional<Vec3> Voxmap::surface_middle_W(const Vec3& p_W) const {
  const std::optional<std::uint64_t> key = key_of(p_W);
  if (!key || slots_[slot_of(*key)] != *key) return {};
  const Vec3 voxel = (p_W / voxel_m_).array().floor();
  return Vec3(voxel_m_ * (voxel + Vec3::Constant(0.5)));
}

Parameters parameters(ToolPenaltyParameters& p) {
  const Parameters own = {
      {"force_law", choice(p.force_law, {"distance-field", "voxmap"}), 0, 0,
       "distance-field: points of the cloud in the distance field of the tool; voxmap: points of the tool in a voxmap of the cloud, with tangent planes, as McNeely 1999"},
      {"voxmap_voxel_m", &p.voxmap_voxel_m, 5e-4, 0.05,
       "for force_law = voxmap: size of a voxel, and spacing of the points on the tool; not below the spacing of the cloud"},
      {"point_stiffness_N_per_m", &p.point_stiffness_N_per_m, 1, 1e6,
       "k_p: force of a point per depth; if more than 10 points touch, their sum is scaled as if 10 did"},
      {"steps_per_tick", &p.steps_per_tick, 1, 1000,
       "maximum number of steps in a tick, each half a voxel or less; a tick that needs more sets budget_exhausted"},
      {"rest_threshold_m", &p.rest_threshold_m, 0, 1e-3, "the tick ends when a step is shorter than this"},
  };
  return appended(own, parameters(p.coupling));
}

ToolParameters tool_parameters(const ToolPenaltyParameters& p) {
  ToolParameters tool = tool_parameters(p.coupling);
  tool.contact_rule = ContactRule::voxels;  // points touch, and not disks
  tool.rest_threshold_m = p.rest_threshold_m;
  return tool;
}

void PenaltyMotion::Push::add(const Vec3& r_T, const Vec3& n_T, double depth_m, double k_p_N_per_m) {
  Vector6 line;
  line << n_T, r_T.cross(n_T);
  ++points;
  wrench_T += k_p_N_per_m * depth_m * line;
  stiffness_T += k_p_N_per_m * line * line.transpose();
}

// Returns the step in world axes. The linearisation: a displacement of the tool reduces the depth of a point
// by the dot product of the point's line and the displacement.
Vector6 PenaltyMotion::balancing_step(const ToolPose& pose, const ToolPose& device, const Push& push) const {
  const double k = p_.coupling.stiffness_N_per_m;
  const double turning = k * p_.coupling.gyration_radius_m * p_.coupling.gyration_radius_m;
  Vector6 spring;
  spring << k, k, k, turning, turning, turning;
  const Vector6 wanted_T = rotated(pose.q_WT.conjugate(), displacement(pose, device));
  Eigen::Matrix<double, 6, 6> stiffness = push.stiffness_T;
  stiffness.diagonal() += spring;
  const Vector6 step_T = stiffness.ldlt().solve(spring.cwiseProduct(wanted_T) + push.wrench_T);
  return capped(rotated(pose.q_WT, step_T), reach_m_, max_step_m_);
}

ToolMotionReport PenaltyMotion::move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool) {
  ToolMotionReport report;
  const Vec3 start_W = pose.p_W;
  while (!report.at_rest && report.steps < p_.steps_per_tick) {
    Push push = this->push(pose, contacts);
    if (push.points > kFullPoints) {
      const double fraction = double(kFullPoints) / push.points;
      push.wrench_T *= fraction, push.stiffness_T *= fraction;
    }
    const Vector6 step = balancing_step(pose, device, push);
    ++report.detections, ++report.steps;
    report.active_count = push.points;
    report.push_W = pose.q_WT * Vec3(push.wrench_T.head<3>());
    report.at_rest = max_point_displacement_m(step, reach_m_) <= p_.rest_threshold_m;
    pose = push.points == 0 && report.at_rest ? device : moved(pose, step);
  }
  report.first_step_m = pose.p_W - start_W;
  return report;
}

PenaltyMotion::Push FieldPenalty::push(const ToolPose& pose, const ContactList& contacts) const {
  const TouchFinder& finder = contacts.finder();
  const TiledCloud& cloud = finder.cloud();
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  Push all;
  for (const std::uint32_t point : finder.within(pose, 0)) {
    const Vec3 n_W = cloud.normal(point);
    const Vec3 p_T = R_TW * (cloud.point(point) - pose.p_W);
    const FieldSample at = sample_field(finder.tool(), p_T);
    const double depth_m = -at.distance_m;
    if (!(depth_m > 0)) continue;
    const Vec3 n_T = n_W.allFinite() ? Vec3(R_TW * n_W) : Vec3(-at.gradient_T.normalized());
    all.add(p_T, n_T, depth_m, p_.point_stiffness_N_per_m);
  }
  return all;
}

std::shared_ptr<const FramePreparation> VoxmapPenalty::prepared(const PointCloud& cloud) const {
  return std::make_shared<const PreparedVoxmap>(cloud, p_.voxmap_voxel_m);
}

void VoxmapPenalty::on_frame(const std::shared_ptr<const FramePreparation>& prepared) {
  const auto made = std::dynamic_pointer_cast<const PreparedVoxmap>(prepared);
  map_ = made ? std::shared_ptr<const Voxmap>(made, &made->map) : nullptr;
}

PenaltyMotion::Push VoxmapPenalty::push(const ToolPose& pose, const ContactList&) const {
  Push all;
  if (!map_) return all;
  const Eigen::Matrix3d R_WT = pose.q_WT.toRotationMatrix();
  for (std::size_t i = 0; i < shell_.size(); ++i) {
    const Vec3 p_W = pose.p_W + R_WT * shell_.p_T[i];
    const std::optional<Vec3> middle_W = map_->surface_middle_W(p_W);
    if (!middle_W) continue;
    const double depth_m = (R_WT * shell_.n_T[i]).dot(*middle_W - p_W);
    if (depth_m > 0) all.add(shell_.p_T[i], shell_.n_T[i], depth_m, p_.point_stiffness_N_per_m);
  }
  return all;
}

std::unique_ptr<ToolMotion> make_penalty_motion(const ToolPenaltyParameters& parameters,
                                                const VoxelTool& tool) {
  if (parameters.force_law == PenaltyLaw::voxmap) return std::make_unique<VoxmapPenalty>(parameters, tool);
  return std::make_unique<FieldPenalty>(parameters, tool);
}

}  // namespace remote_touch
