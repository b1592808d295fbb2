// Constraint-based rendering of a point cloud as an implicit surface, [84] (see point_normals.h). The proxy
// is a point that is kept outside by the scheme of K. Salisbury and C. Tarr, "Haptic rendering of surfaces
// defined by implicit functions", ASME IMECE 1997:
//
//   free       straight to the HIP, up to where the segment first crosses f = 0 (steps of R / 8, bisection)
//   contact    in the tangent plane towards the HIP, and back to the surface by Newton's steps
//              -f grad f / |grad f|^2; a step that brings it no nearer to the HIP is halved
//   released   when the HIP is outside of the tangent plane at the proxy
//
// The force is F = k_s (proxy - HIP). Clouds may vary with time: at the beginning of a tick a proxy that is
// below the surface of a new frame is moved back along the gradient. Limits: a proxy that is deeper than the
// middle of the expanded points (metaballs) or beyond their support (surfels) leaves on the far side or not
// at all. The motion of the cloud is not tracked. Surfels have no edges: a sheet continues for R beyond its
// last points, and an isolated point or line of points exerts no force. Forbidden regions r_f are ignored.
//
// Outputs: contact_count is the number of points within R; steps is the number of evaluations of f; the state
// is entrenched if f < 0 at the end of a tick.
#pragma once

#include <string>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/rivals/point_normals.h"
#include "core/rivals/rival_renderer.h"

namespace remote_touch {

struct ImplicitSurfaceParameters {
  SurfaceKind surface = SurfaceKind::metaballs;
  SurfaceWeight weight = SurfaceWeight::wyvill;
  double support_radius_m = 0.01;
  double threshold = 0.5;
  double stiffness_N_per_m = 600;
  int steps_per_tick = 200;
};

Parameters parameters(ImplicitSurfaceParameters& p);
// Spacing of the points of most scenes (Grid). The surface of metaballs depends on the spacing, and their
// rest distance is computed for this one. If the points of a scene are closer or wider apart, the difference
// counts as an error of the method.
inline constexpr double kReferenceSpacing_m = 0.0015;
// The rest distance of surfels is 0, because they lie in the plane of the points. Metaballs lie around the
// points: at the height h R over a plane of points of spacing s, the sum of the weights is pi R^2 / s^2 times
// the integral of w(q) over q^2, from h^2 to 1. The rest distance is the height at which this sum is T, found
// by bisection. It is 0 if the sum is less than T even on the plane.
RenderedContact rendered_contact(const ImplicitSurfaceParameters& p);
inline std::string validate(const ImplicitSurfaceParameters&) {
  return {};
}

class ImplicitSurfaceRenderer final : public RivalOf<ImplicitSurfaceParameters> {
 public:
  // haptic_rate_hz has no effect: the method does not depend on time.
  ImplicitSurfaceRenderer(const ImplicitSurfaceParameters& parameters, double haptic_rate_hz,
                          const Kernels& kernels);

 private:
  struct Place {
    Vec3 p_W;
    SurfaceSample sample;
  };
  void touch(const Vec3& hip_W, RenderOutput& out) override;
  Place place(const Vec3& p_W, const Vec3& side);
  bool settle(Place& here);
  bool advance(Place& here, const Vec3& hip_W);
  bool walk(Place& here, const Vec3& hip_W);
  bool slide(Place& here, const Vec3& hip_W);
  void stop_at_surface(Place& outside, Place inside);
  void report(const Place& here, const Vec3& hip_W, RenderOutput& out);

  const PointSurface surface_;
  Vec3 side_ = Vec3::Zero();  // normal at the proxy, which defines the side of surfels; zero away from them
  int steps_ = 0;             // evaluations of f in this tick
};

}  // namespace remote_touch
