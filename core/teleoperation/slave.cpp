#include "core/teleoperation/slave.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/points/vector.h"

namespace remote_touch {
namespace {

constexpr double kMaxTick_s = 0.01;  // longest tick at the haptic rates that an experiment may have

enum Drawn : std::uint32_t { offset, axis };

// Returns a unit vector, by rejection: points in a cube are drawn until one lies in its inscribed ball.
// Unlike with sine and cosine, the bits do not depend on the C library.
Vec3 direction(const NoiseKey& key, Drawn which) {
  const NoiseKey of_all_cells{key.seed, 0, key.replicate};
  const NoiseStream stream = noise_stream(of_all_cells, NoiseUse::registration, which);
  for (std::uint32_t draw = 0;; ++draw) {
    const auto u = uniforms(stream, draw);
    const Vec3 p(2 * u[0] - 1, 2 * u[1] - 1, 2 * u[2] - 1);
    const double square = p.squaredNorm();
    if (square <= 1 && square > 1e-6) return p.normalized();
  }
}

constexpr int kToolPointsInLeaf = 4;

struct Cell {
  Vec3 p_T = Vec3::Zero();
  double area_m2 = 0;
};
using Cells = std::map<std::array<int, 3>, Cell>;

void add(Cells& cells, double spacing_m, const Vec3& p_T, double area_m2) {
  const Vec3 at = p_T / spacing_m + Vec3::Constant(0.5);
  std::array<int, 3> key;
  for (std::size_t i = 0; i < 3; ++i) key[i] = static_cast<int>(std::floor(at[static_cast<Eigen::Index>(i)]));
  const auto [place, is_first] = cells.try_emplace(key, Cell{p_T, 0});
  if (p_T.squaredNorm() > place->second.p_T.squaredNorm()) place->second.p_T = p_T;
  place->second.area_m2 += area_m2;
}

double area_of(const std::array<Vec3, 3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() / 2;
}

std::array<Vec3, 3> corners_of(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const auto at = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
  return {at(triangle[0]), at(triangle[1]), at(triangle[2])};
}

// Every corner of a part has a third of the parts that meet in it: one, three or six.
void add(Cells& cells, double spacing_m, const std::array<Vec3, 3>& corners) {
  const double longest_m = std::max(
      {(corners[1] - corners[0]).norm(), (corners[2] - corners[1]).norm(), (corners[0] - corners[2]).norm()});
  const int n = std::max(1, static_cast<int>(std::ceil(longest_m / spacing_m)));
  const double third_m2 = area_of(corners) / (3.0 * n * n);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j) {
      const int borders = (i == 0) + (j == 0) + (i + j == n);
      const int parts = borders == 0 ? 6 : borders == 1 ? 3 : 1;
      const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
      const Vec3 p_T = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
      add(cells, spacing_m, p_T, parts * third_m2);
    }
}

Cells cells_of(const TriangleMesh& mesh, double spacing_m) {
  Cells cells;
  for (const auto& triangle : mesh.triangles) add(cells, spacing_m, corners_of(mesh, triangle));
  return cells;
}

constexpr double kNegligible = 20;  // value of x in exp(-x), a share of 2e-9

// Returns exp(-x), within 3e-4 for x <= 8 and 2 % for x <= 20, with the same bits on every machine.
double decay(double x) {
  assert(x >= 0 && x <= kNegligible);
  const double y = x / 16;
  double t = 1 + y * (1 + y * (1. / 2 + y * (1. / 6 + y * (1. / 24 + y * (1. / 120)))));
  t *= t, t *= t, t *= t, t *= t;
  return 1 / t;
}

// Returns ln x within 1e-12, with the same bits on every machine.
double logarithm(double x) {
  assert(x > 0 && std::isfinite(x));
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < std::numbers::sqrt2 / 2) m *= 2, --exponent;
  const double u = (m - 1) / (m + 1), v = u * u;
  double series = 0;
  for (int k = 15; k >= 1; k -= 2) series = series * v + 1.0 / k;
  return exponent * std::numbers::ln2 + 2 * u * series;
}

}  // namespace

