// The distance of a slave from its command c or from the surface, if nothing touches the slave. The slave is
// critically damped, and its drive knows the speed of its command:
//   x'' = w^2 (c - x) + 2 w (c' - x'),    G(s) = (2 w s + w^2) / (s + w)^2,
// where w is 2 pi times the natural frequency and G the response of the slave. A command that begins to move
// with the speed v is ahead of the slave by v t exp(-w t).
//
// All positions are along one axis, in m. Precondition of all functions: the natural frequency is positive.
#pragma once

#include <optional>

namespace remote_touch {

// A motion A sin(2 pi hz t), and a slave that follows the motion as it was age_s ago.
struct FollowedShake {
  double amplitude_m = 0, hz = 0;
  double natural_frequency_hz = 0;
  double age_s = 0;
};
// Returns the largest distance between the motion and the slave, A |1 - G(iu) exp(-iu age)|, u = 2 pi hz.
double following_error_m(const FollowedShake& shake);

// A command that starts from rest, approaches a surface with constant speed, and stops.
struct Approach {
  double speed_m_per_s = 0;  // positive
  double way_m = 0;          // distance of the end of the command from its start
  double gap_m = 0;          // distance from the end to the surface; negative: the end lies beyond it
  double natural_frequency_hz = 0;
};
struct Impact {
  double time_s = 0;         // since the command has started
  double speed_m_per_s = 0;  // towards the surface
};
// Returns when and how fast the slave first reaches the surface, within 1e-9 s; nothing if it never does. The
// search has steps of 1 / (1000 w), so it may miss a touch that is shorter. pre: speed_m_per_s > 0 and
// way_m + gap_m > 0.
std::optional<Impact> first_impact(const Approach& approach);

// Returns the largest force on a mass m that hits a spring K with the speed v while a constant force F pushes
// it: F + (F^2 + K m v^2)^(1/2). It follows from the energy (1/2) m v^2 + F d = (1/2) K d^2, where d is the
// largest compression.
double impact_force_N(double push_N, double stiffness_N_per_m, double mass_kg, double speed_m_per_s);

}  // namespace remote_touch
