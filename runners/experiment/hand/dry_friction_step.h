// The exact motion of a mass on a spring and dampers with dry (Coulomb) friction during one tick. Like
// HeldForceStep, this models a hand whose device holds its force for a tick; the joints of the device rub.
#pragma once

#include "runners/experiment/hand/held_force_step.h"

namespace remote_touch {

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
