// The distance of a slave from what it is to follow, if nothing touches it. The slave is critically damped
// and its drive knows the speed of its command: x'' = w^2 (c - x) + 2 w (c' - x'), so its response is G(s) =
// (2 w s + w^2) / (s + w)^2, and a command that begins to move with the speed v leaves it behind by v t e^(-w
// t). w is 2 pi times the natural frequency.
//
// All positions are along one axis, in m. Precondition of all functions: the natural frequency is positive.
#pragma once

#include <optional>

namespace remote_touch {

// A motion A sin(2 pi hz t) that a slave follows as it was age_s ago.
struct FollowedShake {
  double amplitude_m = 0, hz = 0;
  double natural_frequency_hz = 0;
  double age_s = 0;
};
// Returns the largest distance between the motion and the slave, A |1 - G(iu) e^(-iu age)| with u = 2 pi hz.
double following_error_m(const FollowedShake& shake);

// A command that starts from rest, approaches a surface with constant speed, and stops.
struct Approach {
  double speed_m_per_s = 0;  // positive
  double way_m = 0;          // distance of the end of the command from its start
  double gap_m = 0;          // distance from the end to the touch; negative: the end lies beyond
  double natural_frequency_hz = 0;
};
struct Impact {
  double time_s = 0;         // since the command has started
  double speed_m_per_s = 0;  // towards the surface
};
// Returns when and how fast the slave reaches the surface, within 1e-9 s; nothing if it never does. The
// search takes steps of 1 / (1000 w), so it may miss a touch that is shorter. pre: way_m + gap_m > 0.
std::optional<Impact> first_impact(const Approach& approach);

// Returns the largest force on a mass that hits a spring with speed v while a constant force pushes it:
// F + (F^2 + K m v^2)^(1/2). It follows from the energy (1/2) m v^2 + F d = (1/2) K d^2.
double impact_force_N(double push_N, double stiffness_N_per_m, double mass_kg, double speed_m_per_s);

}  // namespace remote_touch