Parameters parameters(SlaveSettings& s) {
  return {
      {"mass_kg", &s.mass_kg, 0.01, 1000, "mass of the slave"},
      {"natural_frequency_hz", &s.natural_frequency_hz, 0.1, 100,
       "natural frequency with which the slave follows its command"},
      {"damping_ratio", &s.damping_ratio, 0.05, 10, "damping of this motion; 1: critical"},
      {"max_speed_m_per_s", &s.max_speed_m_per_s, 0, 100,
       "largest speed of the reference that the slave follows; 0: no limit"},
      {"max_acceleration_m_per_s2", &s.max_acceleration_m_per_s2, 0, 1000,
       "largest acceleration that the drive can give to the slave; 0: no limit"},
      {"radius_m", &s.radius_m, 1e-4, 1,
       "radius of the ball with which the slave touches the scene, if it has no tool"},
      {"contact_stiffness_N_per_m", &s.contact_stiffness_N_per_m, 0, 1e6,
       "stiffness of the contact of ball or tool and scene; 0: the slave feels nothing"},
      {"contact_damping_Ns_per_m", &s.contact_damping_Ns_per_m, 0, 10000, "damping of this contact"},
      {"steps_per_tick", &s.steps_per_tick, 1, 1000, "steps of the slave's motion in a tick"},
  };
}

std::string validate(const SlaveSettings& s) {
  // The rule is stable for w T < 2 without damping; half of that leaves room for the dampers.
  const double w = natural_rate_per_s(s);
  const double stiffness = w * w + s.contact_stiffness_N_per_m / s.mass_kg;
  const double damping = 2 * s.damping_ratio * w + s.contact_damping_Ns_per_m / s.mass_kg;
  const double largest_step_s = 2 / (damping + std::sqrt(damping * damping + 4 * stiffness));
  const double least = std::ceil(kMaxTick_s / largest_step_s);
  if (s.steps_per_tick >= least) return {};
  return "steps_per_tick = " + std::to_string(s.steps_per_tick) + ": expected " +
         std::to_string(static_cast<int>(least)) + " or more, for these frequencies and dampers";
}

Slave::Slave(const SlaveSettings& settings, double tick_s, SlaveScene scene)
    : s_(settings), tick_s_(tick_s), scene_(std::move(scene)) {}

// Twice the distance that the ball can move in a tick, and 10 mm for the scene, which does not reach it
// either unless it is faster than 10 m/s.
bool Slave::is_far(const Vec3& reference_velocity) const {
  constexpr double kSceneMotion_m = 0.01;
  const double w = natural_rate_per_s(s_);
  const double drive = w * w * (state_.reference_W - state_.position_W).norm() +
                       2 * s_.damping_ratio * w * (reference_velocity - state_.velocity_W).norm();
  const double motion_m = tick_s_ * (state_.velocity_W.norm() + reference_velocity.norm() + tick_s_ * drive);
  return state_.clearance_m > kSceneMotion_m + 2 * motion_m;
}

Vec3 Slave::contact_force(double before_s, double now_s) {
  const auto depth_at = [&](const Vec3& p_W) { return s_.radius_m - scene_.signed_distance(p_W, now_s); };
  // The speed after a jump is that of the ball over the new surface.
  const double depth_before = scene_.jumps(before_s, now_s) ? depth_at(depth_W_) : depth_m_;
  depth_m_ = depth_at(state_.position_W), depth_W_ = state_.position_W;
  if (!(depth_m_ > 0) || s_.contact_stiffness_N_per_m == 0) return Vec3::Zero();
  // A ball that the scene reaches from an unknown distance has no known speed of approach.
  const double speed = std::isnan(depth_before) ? 0 : (depth_m_ - depth_before) / (now_s - before_s);
  const double force = s_.contact_stiffness_N_per_m * depth_m_ + s_.contact_damping_Ns_per_m * speed;
  if (!(force > 0)) return Vec3::Zero();
  if (!normal_W_) normal_W_ = scene_.normal(state_.position_W, now_s);
  if (normal_W_->allFinite()) return force * *normal_W_;
  state_.is_force_known = false;
  return Vec3::Zero();
}

