// The largest stable stiffness of a virtual wall on a sampled device: a law for slow oscillations, and the
// exact limit of the linear loop.
//
// A mass m with a damper b to the ground, and a spring g K to a point at rest, is pushed by a device. At tick
// k the device measures the position x[k], and its command is
//   F[k] = -K x[k] - B (x[k] - x[k - n]) / (n T),
// with the tick T, the damper B of the wall and its velocity over n ticks. It exerts F[k - d] until the next
// tick, where d is the delay. The wall acts on both sides, so the loop is linear. A rotation has the same
// form, with a moment of inertia and stiffness and damping of rotation.
#pragma once

namespace remote_touch {

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
