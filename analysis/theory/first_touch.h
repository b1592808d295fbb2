// Limit of the velocity of a surface when the proxy of chapter 4 first touches it, without noise and at any
// frame rate. (4.14) bounds the acceleration of a surface whose velocity the proxy has already estimated. At
// the first touch the estimate v_hat is still 0 (4.2.5).
//
// The points form a plane that moves along its normal with constant velocity v. So each frame shows the plane
// closer by delta = v / f_c. The hand, and so the proxy, is at rest. b is the distance from the proxy's
// centre to the nearest points, measured in the plane. d is the distance from the proxy's centre to the
// plane. Two values of d matter:
//   t = (r_1^2 - b^2)^(1/2): the proxy is entrenched if d < t;
//   e = (r_c^2 - b^2)^(1/2), with r_c = (r_1 + r_2) / 2: (4.10) moves the proxy to this distance.
// The last frame before the touch shows the plane at d, with t <= d < t + delta. The next frame shows it at
// the distance d - delta, which is below t.
//   1. If d < delta, the plane is behind the centre. Then the normal (4.1) has changed its sign, and the
//      proxy is lost.
//   2. Otherwise (4.10) moves the proxy by e - (d - delta), and (4.13) sets v_hat / f_c to this step. At the
//      following frame (4.3) moves the proxy by the same step before the proxy tests the points. The plane is
//      then at e + (e - d + delta) - delta = 2 e - d. If d > 2 e, the proxy is lost.
//   3. Otherwise (4.13) gives v_hat = v, and the proxy rests at e after each later frame.
// If the motion starts at a time that is uniform over one interval between frames, d is uniform too. So the
// proxy is lost for a fraction
//   (max(0, delta - t) + max(0, delta + t - 2 e)) / delta, at most 1,
// of all start times. This fraction is
//   0                     up to v = t f_c,
//   1 - t f_c / v         from there to v = (2 e - t) f_c,
//   2 (1 - e f_c / v)     from there to v = 2 e f_c,
//   1                     above.
// The two lost intervals of d are one interval of the phase at which the motion starts: d = t + delta and
// d = t are the same phase.
//
// A hand that touches the moving surface between two frames finds it at d = e, at every phase. Then step 1
// alone decides: the proxy is lost above e f_c.
//
// Assumptions: the estimated normal is that of the plane. This holds if the proxy is over a point or in the
// middle between points. Elsewhere the proxy slides, and the fraction lies between those of these two
// positions. r_3 >= 2 r_c as in Table 4.2, so the proxy has a normal before the touch if d <= 2 e.
#pragma once

namespace remote_touch {

struct FirstTouch {
  double r1_m = 0, r2_m = 0;    // Table 4.2
  double nearest_beside_m = 0;  // b: 0 over a point; s / sqrt(2) in the middle of four points s apart
  double frame_rate_hz = 0;
};

// Preconditions of all functions: 0 <= nearest_beside_m < r1_m <= r2_m; frame_rate_hz and velocity_m_per_s
// are positive.

// t f_c, m/s: up to this velocity no proxy is lost.
double max_first_touch_velocity(const FirstTouch& touch);
// e f_c, m/s: the same limit for a hand that touches the moving surface between two frames. Above it every
// proxy is lost.
double max_touched_velocity(const FirstTouch& touch);
// The fraction of start times for which a proxy at rest is lost, 0 to 1.
double lost_at_first_touch(const FirstTouch& touch, double velocity_m_per_s);

}  // namespace remote_touch