Vec3 Slave::drive_acceleration(const Vec3& reference_velocity) const {
  const double w = natural_rate_per_s(s_);
  return cut(w * w * (state_.reference_W - state_.position_W) +
                 2 * s_.damping_ratio * w * (reference_velocity - state_.velocity_W),
             s_.max_acceleration_m_per_s2);
}

// The velocity that solves sqrt(2 b) u = b c' + D without a limit of the acceleration gives D, and D gives
// c'.
Vec3 Slave::reference_velocity(const Guide& guide) const {
  if (const Vec3* const velocity = std::get_if<Vec3>(&guide)) return *velocity;
  const auto& [value_W, b] = std::get<Wave>(guide);
  const double w = natural_rate_per_s(s_), stiffness = s_.mass_kg * w * w;
  const double damping = 2 * s_.damping_ratio * w * s_.mass_kg;
  const Vec3 wave_N = std::sqrt(2 * b) * value_W;
  const Vec3 unlimited =
      (wave_N - stiffness * (state_.reference_W - state_.position_W) + damping * state_.velocity_W) /
      (b + damping);
  return (wave_N - s_.mass_kg * drive_acceleration(unlimited)) / b;
}

void Slave::step(const Guide& guide, bool can_touch, double before_s, double now_s) {
  const double step_s = tick_s_ / s_.steps_per_tick;
  const Vec3 rate = reference_velocity(guide), drive = drive_acceleration(rate);
  const Vec3 force = can_touch ? contact_force(before_s, now_s) : Vec3(Vec3::Zero());
  state_.velocity_W += step_s * (drive + force / s_.mass_kg);
  state_.position_W += step_s * state_.velocity_W;
  state_.reference_W += step_s * rate, state_.reference_displacement_m += step_s * rate;
  state_.force_N += force / s_.steps_per_tick;
  state_.peak_force_N = std::max(state_.peak_force_N, force.norm());
  const Vec3 drive_N = s_.mass_kg * drive;
  state_.drive_N += drive_N / s_.steps_per_tick;
  state_.reference_work_J += step_s * drive_N.dot(rate);
  state_.drive_work_J += step_s * drive_N.dot(state_.velocity_W);
}

const Slave::State& Slave::move(const Vec3& command_W, double time_s) {
  if (is_placed_)
    return move_through_tick(cut((command_W - state_.reference_W) / tick_s_, s_.max_speed_m_per_s), time_s);
  state_.position_W = state_.reference_W = command_W;
  depth_m_ = s_.radius_m - scene_.signed_distance(command_W, time_s), depth_W_ = command_W;
  is_placed_ = true;
  last_s_ = time_s;
  state_.clearance_m = -depth_m_;
  return state_;
}

const Slave::State& Slave::move(const Wave& wave, double time_s) {
  return move_through_tick(wave, time_s);
}

const Slave::State& Slave::move_through_tick(const Guide& guide, double time_s) {
  state_.force_N = state_.drive_N = state_.reference_displacement_m = Vec3::Zero();
  state_.peak_force_N = state_.reference_work_J = state_.drive_work_J = 0, state_.is_force_known = true;
  const bool has_paused = time_s - last_s_ > 1.5 * tick_s_;  // the scene may be anywhere
  if (has_paused) depth_m_ = std::numeric_limits<double>::quiet_NaN();
  const double step_s = tick_s_ / s_.steps_per_tick, begin_s = time_s - tick_s_;
  const bool can_touch = has_paused || !is_far(reference_velocity(guide));
  normal_W_.reset();
  for (int i = 0; i < s_.steps_per_tick; ++i)
    step(guide, can_touch, begin_s + (i - 1) * step_s, begin_s + i * step_s);
  last_s_ = time_s;
  state_.clearance_m = scene_.signed_distance(state_.position_W, time_s) - s_.radius_m;
  if (!can_touch) depth_m_ = -state_.clearance_m, depth_W_ = state_.position_W;
  return state_;
}

