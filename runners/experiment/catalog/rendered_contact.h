// The contact point of a renderer, and its height above the true surface: the quantity by which a ball, a
// point and a spring without a proxy are compared.
//
// In contact, the centre of a ball is r_c above the surface, and a point proxy is on it. The height of the
// contact point is therefore
//
//   height = d(x) - rest distance,
//
// where x is the renderer's position and d the signed distance to the true surface, positive outside. For a
// ball it is the height of the point that faces the surface, because d is measured along the outward normal
// of the surface. The height is 0 where the rendered surface is the true one, positive where it floats above
// it and negative where it has sunk below it.
//
// A renderer with a proxy has x = RenderOutput::proxy_W, and a spring pulls the hand towards it. The depth of
// the hand does not matter. A penalty force has no proxy: the hand sinks until the spring holds it, as the
// hand of the other methods sinks below the proxy. This depth must not count either. x is therefore the
// position at which the force would end: x = HIP + F / k, with the force F of this tick and its stiffness k.
// The penalty force of the dissertation over a plane is F = k (r_c - d(HIP)) n, so d(x) = r_c and the height
// is 0, however deep the press is. Once the HIP has passed the points, F pushes it further, x is below the
// surface too, and the height is negative. Dampers are not considered, because no method of the scorecard has
// one.
#pragma once

#include <algorithm>
#include <cmath>

namespace remote_touch {

struct RenderedContact {
  double rest_distance_m = 0;  // distance of x from a flat, noise-free surface in contact; NaN: not known
  double spring_N_per_m = 0;   // above 0: there is no proxy, and x = HIP + F / k with this k
  // Above 0: the proxy is a ball of this radius that single points hold, as in chapter 4, so that it falls
  // through between points that are too far apart. 0: something else holds the proxy, such as a mesh, or
  // there is no proxy.
  double ball_radius_m = 0;
};

// A contact point that has sunk less than this below the true surface has not passed through it, m: half the
// contact radius of 4.3. Noise tilts and shifts the surface that a renderer estimates, and moves it to both
// sides alike. A plane through the points within 10 mm at the spacing of most scenes, 1.5 mm, has 140 points,
// so that even noise of r_c = 5 mm shifts it by 0.42 mm (standard deviation), a sixth of this.
inline constexpr double kMinSink_m = 0.0025;

// Returns the distance, m, by which x may lie behind the true surface and still count as held in front of it.
// A ball counts as held until its centre is behind the surface: it has then sunk by its rest distance. A
// position that rests on the surface, or nearly, would be behind it by rounding alone, so it may sink by
// kMinSink_m. Returns 0 if the rest distance is not known.
inline double held_depth_m(const RenderedContact& contact) {
  return std::isnan(contact.rest_distance_m) ? 0 : std::max(0.0, kMinSink_m - contact.rest_distance_m);
}

}  // namespace remote_touch
