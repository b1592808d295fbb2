// Haptic loops as linear systems: how a slave follows, and when a loop with a delay or a sampled device is
// stable.
#pragma once

#include <optional>

namespace remote_touch {

// The distance of a slave from its command c or from the surface, if nothing touches the slave. The slave is
// critically damped, and its drive knows the speed of its command:
//   x'' = w^2 (c - x) + 2 w (c' - x'),    G(s) = (2 w s + w^2) / (s + w)^2,
// where w is 2 pi times the natural frequency and G the response of the slave. A command that begins to move
// with the speed v is ahead of the slave by v t exp(-w t).
//
// All positions are along one axis, in m. Precondition of all functions: the natural frequency is positive.

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

// Onset of instability of a position-force loop with delay. The hand sends its position to a slave in contact
// with a spring, and feels the force of the contact after a round trip of T seconds:
//   hand:   m x'' + d x' + k x = -g f(t - T2), with d and k of the operator and the device together,
//   slave:  m_s x_s'' = k_s (c - x_s) + b_s (c' - x_s') - f, with c = x(t - T1), T = T1 + T2,
//           k_s = m_s w^2, b_s = 2 zeta m_s w, w = 2 pi times the natural frequency,
//   contact, always closed:  f = K x_s + B x_s'.
// The roots s of the loop are those of P(s) + Q(s) e^(-s T), with
//   P = (m s^2 + d s + k) (m_s s^2 + (b_s + B) s + k_s + K),    Q = g (k_s + b_s s) (K + B s).
// Only the round trip matters. A root is on the imaginary axis, at s = j u, where |P(j u)| = |Q(j u)|: a
// polynomial of degree 4 in u^2 (K. L. Cooke and Z. Grossman, J. Math. Anal. Appl. 86, 1982; K. Gu, V. L.
// Kharitonov and J. Chen, "Stability of Time-Delay Systems", 2003). Each such u gives the delays u T = arg(-Q
// / P) + 2 pi n. The least of them, over all u, is the onset if the loop is stable without delay.
//
// The onset of this linear loop is exact. A real contact opens, so beyond the onset the loop oscillates
// with a limited amplitude where the linear loop grows; below it the closed contact is stable.

struct PositionForceLoop {
  double mass_kg = 0.5;  // of hand and device
  double stiffness_N_per_m = 0, damping_Ns_per_m = 0;
  double slave_mass_kg = 2, slave_natural_frequency_hz = 5, slave_damping_ratio = 1;
  double environment_stiffness_N_per_m = 0, environment_damping_Ns_per_m = 0;
  double feedback_gain = 1;
};

struct DelayOnset {
  double round_trip_s = 0;  // 0: unstable without delay; infinity: stable with any delay
  double frequency_hz = 0;  // of the oscillation at the onset; NaN where there is none
};

// Precondition of all functions: masses, natural frequency and damping of the loop are positive, all other
// numbers are not negative.

// Returns the least round trip for which the loop is not stable.
DelayOnset delay_onset(const PositionForceLoop& loop);

// Returns the round trip of the loop without holds that has the same phase as a loop in which `holds` signals
// are sampled and held for a tick: half a tick more for each. The transfer of a hold is e^(-s tick / 2)
// sinc(u tick / 2): its phase is exactly that of half a tick at all frequencies below the sample rate. Its
// gain is about 1 - (u tick)^2 / 24, and is ignored, like the images of the signal above half of the sample
// rate; both are below 1e-3 for oscillations below 25 Hz at 1 kHz. The hold of a force at the hand is one. A
// command that moves the slave linearly from one sample to the next over the following tick is a delay of one
// tick with the gain sinc^2, so it counts as two holds.
double held_round_trip(double round_trip_s, double tick_s, int holds);

// The largest stable stiffness of a virtual wall on a sampled device: a law for slow oscillations, and the
// exact limit of the linear loop.
//
// A mass m with a damper b to the ground, and a spring g K to a point at rest, is pushed by a device. At tick
// k the device measures the position x[k], and its command is
//   F[k] = -K x[k] - B (x[k] - x[k - n]) / (n T),
// with the tick T, the damper B of the wall and its velocity over n ticks. It exerts F[k - d] until the next
// tick, where d is the delay. The wall acts on both sides, so the loop is linear. A rotation has the same
// form, with a moment of inertia and stiffness and damping of rotation.

struct SampledWall {
  double mass_kg = 1;                // m
  double damping_Ns_per_m = 0;       // b, of the hand and of the device
  double wall_damping_Ns_per_m = 0;  // B
  double spring_share = 0;           // g
  int delay_ticks = 0;               // d
  int velocity_ticks = 1;            // n
  double tick_s = 0.001;             // T
};

// Precondition of all functions: mass and tick are positive, n >= 1, d >= 0, b + B > 0.

// Returns K = (b + B) / t with t = T / 2 + d T, the time by which the device is late. This is the limit of an
// oscillation that is slow beside the delays. To first order the exact limit is larger by the fraction
//   K t^2 / (6 m) - B t_B^2 / (2 m t),    t_B = t + n T / 2,
// without a spring of the hand. So the law holds if K t^2 / m and B t_B^2 / (m t) are small.
double wall_law_N_per_m(const SampledWall& wall);

// Returns the smallest stiffness K at which an oscillation grows: an eigenvalue of the matrix that maps the
// state of the loop from one tick to the next leaves the unit circle. The relative error is below 1e-6,
// except where a range of unstable K is narrower than 2 %: the search from 1 % of the law upwards in steps of
// 2 % may skip it. Returns 0 if the loop is unstable where the search begins, and infinity if it is stable up
// to 100 times the law.
double exact_wall_limit_N_per_m(const SampledWall& wall);

}  // namespace remote_touch
