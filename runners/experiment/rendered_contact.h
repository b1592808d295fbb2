// Where the point of a renderer lies that touches the surface: what makes a ball, a point and a spring
// without a proxy comparable.
//
// A ball in contact has its centre at r_c above the surface, a point lies on it. So the height of the contact
// is
//
//   height = d(x) - rest distance,
//
// d the distance to the true surface and x the renderer's position. Of a ball this is the height of the point
// of it that faces the surface, for d is measured along the surface's outward normal. The height is 0 where
// the rendered surface is the true one, above 0 where it floats and below 0 where it sank.
//
// A renderer with a proxy holds x = RenderOutput::proxy_W, and a spring pulls the hand towards it: the hand
// may be anywhere below. A penalty force has no proxy: its hand sinks as far as it presses, just as the hand
// of the others sinks below the proxy. Under the same press the two are compared without that depth of the
// spring: x is where the force would end, HIP + F / k, with F the force of this tick and k its stiffness.
// With the ball of the dissertation's penalty force over a plane, F = k (r_c - d(HIP)) n, so d(x) = r_c and
// the height 0, however deep the press; and once the HIP has passed the points, F pushes it on, x is below
// the surface too, and the height is negative. Dampers are no part of this: no method of the scorecard has
// one.
#pragma once

namespace remote_touch {

struct RenderedContact {
  double rest_distance_m = 0;  // of x from a flat surface without noise that it touches; NaN: not known
  double spring_N_per_m = 0;   // above 0: there is no proxy, and x = HIP + F / k with this k
};

}  // namespace remote_touch
