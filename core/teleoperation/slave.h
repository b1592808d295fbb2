// A slave robot in contact with the true scene: a ball on a carriage that follows a commanded position.
#pragma once

#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <variant>

#include "core/parameters/parameter.h"
#include "core/points/noise.h"
#include "core/points/vector.h"

namespace remote_touch {

struct SlaveSettings {
  double mass_kg = 2;
  double natural_frequency_hz = 5;
  double damping_ratio = 1;
  double max_speed_m_per_s = 0;
  double max_acceleration_m_per_s2 = 0;
  double radius_m = 0.005;
  double contact_stiffness_N_per_m = 30000;
  double contact_damping_Ns_per_m = 20;
  int steps_per_tick = 10;
};

Parameters parameters(SlaveSettings& s);
std::string validate(const SlaveSettings& s);

// The scene that the ball touches: the true surface, not the measured points.
struct SlaveScene {
  // Distance of a point from the surface at a time, m, positive outside; NaN where it is not known.
  std::function<double(const Vec3& p_W, double time_s)> signed_distance;
  // Unit normal towards the outside at the surface point that is nearest; NaN where it is not known.
  std::function<Vec3(const Vec3& p_W, double time_s)> normal;
  // Time of the surface to which both refer: time_s, if the surface moves while time passes. Otherwise the
  // surface is at rest until the result changes, and then it jumps. Empty: time_s.
  std::function<double(double time_s)> surface_time_s = {};

  // True if the surface jumps between two times, so that it has no speed.
  bool jumps(double before_s, double now_s) const {
    if (!surface_time_s) return false;
    const double before = surface_time_s(before_s), now = surface_time_s(now_s);
    return before != now && !(before == before_s && now == now_s);
  }
};

// m x'' = m w^2 (c - x) + 2 zeta w m (c' - x') + f along every axis, with x the centre of the ball, c the
// reference, w = 2 pi natural_frequency_hz and f the contact force of the scene. In each tick the reference
// moves at constant velocity, not faster than max_speed_m_per_s, and reaches the command at the end. The
// drive, which is the first two terms divided by m, is limited to max_acceleration_m_per_s2 in magnitude.
//
// f = max(0, K d + B d') n, with d = radius_m - signed distance of the centre, where d > 0; n is the normal
// of the true surface where the ball touches first in a tick. d' includes the motion of the surface, but not
// a jump (SlaveScene::surface_time_s). There is no friction, and no contact where distance or normal are not
// known. A surface that approaches with more than 10 m/s may be noticed a tick later.
//
// The motion is integrated in steps of a tick / steps_per_tick by the semi-implicit rule. Its error is of
// the order of w T and sqrt(K / m) T, where T is the duration of a step.
class Slave {
 public:
  Slave(const SlaveSettings& settings, double tick_s, SlaveScene scene);

  struct State {
    Vec3 position_W = Vec3::Zero();
    Vec3 velocity_W = Vec3::Zero();
    Vec3 force_N = Vec3::Zero();  // mean force of the scene on the slave in the last tick, world frame
    double peak_force_N = 0;      // largest magnitude of the force in the last tick
    double clearance_m = 0;  // distance of the slave from the surface; negative in contact; NaN: not known
    // The reference c, its displacement and the mean force D of the drive on the slave in the last tick, and
    // the work D . c' of the reference on the drive and D . x' of the drive on the slave. Only of a ball.
    Vec3 reference_W = Vec3::Zero(), reference_displacement_m = Vec3::Zero(), drive_N = Vec3::Zero();
    double reference_work_J = 0, drive_work_J = 0;
    // False if the slave was behind the surface in the last tick and the normal there is not known. There is
    // then no force, because its direction is not known.
    bool is_force_known = true;
  };
  // Moves the slave from time_s - tick_s to time_s. command_W: the position that it has received last. In the
  // first call the slave is put at the command, at rest. If the last call was for an earlier time than
  // time_s - tick_s, the slave stood still meanwhile, and the scene has no known speed of approach.
  const State& move(const Vec3& command_W, double time_s);
  // A wave u with an impedance b > 0, which moves the reference: sqrt(2 b) u = b c' + D at every step, with
  // the force D of the drive on the slave. max_speed_m_per_s does not limit it.
  struct Wave {
    Vec3 value_W = Vec3::Zero();  // sqrt(W)
    double impedance_Ns_per_m = 0;
  };
  // Moves the slave by a wave in place of a command. pre: move() has put the slave somewhere.
  const State& move(const Wave& wave, double time_s);
  const State& state() const { return state_; }

 private:
  using Guide = std::variant<Vec3, Wave>;  // a velocity or a wave, which moves the reference in a tick
  Vec3 drive_acceleration(const Vec3& reference_velocity) const;
  Vec3 reference_velocity(const Guide& guide) const;
  Vec3 contact_force(double before_s, double now_s);
  bool is_far(const Vec3& reference_velocity) const;
  const State& move_through_tick(const Guide& guide, double time_s);
  void step(const Guide& guide, bool can_touch, double before_s, double now_s);

  const SlaveSettings s_;
  const double tick_s_;
  const SlaveScene scene_;
  State state_;
  double depth_m_ = 0;            // d after the last step; NaN: not known
  Vec3 depth_W_ = Vec3::Zero();   // position to which it belongs
  std::optional<Vec3> normal_W_;  // normal of the surface in this tick
  double last_s_ = 0;             // time of the last call
  bool is_placed_ = false;
};

// The parts of the drive that a ball and a tool share.

// Returns 2 pi natural_frequency_hz, 1/s.
inline double natural_rate_per_s(const SlaveSettings& s) {
  return 2 * std::numbers::pi * s.natural_frequency_hz;
}

// Returns the vector, shortened to max_length if it is longer; 0: no limit.
inline Vec3 cut(const Vec3& v, double max_length) {
  return max_length > 0 ? limited_length(v, max_length) : v;
}

// The error of the registration of the slave to the camera, whose cloud the operator touches.

struct RegistrationError {
  double offset_m = 0;
  double rotation_deg = 0;
  Vec3 centre_m = Vec3::Zero();
};

Parameters parameters(RegistrationError& s);
inline std::string validate(const RegistrationError&) {
  return {};
}

// Returns X with X p = R (p - o) + o + t, the position to which the slave moves if the command is p, both in
// the world frame. R is a rotation by rotation_deg, o is centre_m, and t has the length offset_m. So the
// rotation displaces a command at the distance d from o by up to 2 d sin(rotation_deg / 2). The axis of R and
// the direction of t are random, independent, uniform on the sphere, and the same for the whole run. They are
// functions of the seed and the replicate, not of the cell of a sweep, so the runs of one replicate differ
// only in what the sweep varies.
RigidTransform registration_of(const RegistrationError& error, const NoiseKey& key);

}  // namespace remote_touch
