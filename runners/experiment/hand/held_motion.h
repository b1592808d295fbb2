// The exact motion of a hand during one tick, in which its device holds the force: without and with dry
// friction.
#pragma once

#include "core/points/vector.h"

namespace remote_touch {

// The exact motion of a mass on a spring and dampers during one tick. The force on the mass is held, and the
// path that the mass follows moves at constant velocity. This models a hand whose device holds its force for
// a tick.

// m x'' = F + k (p - x) + c_p (p' - x') - c_g x' along every axis; p is the path. SI units. For rotations x
// and p are rotation vectors, m is the moment of inertia, F is the torque, and k, c_p and c_g are the
// rotational stiffness and damping.
struct MassOnSpring {
  double mass = 1;            // m, above 0
  double stiffness = 0;       // k, to the path
  double path_damping = 0;    // c_p, to the path
  double ground_damping = 0;  // c_g, to the ground: of the device's joints, or of a hand that opens
};

// The energies of one step, J. The first two are supplied. The others are dissipated or stored.
struct StepEnergy {
  double force_work_J = 0;     // done by the held force: force . displacement
  double path_work_J = 0;      // done by what moves the path
  double path_damper_J = 0;    // dissipated; negative by rounding only
  double ground_damper_J = 0;  // dissipated; negative by rounding only
  double dry_friction_J = 0;   // dissipated; see DryFrictionStep
  double kinetic_J = 0;        // gained by the mass
  double potential_J = 0;      // gained by the spring

  double supplied_J() const { return force_work_J + path_work_J; }
  double dissipated_J() const { return path_damper_J + ground_damper_J + dry_friction_J; }
  double gained_J() const { return kinetic_J + potential_J; }
  StepEnergy& operator+=(const StepEnergy& other);
};

// One step of a given duration T. The constructor computes its coefficients with +, -, *, / and square roots
// only, so their bits do not depend on the C library.
//
// Let w = k / m and d = (c_p + c_g) / m. phi is the response to a unit impulse: phi'' + d phi' + w phi = 0,
// phi(0) = 0, phi'(0) = 1. psi is the integral of phi, and chi the integral of psi. Then
//   x(T) - x(0) = x'(0) phi + r psi + w p' chi,   x'(T) = x'(0) phi' + r phi + w p' psi,
//   phi' = 1 - w psi - d phi,   r = (F + k (p(0) - x(0)) + c_p p') / m.
//
// The errors of phi, psi and chi, relative to their largest values in [0, T], and the error of phi', relative
// to 1, are below 1e-13 for sqrt(w) T <= 32 and (d + sqrt(w)) T < 2^18. held_motion.cpp has the
// derivation. One tick of every hand that the settings accept is within these limits.
class HeldForceStep {
 public:
  // pre: mass > 0, the other numbers >= 0, all finite, duration_s > 0.
  HeldForceStep(const MassOnSpring& system, double duration_s);

  // The state at the beginning of the step, and the quantities that are constant during it.
  struct Start {
    Vec3 apart = Vec3::Zero();          // p - x
    Vec3 velocity = Vec3::Zero();       // x'
    Vec3 path_velocity = Vec3::Zero();  // p'
    Vec3 force = Vec3::Zero();          // F
  };
  struct Motion {
    Vec3 displacement;  // x(T) - x(0)
    Vec3 velocity;      // x'(T)
  };
  Motion motion(const Start& start) const;
  // Returns the energies of the step, in closed form. Gained plus dissipated energy is the supplied energy,
  // within rounding. It is slower than motion(), because each call computes the integrals of the squared
  // velocities.
  StepEnergy energy(const Start& start) const;

 private:
  Vec3 pull(const Start& start) const;

  MassOnSpring system_;
  double duration_s_;
  double w_, d_;
  double phi_, psi_, chi_;
  double slope_;  // phi'(T)
};

// The exact motion of a mass on a spring and dampers with dry (Coulomb) friction during one tick. Like
// HeldForceStep, this models a hand whose device holds its force for a tick; the joints of the device rub.
// m x'' = F + k (p - x) + c_p (p' - x') - c_g x' - F_c sign(x') along every axis, each axis by itself. A mass
// at rest stays at rest while the other forces on an axis are at most F_c. For rotations F_c is a torque.
class DryFrictionStep {
 public:
  // pre: as for HeldForceStep; friction >= 0.
  DryFrictionStep(const MassOnSpring& system, double friction, double duration_s);

  // A tick is divided at every time at which the velocity of an axis becomes 0 or a mass at rest starts to
  // move. Between them the motion is that of HeldForceStep. The times are found by bisection, down to the
  // resolution of a double. The velocity is exactly 0 after a stop.
  HeldForceStep::Motion motion(const HeldForceStep::Start& start) const;
  // Returns the energies of the step. Gained plus dissipated energy is the supplied energy, within rounding.
  StepEnergy energy(const HeldForceStep::Start& start) const;

 private:
  struct Axis;
  void advance(Axis& axis, StepEnergy* energy) const;
  void rest(Axis& axis, double duration_s, StepEnergy* energy) const;
  void slide(Axis& axis, double direction, double duration_s, StepEnergy* energy) const;
  Axis after(const Axis& axis, double direction, double duration_s) const;
  double acceleration(const Axis& axis, double direction) const;
  double sliding_time(const Axis& axis, double direction, double longest_s) const;

  MassOnSpring system_;
  double friction_, duration_s_;
};

}  // namespace remote_touch
