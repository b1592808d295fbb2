// A proxy on the moving least squares surface of a point cloud (MlsProjection). J.-K. Lee and Y. J. Kim,
// "Haptic rendering of point set surfaces", World Haptics 2007, take the projection of a cloud point onto
// this surface as the contact point. Only their abstract was available; the rules of the proxy are this
// project's (README.md of this folder).
//
//   free      the proxy follows the HIP. Contact begins at the first checked position (every h/4) on the path
//             of the HIP since the last tick, its end included, that lies behind the surface. Farther than
//             h/2 from the surface the sign of f decides; nearer, the side of the position's own projection
//   contact   the contact point is the projection of the proxy onto the surface. It slides in the tangent
//             plane towards the HIP, by at most R/4, and is projected back, until it comes no nearer
//   released  when the HIP is outside of the tangent plane, or the surface does not reach the proxy
//
// The force is F = k_s (proxy - HIP). Clouds may vary with time: each tick begins with a projection of the
// proxy onto the surface of the newest frame. In contact the normal keeps its side. In free space the side is
// that of the sensor, as for surfels, or that from which the proxy came, as for implicit-surface. Limits: a
// cloud that passes the proxy by more than R from one frame to the next is lost. Two sheets less than R apart
// are averaged. With side=sensor, the back of a sheet pulls the hand through. Forbidden regions r_f are
// ignored.
//
// Outputs: contact_count is the number of points within R; steps is the number of checked positions and
// projections; the state is entrenched if the projection had not settled to R/1000 at the end of the tick.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "core/points/vector.h"
#include "core/rivals/point_normals.h"
#include "core/rivals/rival_renderer.h"

namespace remote_touch {

// The moving least squares (MLS) surface of a point set, the projection onto it, and a function whose sign
// separates its two sides. Equations:
//
//   weight      theta(d) = exp(-d^2 / h^2) - exp(-R^2 / h^2) for d < R = 2.5 h, else 0. The source has the
//               first term alone; the second one (0.002) removes the step at R.
//   plane       the plane of r has the unit normal n and the origin q = r + t n: the local minimum over n and
//               t of e(n, t) = sum_i theta(|x_i - q|) (n . (x_i - q))^2, reached from a given n and t = 0
//   polynomial  g(u, v) of degree 1 or 2 minimises sum_i theta(|x_i - q|) (g(u_i, v_i) - n . (x_i - q))^2,
//               where u and v are coordinates in the plane with the origin q
//   projection  P(r) = q + g(0, 0) n
//   sides       f(x) = n(x) . (x - a(x)) with the weighted mean a and the axis n of the smallest weighted
//               covariance, both with weights about x
//
// Sources: M. Alexa, J. Behr, D. Cohen-Or, S. Fleishman, D. Levin, C. Silva, "Computing and rendering point
// set surfaces", IEEE TVCG 9(1), 2003, for plane, polynomial and projection; A. Adamson, M. Alexa,
// "Approximating and intersecting surfaces from points", SGP 2003, for f. The surface is the set of points
// with P(x) = x. One projection does not reach it exactly (N. Amenta, Y. Kil, "Defining point-set surfaces",
// SIGGRAPH 2004), so project() repeats P. The surface ends where the tangential distance to the weighted mean
// exceeds 0.75 h; the rule is that of A. Adamson, M. Alexa, "Approximating bounded, non-orientable surfaces
// from points", SMI 2004, the number is ours.
//
// Lengths in m, world frame. The bits are the same for every order of the points: the sums are pre-rounded as
// in core/kernels/kernels.h, and all other operations are + - * / and square roots. r_f of points is ignored.

// Returns exp(-x) with a relative error below 3e-14. pre: 0 <= x <= 8.
constexpr double negative_exponential(double x) {
  constexpr double kInverse[] = {0,       1.0,     1.0 / 2, 1.0 / 3, 1.0 / 4,
                                 1.0 / 5, 1.0 / 6, 1.0 / 7, 1.0 / 8, 1.0 / 9};
  constexpr int kTerms = 9, kSquarings = 6;  // x / 64 <= 0.125: the next term of the series is 3e-16
  const double y = x / (1 << kSquarings);
  double value = 1;
  for (int k = kTerms; k > 0; --k) value = 1 - value * (y * kInverse[k]);
  for (int k = 0; k < kSquarings; ++k) value *= value;
  return value;
}

// f at a position.
struct MlsSample {
  double weight = 0;             // sum of the weights; 0: no point is within R
  bool supported = false;        // there is a surface near the position
  double value_m = 0;            // f, positive on the side to which the normal points
  Vec3 normal_W = Vec3::Zero();  // unit; zero if not supported
};

// The reference plane of a position.
struct MlsPlane {
  bool found = false;
  Vec3 q_W = Vec3::Zero();       // projection of the position onto the plane
  Vec3 normal_W = Vec3::Zero();  // unit, within 90 degrees of the given start
};

// The projection of a position onto the surface.
struct MlsFoot {
  bool found = false;            // false: the surface does not reach here, and p_W is the given position
  Vec3 p_W = Vec3::Zero();       // position on the surface
  Vec3 normal_W = Vec3::Zero();  // unit normal of the polynomial at p_W, within 90 degrees of the start
  Vec3 plane_normal_W = Vec3::Zero();  // normal of the reference plane: the best start nearby
  double residual_m = 0;               // length of the last step; above 1e-6 R if the steps did not converge
};

class MlsProjection {
 public:
  static constexpr double kSupportInWidths = 2.5;  // R in units of h

