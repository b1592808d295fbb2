// How fast a surface may move when the proxy of chapter 4 first touches it, without noise and at any frame
// rate. (4.14) bounds the acceleration of a surface whose velocity the proxy has estimated. At the first
// touch v_hat is still 0 (4.2.5).
//
// The points form a plane that moves along its normal at a constant velocity v, so each frame shows it
// closer by delta = v / f_c. The hand, and so the proxy, rests. b is the distance, measured in the plane,
// from the proxy's centre to the nearest points. Distances d are from the proxy's centre to the plane:
//   t = (r_1^2 - b^2)^(1/2): the proxy is entrenched where d < t;
//   e = (r_c^2 - b^2)^(1/2): where (4.10) moves it to, with r_c = (r_1 + r_2) / 2.
// The last frame before the touch shows the plane at d, t <= d < t + delta; the next one at d - delta < t.
//   1. d < delta: the plane is behind the centre. The normal (4.1) has changed sign, and the proxy is lost.
//   2. Otherwise (4.10) moves the proxy by e - (d - delta), and (4.13) makes this v_hat / f_c. At the next
//      frame (4.3) moves the proxy by as much before it tests the points, which are then at
//      e + (e - d + delta) - delta = 2 e - d. For d > 2 e the proxy is lost.
//   3. Otherwise (4.13) gives v_hat = v, and from then on the proxy rests at e after each frame.
// d is uniform where the motion starts at a time that is uniform over one interval between frames. So the
// proxy is lost in a fraction
//   (max(0, delta - t) + max(0, delta + t - 2 e)) / delta, at most 1,
// of all start times: 0 up to v = t f_c, 2 (1 - e f_c / v) from (2 e - t) f_c on, and 1 from 2 e f_c on. Both
// lost intervals are one where d is seen as a phase: they meet at d = t, which follows d = t + delta.
//
// A hand that touches the moving surface between two frames finds it at d = e instead, at every phase. Then
// step 1 decides alone: the proxy is lost above e f_c.
//
// Assumptions: the estimated normal is that of the plane, so the proxy is over a point or in the middle
// between points; elsewhere it slides, and the fraction lies between those of these two places. r_3 >= 2 r_c
// as in Table 4.2: the proxy has a normal before the touch wherever d <= 2 e.
#pragma once

namespace remote_touch {

struct FirstTouch {
  double r1_m = 0, r2_m = 0;    // Table 4.2
  double nearest_beside_m = 0;  // b: 0 over a point; s / sqrt(2) in the middle of four points s apart
  double frame_rate_hz = 0;
};

// pre of all: 0 <= nearest_beside_m < r1_m <= r2_m, frame_rate_hz > 0, velocity_m_per_s > 0.

// t f_c: at most this velocity, and no proxy is lost.
double max_first_touch_velocity(const FirstTouch& touch);
// e f_c: the same for a hand that touches the moving surface between two frames; above it all are lost.
double max_touched_velocity(const FirstTouch& touch);
// The fraction of start times at which a proxy at rest is lost.
double lost_at_first_touch(const FirstTouch& touch, double velocity_m_per_s);

}  // namespace remote_touch
