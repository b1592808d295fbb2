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
#pragma once

namespace remote_touch {

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

// Returns the stiffness K of the environment up to which the loop is stable with every round trip up to
// round_trip_s; infinity if it is above 1e9 N/m. It ignores environment_stiffness_N_per_m of the loop. The
// relative error is below 1e-9, except where a range of unstable K is narrower than 1 %: the search from
// below in steps of 1 % may skip it.
double max_environment_stiffness(const PositionForceLoop& loop, double round_trip_s);

// Returns the round trip of the loop without holds that has the same phase as a loop in which `holds` signals
// are sampled and held for a tick: half a tick more for each. The transfer of a hold is e^(-s tick / 2)
// sinc(u tick / 2): its phase is exactly that of half a tick at all frequencies below the sample rate. Its
// gain is about 1 - (u tick)^2 / 24, and is ignored, like the images of the signal above half of the sample
// rate; both are below 1e-3 for oscillations below 25 Hz at 1 kHz. The hold of a force at the hand is one. A
// command that moves the slave linearly from one sample to the next over the following tick is a delay of one
// tick with the gain sinc^2, so it counts as two holds.
double held_round_trip(double round_trip_s, double tick_s, int holds);

}  // namespace remote_touch
