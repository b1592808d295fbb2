#include "core/teleoperation/slave.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/points/vector.h"

namespace remote_touch {
namespace {

constexpr double kMaxTick_s = 0.01;  // longest tick at the haptic rates that an experiment may have

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

namespace {

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

}  // namespace

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

}  // namespace remote_touch