  // weight_width_m: h, above 0. degree: of the polynomial, 1 or 2.
  MlsProjection(double weight_width_m, int degree)
      : width_m_(weight_width_m), radius_m_(kSupportInWidths * weight_width_m), degree_(degree) {}

  double weight_width_m() const { return width_m_; }
  double support_radius_m() const { return radius_m_; }

  // The three functions have a precondition: the reach of `near` is at least support_radius_m(). They
  // allocate nothing and accept any finite position.

  // side_W: n is chosen within 90 degrees of it; zero: towards the position, so that f is not negative. One
  // point, or points on a line, have no plane and support nothing.
  MlsSample sample(Neighbourhood& near, const Vec3& x_W, const Vec3& side_W) const;
  // start_W: unit normal from which the minimum is searched. The first steps fit planes with fixed weights,
  // because the minimum attracts only from less than about h / 2. If the second derivative of e along n is
  // not clearly positive (noise as large as h), there is no minimum: the plane is then the fitted one, with
  // weights about its own q. found is false if the points do not span a plane, or if it is farther than R.
  MlsPlane reference_plane(Neighbourhood& near, const Vec3& r_W, const Vec3& start_W) const;
  // start_W: as above, or zero: the normal of sample() towards the position. If the points do not determine a
  // polynomial of the degree, or if g(0, 0) exceeds h, the next lower degree is used.
  MlsFoot project(Neighbourhood& near, const Vec3& x_W, const Vec3& start_W) const;

 private:
  double width_m_, radius_m_;
  int degree_;
};

enum class OutsideRule {
  sensor,  // the side of the surface that the sensor sees
  path     // the side from which the proxy came near the points
};

struct MlsSurfaceParameters {
  double weight_width_m = 0.0045;  // h; 0: computed from the first frame
  int degree = 2;
  OutsideRule outside = OutsideRule::sensor;
  Vec3 view_direction{0, -1, 0};
  double stiffness_N_per_m = 600;
  int steps_per_tick = 20;
};

Parameters parameters(MlsSurfaceParameters& p);
std::string validate(const MlsSurfaceParameters& p);
inline RenderedContact rendered_contact(const MlsSurfaceParameters&) {
  return {};
}

class MlsSurfaceRenderer final : public RivalOf<MlsSurfaceParameters> {
 public:
  // haptic_rate_hz has no effect: the method does not depend on time.
  MlsSurfaceRenderer(const MlsSurfaceParameters& parameters, double haptic_rate_hz, const Kernels& kernels);
  void reserve(std::size_t points) override;

 private:
  bool set_points(const NeighbourSearch& points) override;
  void touch(const Vec3& hip_W, RenderOutput& out) override;
  void reset_motion() override { is_held_ = false; }

  void choose_width(const NeighbourSearch& points);
  MlsSample sample(const Vec3& p_W);
  MlsFoot project(const Vec3& p_W, const Vec3& start_W);
  void stand_on(const MlsFoot& foot);
  bool approach(const Vec3& hip_W);
  bool begins_contact(const MlsSample& here);
  bool follow(const Vec3& hip_W);
  bool slide(MlsFoot& here, const Vec3& hip_W);
  bool may_step() const { return steps_ < p_.steps_per_tick; }
  void report(const Vec3& hip_W, RenderOutput& out);

  MlsProjection surface_;
  bool has_width_;  // h is known
  NearestPoints nearest_;
  PointCloud buffer_;
  ViewPoint view_;
  Vec3 side_W_ =
      Vec3::Zero();  // normal where the proxy was last, for OutsideRule::path; zero away from points
  bool is_held_ = false;
  Vec3 start_W_ = Vec3::Zero();  // normal of the reference plane of the held proxy
  double residual_m_ = 0;        // residual of the last projection of the held proxy
  int steps_ = 0;                // checked positions and projections in this tick
};

}  // namespace remote_touch
