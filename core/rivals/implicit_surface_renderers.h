// Constraint-based renderers of a point cloud as an implicit surface, [84] of the dissertation: metaballs or
// planes at the proxy, and surfels, which have a normal for each point.
#pragma once

#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/rivals/point_normals.h"
#include "core/rivals/rival_renderer.h"

namespace remote_touch {

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

// The surfels of A. Leeper, S. Chan, K. Salisbury, ICRA 2012, [84] of the dissertation, after a description
// of the authors' program (README.md of this folder says what is known of it). Every point has its own
// normal, from the points of its frame, turned towards the sensor of that frame. The surface is f = n . (p -
// a) = 0 with the weighted means a of the points and n of their normals within R. So f < 0 is behind the
// surface, from whichever side the proxy came.
//
//   free      the proxy is the HIP, or follows it if its path needs more checks than a tick makes. Contact
//             begins if f < 0 at a checked position (every R/8) on the path of the HIP since the last tick,
//             its end included; so also if a new frame puts the surface in front of the HIP
//   contact   per tick one step in the tangent plane towards the HIP, less what friction holds back, and one
//             projection onto f = 0 of at most R/2
//   released  when the HIP is outside of the tangent plane, or nothing is within R of the proxy
//
// The force is F = k_s (proxy - HIP). The normal of a tick is blended with that of the previous tick. Limits:
// a cloud that passes the proxy by more than R from one frame to the next is lost, unless the HIP is within R
// behind it. The back of a sheet pulls the hand through. Forbidden regions r_f are ignored.
//
// Outputs: contact_count is the number of points within R; steps is the number of evaluations of f; the state
// is entrenched if f < 0 at the end of a tick.

struct SurfelParameters {
  double support_radius_m = 0.01;  // 0: computed from the first frame
  SurfaceWeight weight = SurfaceWeight::wendland;
  int normal_neighbours = 9;
  double previous_normal_fraction = 0.4;
  double friction = 0.2;
  int fused_frames = 1;
  Vec3 view_direction{0, -1, 0};
  double stiffness_N_per_m = 600;
};

Parameters parameters(SurfelParameters& p);
std::string validate(const SurfelParameters& p);
inline RenderedContact rendered_contact(const SurfelParameters&) {
  return {};
}

class SurfelRenderer final : public RivalOf<SurfelParameters> {
 public:
  // haptic_rate_hz has no effect: the method does not depend on time.
  SurfelRenderer(const SurfelParameters& parameters, double haptic_rate_hz, const Kernels& kernels);
  void reserve(std::size_t points) override;

 private:
  std::shared_ptr<const NeighbourSearch> shown(const Frame& frame) override;
  bool set_points(const NeighbourSearch& points) override;
  void touch(const Vec3& hip_W, RenderOutput& out) override;
  void reset_motion() override { is_held_ = false; }

  PointCloud joined();
  Vec3 normal_of(std::uint32_t number, const Vec3& x_W);
  SurfaceSample sample(const Vec3& p_W);
  void approach(const Vec3& hip_W);
  void follow(const Vec3& hip_W);
  void release(const Vec3& hip_W);
  void report(const Vec3& hip_W, RenderOutput& out);

  double radius_m_;  // R; 0 until it is known
  // One of the newest frames, which are joined. Its normals come from its own points and its own sensor.
  struct FusedFrame {
    std::shared_ptr<const NeighbourSearch> points;  // null before the frame came
    PointNormals normals;
    std::size_t first = 0;  // number of its first point in the joined cloud
  };
  std::vector<FusedFrame> frames_;
  std::size_t newest_ = 0;
  PointCloud buffer_;
  Buffer<Vec3> gathered_normals_;
  bool is_held_ = false;
  double depth_m_ = 0;  // depth of the held proxy behind the surface
  int samples_ = 0;     // evaluations of f in this tick
};

}  // namespace remote_touch