Parameters parameters(RegistrationError& s) {
  return {
      {"offset_m", &s.offset_m, 0, 1, "distance of the slave from its command, in a random direction"},
      {"rotation_deg", &s.rotation_deg, 0, 45,
       "rotation of the slave's frame about a random axis through centre_m"},
      {"centre_m", &s.centre_m, -100, 100,
       "the point that the rotation leaves where it is, world frame: the base of the robot, or the centroid of the points with which it was calibrated"},
  };
}

RigidTransform registration_of(const RegistrationError& error, const NoiseKey& key) {
  RigidTransform X = RigidTransform::Identity();
  X.linear() = rotation(error.rotation_deg * kRadiansPerDegree * direction(key, axis)).toRotationMatrix();
  const Vec3 about_centre_m = error.centre_m - X.linear() * error.centre_m;
  X.translation() = about_centre_m + error.offset_m * direction(key, offset);
  return X;
}

SlaveTool make_slave_tool(const TriangleMesh& mesh, const Eigen::Matrix3d& inertia_m2, int max_points) {
  double area_m2 = 0;
  for (const auto& triangle : mesh.triangles) area_m2 += area_of(corners_of(mesh, triangle));
  double spacing_m = std::sqrt(area_m2 / max_points);
  Cells cells = cells_of(mesh, spacing_m);
  while (cells.size() > static_cast<std::size_t>(max_points)) cells = cells_of(mesh, spacing_m *= 1.1);
  SlaveTool tool;
  for (const auto& [key, cell] : cells) {
    tool.points_T.push_back(cell.p_T);
    tool.areas_m2.push_back(cell.area_m2);
    tool.reach_m = std::max(tool.reach_m, cell.p_T.norm());
  }
  tool.gyration_m = std::sqrt(inertia_m2.trace() / 3);
  return tool;
}

SlaveToolTree::SlaveToolTree(const std::vector<Vec3>& points_T)
    : points_T_(points_T), order_(points_T.size()) {
  assert(!points_T.empty());
  std::iota(order_.begin(), order_.end(), 0);
  add(0, static_cast<int>(order_.size()));
}

// Returns the index of the new node.
int SlaveToolTree::add(int begin, int end) {
  const auto point = [this](int i) -> const Vec3& { return points_T_[static_cast<std::size_t>(i)]; };
  const auto first = order_.begin() + begin, last = order_.begin() + end;
  Vec3 low = point(*first), high = low;
  for (auto i = first; i != last; ++i) low = low.cwiseMin(point(*i)), high = high.cwiseMax(point(*i));
  Node node{(low + high) / 2, 0, begin, end};
  for (auto i = first; i != last; ++i)
    node.radius_m = std::max(node.radius_m, (point(*i) - node.centre_T).norm());
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back(node);
  if (end - begin <= kToolPointsInLeaf) return index;
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  std::sort(first, last,
            [&](int a, int b) { return std::pair(point(a)[axis], a) < std::pair(point(b)[axis], b); });
  const int middle = begin + (end - begin) / 2;
  const int left = add(begin, middle), right = add(middle, end);
  nodes_[static_cast<std::size_t>(index)].left = left;
  nodes_[static_cast<std::size_t>(index)].right = right;
  return index;
}

std::string validate(const SlaveSettings& s, const SlaveTool& tool, double tick_s) {
  // A point at the end of the tool moves 1 + reach^2 / r^2 times as easily as its centre.
  const double ease = 1 + std::pow(tool.reach_m / tool.gyration_m, 2);
  const double step_s = tick_s / s.steps_per_tick, w = natural_rate_per_s(s);
  const double stiffness = w * w + ease * s.contact_stiffness_N_per_m / s.mass_kg;
  const double damping = 2 * s.damping_ratio * w + ease * s.contact_damping_Ns_per_m / s.mass_kg;
  if (stiffness * step_s * step_s + damping * step_s <= 1) return {};
  return "steps_per_tick = " + std::to_string(s.steps_per_tick) +
         ": expected more for this tool, or a larger mass_kg";
}

