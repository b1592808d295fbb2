// The exact motion of a mass on a spring and dampers while the force on it is held and the path that it
// follows moves evenly: one tick of a hand whose device holds its force.
#pragma once

#include "core/geometry/vector.h"

namespace remote_touch {

// m x'' = F + k (p - x) + c_p (p' - x') - c_g x' along every axis, p the path. SI units; for rotations x and
// p are rotation vectors, m is the moment of inertia, and F, k, c_p and c_g are the torque and the rotational
// stiffness and damping.
struct MassOnSpring {
  double mass = 1;            // m, above 0
  double stiffness = 0;       // k, to the path
  double path_damping = 0;    // c_p, to the path
  double ground_damping = 0;  // c_g, to the ground: of the device's joints, or of a hand that opens
};

// The energies of a step, J. The first two are supplied; the others are where they go.
struct StepEnergy {
  double force_work_J = 0;     // of the held force: force . displacement
  double path_work_J = 0;      // of what moves the path
  double path_damper_J = 0;    // dissipated, never below 0 but for rounding
  double ground_damper_J = 0;  // likewise
  double kinetic_J = 0;        // gained by the mass
  double potential_J = 0;      // gained by the spring

  double supplied_J() const { return force_work_J + path_work_J; }
  double dissipated_J() const { return path_damper_J + ground_damper_J; }
  double gained_J() const { return kinetic_J + potential_J; }
  StepEnergy& operator+=(const StepEnergy& other);
};

// One step of a given duration. Its coefficients are computed once with +, -, *, / and a square root alone,
// so their bits do not depend on the C library.
//
// Let w = k / m, d = (c_p + c_g) / m, and phi the response to a unit impulse, phi'' + d phi' + w phi = 0,
// phi(0) = 0, phi'(0) = 1; psi is its integral and chi the integral of psi. Then
//   x(T) - x(0) = x'(0) phi + r psi + w p' chi,   x'(T) = x'(0) phi' + r phi + w p' psi,
//   phi' = 1 - w psi - d phi,   r = (F + k (p(0) - x(0)) + c_p p') / m.
//
// Error of phi, phi', psi and chi, relative to the largest value in [0, T]: below 1e-13 for sqrt(w) T <= 32
// and (d + sqrt(w)) T < 2^18; held_force_step.cpp has the derivation. A tick of every hand that the settings
// accept is within that. phi' is relative to 1.
class HeldForceStep {
 public:
  // pre: mass > 0, the other numbers >= 0, all finite, duration_s > 0.
  HeldForceStep(const MassOnSpring& system, double duration_s);

  // The state at the beginning of the step, and what is constant during it.
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
  // A closed form. Gained and dissipated energy are what is supplied, within rounding. It is slower than
  // motion(), because the integrals of the squares of velocities are computed in each call.
  StepEnergy energy(const Start& start) const;

 private:
  Vec3 pull(const Start& start) const;

  MassOnSpring system_;
  double duration_s_;
  double w_, d_;
  double phi_, psi_, chi_;
  double slope_;  // phi'(T)
};

}  // namespace remote_touch