ToolSlave::ToolSlave(const SlaveSettings& settings, const SlaveTool& tool, double tick_s, SlaveScene scene)
    : s_(settings),
      tool_(tool),
      tree_(tool.points_T),
      tick_s_(tick_s),
      mean_area_m2_(std::accumulate(tool.areas_m2.begin(), tool.areas_m2.end(), 0.0) /
                    static_cast<double>(tool.areas_m2.size())),
      scene_(std::move(scene)) {
  assert(validate(settings).empty() && tick_s > 0);
  touches_.reserve(tool.points_T.size());
}

// Finds the points that may touch in the coming tick, and the clearance.
void ToolSlave::find_touches(double time_s) {
  const Eigen::Matrix3d R_WT = state_.orientation_W.toRotationMatrix();
  const double speed = state_.velocity_W.norm() + state_.angular_velocity_W.norm() * tool_.reach_m;
  const double near_m = tick_s_ * (2 * speed + kSceneSpeed_m_per_s);
  touches_.clear();
  const double least_m = tree_.visit(
      near_m, kExactClearance_m,
      [&](const Vec3& p_T) { return scene_.signed_distance(state_.position_W + R_WT * p_T, time_s); },
      [&](int point, double distance_m) {
        const auto i = static_cast<std::size_t>(point);
        if (!(distance_m < near_m)) return;
        touches_.push_back({Vector6::Zero(), tool_.areas_m2[i] / mean_area_m2_, -distance_m, 0, 0,
                            R_WT * tool_.points_T[i]});
      });
  state_.clearance_m = clearance(least_m, time_s);
}

// least_m: the smallest distance of a point if it is below kExactClearance_m; NaN: not known.
double ToolSlave::clearance(double least_m, double time_s) const {
  if (!(least_m >= kExactClearance_m)) return least_m;
  const Vec3 normal_W = scene_.normal(state_.position_W, time_s);
  if (!normal_W.allFinite()) return scene_.signed_distance(state_.position_W, time_s) - tool_.reach_m;
  const Vec3 normal_T = state_.orientation_W.conjugate() * normal_W;
  const auto leads = [&](const Vec3& a, const Vec3& b) { return a.dot(normal_T) < b.dot(normal_T); };
  const Vec3 p_T = *std::min_element(tool_.points_T.begin(), tool_.points_T.end(), leads);
  return scene_.signed_distance(state_.position_W + state_.orientation_W * p_T, time_s);
}

// Completes the points that may touch. Those whose plane is not known do not touch.
void ToolSlave::ask_scene(double begin_s, double end_s) {
  const bool jumps = scene_.jumps(begin_s, end_s);
  bool is_behind = false, is_known = false;
  for (Touch& t : touches_) {
    const Vec3 p_W = state_.position_W + t.arm_W;
    const Vec3 n = scene_.normal(p_W, begin_s);
    t.normal << n, t.arm_W.cross(n);
    t.rate_m_per_s = jumps ? 0 : (scene_.signed_distance(p_W, end_s) + t.start_m) / (end_s - begin_s);
    if (t.start_m > 0) is_behind = true, is_known |= n.allFinite();
  }
  state_.is_force_known = is_known || !is_behind;
  std::erase_if(touches_, [](const Touch& t) { return !t.normal.allFinite() || std::isnan(t.rate_m_per_s); });
}

// Returns the wrench of the scene on the tool. moved: since the start of the tick, which was since_s ago.
ToolSlave::Vector6 ToolSlave::contact_wrench(const Vector6& moved, const Vector6& velocity, double since_s) {
  double deepest_m = -std::numeric_limits<double>::infinity();
  for (Touch& t : touches_) {
    t.depth_m = t.start_m - t.normal.dot(moved) - since_s * t.rate_m_per_s;
    deepest_m = std::max(deepest_m, t.depth_m);
  }
  if (!(deepest_m > -kNegligible * kRounding_m)) return Vector6::Zero();
  double sum = 0, rate = 0;
  Vector6 normal = Vector6::Zero();
  for (const Touch& t : touches_) {
    const double x = (deepest_m - t.depth_m) * (1 / kRounding_m);
    if (x > kNegligible) continue;
    const double share = t.weight * decay(x);
    sum += share, rate += share * t.rate_m_per_s, normal += share * t.normal;
  }
  const double depth_m = deepest_m + kRounding_m * logarithm(sum);
  const double speed = -(normal.dot(velocity) + rate) / sum;
  const double force_N = s_.contact_stiffness_N_per_m * depth_m + s_.contact_damping_Ns_per_m * speed;
  if (!(depth_m > 0 && force_N > 0)) return Vector6::Zero();
  return force_N / sum * normal;
}

// Moves the reference through this tick.
ToolSlave::Drive ToolSlave::start_drive(const Pose& command) {
  const auto turn = [](const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
    return rotation_vector(to * from.conjugate());
  };
  Drive d;
  d.error << reference_.position_W - state_.position_W, turn(state_.orientation_W, reference_.orientation_W);
  const Vec3 velocity = cut((command.position_W - reference_.position_W) / tick_s_, s_.max_speed_m_per_s);
  const Vec3 rate = cut(turn(reference_.orientation_W, command.orientation_W) / tick_s_,
                        s_.max_speed_m_per_s / tool_.gyration_m);
  d.rate_per_s << velocity, rate;
  reference_.position_W += tick_s_ * velocity;
  reference_.orientation_W = (rotation(tick_s_ * rate) * reference_.orientation_W).normalized();
  return d;
}

// Returns the acceleration that the drive gives to the tool.
ToolSlave::Vector6 ToolSlave::drive(const Drive& d, const Vector6& moved, const Vector6& velocity,
                                    double since_s) const {
  const double w = natural_rate_per_s(s_);
  const Vector6 wanted = w * w * (d.error + since_s * d.rate_per_s - moved) +
                         2 * s_.damping_ratio * w * (d.rate_per_s - velocity);
  Vector6 limited;
  limited << cut(wanted.head<3>(), s_.max_acceleration_m_per_s2),
      cut(wanted.tail<3>(), s_.max_acceleration_m_per_s2 / tool_.gyration_m);
  return limited;
}

void ToolSlave::move_through_tick(const Drive& d) {
  const double step_s = tick_s_ / s_.steps_per_tick, inertia = s_.mass_kg * std::pow(tool_.gyration_m, 2);
  Vector6 moved = Vector6::Zero(), total = Vector6::Zero(), velocity;
  velocity << state_.velocity_W, state_.angular_velocity_W;
  double peak_N = 0;
  for (int i = 0; i < s_.steps_per_tick; ++i) {
    const double since_s = i * step_s;
    Vector6 acceleration = drive(d, moved, velocity, since_s);
    if (!touches_.empty() && s_.contact_stiffness_N_per_m > 0) {
      const Vector6 wrench = contact_wrench(moved, velocity, since_s);
      acceleration.head<3>() += wrench.head<3>() / s_.mass_kg;
      acceleration.tail<3>() += wrench.tail<3>() / inertia;
      total += wrench / s_.steps_per_tick;
      peak_N = std::max(peak_N, wrench.head<3>().norm());
    }
    velocity += step_s * acceleration;
    moved += step_s * velocity;
  }
  state_.velocity_W = velocity.head<3>(), state_.angular_velocity_W = velocity.tail<3>();
  state_.force_N = total.head<3>(), state_.torque_Nm = total.tail<3>(), state_.peak_force_N = peak_N;
  state_.position_W += moved.head<3>();
  state_.orientation_W = (rotation(moved.tail<3>()) * state_.orientation_W).normalized();
}

const ToolSlave::State& ToolSlave::move(const Pose& command, double time_s) {
  if (!is_placed_) {
    reference_ = command;
    state_.position_W = command.position_W, state_.orientation_W = command.orientation_W;
    is_placed_ = true;
  } else {
    const double begin_s = time_s - tick_s_;
    if (time_s - last_s_ > 1.5 * tick_s_) find_touches(begin_s);
    ask_scene(begin_s, time_s);
    move_through_tick(start_drive(command));
  }
  last_s_ = time_s;
  find_touches(time_s);
  return state_;
}

}  // namespace remote_touch
