#include "core/rivals/mls_surface_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace remote_touch {

namespace {

// Lengths are in units of R.
constexpr double kWidth = 1 / MlsProjection::kSupportInWidths;                                    // h
constexpr double kSharpness = MlsProjection::kSupportInWidths * MlsProjection::kSupportInWidths;  // (R / h)^2
constexpr double kRimWeight = negative_exponential(kSharpness);
constexpr double kMaxBorder = 0.75 * kWidth;  // tangential distance to the weighted mean at which it ends
constexpr double kMaxHeight = kWidth;         // larger values of g(0, 0) are extrapolated: a lower degree
constexpr double kNearPlane = 0.25 * kWidth;  // up to this mean distance, a plane is refined to the minimum
// The smallest second derivative of e along n, per weight, that counts as positive. It is 2 without noise.
constexpr double kMinCurvature = 0.1;
constexpr double kSamePlane = 1e-6;     // a step by this offset and slope ends the search for the plane
constexpr double kSamePosition = 1e-6;  // a projection by this distance ends the projections
constexpr double kMinSupport = 1e-6;    // smaller sums of weights are mostly rounding
constexpr double kMinVariance = 1e-6;   // middle variance of points that span a plane
constexpr double kMinPivot = 1e-6;  // smaller pivots, as a fraction of the diagonal, are dependent columns
constexpr int kPlaneSteps = 8, kProjections = 5;
constexpr int kMaxTerms = 6;  // terms of a polynomial of degree 2 in u and v

// N sums of terms of magnitude up to 1, see point_normals.h.
template <std::size_t N>
class ExactSums {
 public:
  explicit ExactSums(double grid) : grid_(grid) {}
  void add(const std::array<double, N>& terms) {
    for (std::size_t i = 0; i < N; ++i) sums_[i] += (terms[i] + grid_) - grid_;
  }
  double operator[](std::size_t i) const { return sums_[i]; }

 private:
  double grid_;
  std::array<double, N> sums_{};
};

// Calls act(theta, exponential, e) for every point within R of the centre: its weight, the first term of its
// weight, and e = (x - centre) / R. The exponentials of a group of points are computed together, because this
// loop is most of the cost.
template <class Act>
void for_each_weighted(const PointsView& points, const Vec3& centre_W, double radius_m, const Act& act) {
  const double scale = 1 / radius_m, cx = centre_W.x(), cy = centre_W.y(), cz = centre_W.z();
  double ex[kLanes], ey[kLanes], ez[kLanes], exponential[kLanes];
  for (std::size_t first = 0; first < points.padded_count; first += kLanes) {
    const double *x = points.x + first, *y = points.y + first, *z = points.z + first;
#pragma omp simd
    for (std::size_t i = 0; i < kLanes; ++i) {
      ex[i] = (x[i] - cx) * scale, ey[i] = (y[i] - cy) * scale, ez[i] = (z[i] - cz) * scale;
      const double squared = ex[i] * ex[i] + ey[i] * ey[i] + ez[i] * ez[i];
      const double inside = squared < 1 ? squared : 1;
      exponential[i] = squared < 1 ? negative_exponential(kSharpness * inside) : 0;
    }
    for (std::size_t i = 0; i < kLanes; ++i)
      if (exponential[i] > 0) act(exponential[i] - kRimWeight, exponential[i], Vec3(ex[i], ey[i], ez[i]));
  }
}

// Two unit vectors that form a right-handed system with the unit vector n: u x v = n.
struct TangentAxes {
  explicit TangentAxes(const Vec3& n) {
    Eigen::Index least;
    n.cwiseAbs().minCoeff(&least);
    u = Vec3::Unit(least).cross(n).normalized();
    v = n.cross(u);
  }
  Vec3 u, v;
};

// The normal equations a x = b of weighted least squares; a is symmetric.
struct NormalEquations {
  double a[kMaxTerms][kMaxTerms] = {}, b[kMaxTerms] = {}, x[kMaxTerms] = {};

  // Solves the first `size` equations with a = L D L^T. Returns false if a column depends on those before it.
  bool solve(int size) {
    double lower[kMaxTerms][kMaxTerms] = {}, pivot[kMaxTerms] = {};
    for (int j = 0; j < size; ++j) {
      pivot[j] = a[j][j];
      for (int k = 0; k < j; ++k) pivot[j] -= lower[j][k] * lower[j][k] * pivot[k];
      if (!(pivot[j] > kMinPivot * a[j][j])) return false;
      for (int i = j + 1; i < size; ++i) {
        double rest = a[i][j];
        for (int k = 0; k < j; ++k) rest -= lower[i][k] * lower[j][k] * pivot[k];
        lower[i][j] = rest / pivot[j];
      }
    }
    for (int i = 0; i < size; ++i) {
      x[i] = b[i];
      for (int k = 0; k < i; ++k) x[i] -= lower[i][k] * x[k];
    }
    for (int i = size - 1; i >= 0; --i) {
      x[i] /= pivot[i];
      for (int k = i + 1; k < size; ++k) x[i] -= lower[k][i] * x[k];
    }
    return true;
  }
};

// Returns the equations of three unknowns; only the upper triangle of a counts.
NormalEquations equations(const std::array<std::array<double, 3>, 3>& a, const std::array<double, 3>& b) {
  NormalEquations result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) result.a[i][j] = result.a[j][i] = a[i][j];
    result.b[i] = b[i];
  }
  return result;
}

// One step of the search for the reference plane.
struct PlaneStep {
  bool found = false;
  double offset = 0;          // distance by which the plane moves along n
  Vec3 slope = Vec3::Zero();  // slope of the new plane over the old one, perpendicular to n
};

// The sums of one step of the search. Let F = n . (x_i - q) / R, s = (R / h)^2, E the exponential and theta
// the weight of a point, t in units of R, and (u, v) coordinates in the plane. The derivatives of e / 2 are
//
//   along n           -sum F (theta - s E F^2)
//   for turns         -sum F (theta + s E F t) (u, v), where n turns about r by -(u, v)
//   second along n     sum (theta - 5 s E F^2 + 2 s^2 E F^4)
//   mixed              sum (theta - 3 s E F^2) (u, v)
//   second for turns   sum theta ((u, v) (u, v)^T - F^2 I)
//
// The last two are those at t = 0, at the surface.
struct PlaneSums {
  enum Sum { w, wu, wv, wuu, wuv, wvv, wF, wFu, wFv, along, turn_u, turn_v, second, mixed_u, mixed_v, wFF };

  PlaneSums(const PointsView& points, double sum_grid, double radius_m, const MlsPlane& plane,
            const TangentAxes& axes, double t)
      : sums(sum_grid) {
    for_each_weighted(points, plane.q_W, radius_m, [&](double theta, double exponential, const Vec3& e) {
      const double u = axes.u.dot(e), v = axes.v.dot(e), F = plane.normal_W.dot(e);
      const double change = kSharpness * exponential * F, change_F = change * F;
      const double turn = 0.5 * (F * (theta + change * t));  // halved: its magnitude is up to 1, as |t| <= 1
      const double mixed = theta - 3 * change_F;
      sums.add({theta, theta * u, theta * v, theta * u * u, theta * u * v, theta * v * v, theta * F,
                theta * F * u, theta * F * v, F * (theta - change_F), turn * u, turn * v,
                theta - 5 * change_F + 2 * kSharpness * (change_F * F * F), mixed * u, mixed * v,
                theta * F * F});
    });
  }
  // True if Newton's steps lead to the minimum.
  bool is_near() const {
    return std::abs(sums[wF]) <= kNearPlane * sums[w] && 2 * sums[second] >= kMinCurvature * sums[w];
  }
  // The equations of the plane F = c + slope . (u, v) with weights theta.
  NormalEquations plane_fit() const {
    return equations({{{sums[w], sums[wu], sums[wv]}, {0, sums[wuu], sums[wuv]}, {0, 0, sums[wvv]}}},
                     {sums[wF], sums[wFu], sums[wFv]});
  }
  // The equations of Newton's step to the minimum of e.
  NormalEquations newton_step() const {
    return equations({{{sums[second], sums[mixed_u], sums[mixed_v]},
                       {0, sums[wuu] - sums[wFF], sums[wuv]},
                       {0, 0, sums[wvv] - sums[wFF]}}},
                     {sums[along], 2 * sums[turn_u], 2 * sums[turn_v]});
  }

  ExactSums<wFF + 1> sums;
};

// Returns false in `found` if the points do not span a plane.
PlaneStep plane_step(const PointsView& points, double sum_grid, double radius_m, const MlsPlane& plane,
                     double t) {
  const TangentAxes axes(plane.normal_W);
  const PlaneSums sums(points, sum_grid, radius_m, plane, axes, t);
  if (!(sums.sums[PlaneSums::w] > kMinSupport)) return {};
  NormalEquations step = sums.newton_step();
  if (!sums.is_near() || !step.solve(3)) {
    step = sums.plane_fit();
    if (!step.solve(3)) return {};
  }
  return {true, step.x[0], step.x[1] * axes.u + step.x[2] * axes.v};
}

// --- the polynomial ---

// Index of the monomial u^i v^j in the order 1, u, v, u^2, u v, v^2, u^3, ...
constexpr int monomial(int i, int j) {
  return (i + j) * (i + j + 1) / 2 + j;
}
constexpr int kPowers[kMaxTerms][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
constexpr int kMoments = monomial(0, 4) + 1;  // moments up to degree 4

// The polynomial over a reference plane at its origin q.
struct LocalPolynomial {
  bool found = false;
  double height = 0;          // g(0, 0)
  Vec3 slope = Vec3::Zero();  // gradient of g, perpendicular to n
};

NormalEquations polynomial_equations(const PointsView& points, double sum_grid, double radius_m,
                                     const MlsPlane& plane, const TangentAxes& axes) {
  ExactSums<kMoments + kMaxTerms> sums(sum_grid);
  for_each_weighted(points, plane.q_W, radius_m, [&](double theta, double, const Vec3& e) {
    const double u = axes.u.dot(e), v = axes.v.dot(e), F = plane.normal_W.dot(e);
    const double us[] = {1, u, u * u, u * u * u, u * u * u * u};
    const double vs[] = {1, v, v * v, v * v * v, v * v * v * v};
    std::array<double, kMoments + kMaxTerms> terms;
    for (int degree = 0; degree <= 4; ++degree)
      for (int j = 0; j <= degree; ++j)
        terms[static_cast<std::size_t>(monomial(degree - j, j))] = theta * (us[degree - j] * vs[j]);
    for (std::size_t k = 0; k < kMaxTerms; ++k) terms[kMoments + k] = terms[k] * F;
    sums.add(terms);
  });
  NormalEquations fit;
  for (int k = 0; k < kMaxTerms; ++k) {
    for (int l = 0; l < kMaxTerms; ++l)
      fit.a[k][l] = sums[static_cast<std::size_t>(
          monomial(kPowers[k][0] + kPowers[l][0], kPowers[k][1] + kPowers[l][1]))];
    fit.b[k] = sums[static_cast<std::size_t>(kMoments + k)];
  }
  return fit;
}

LocalPolynomial local_polynomial(const PointsView& points, double sum_grid, double radius_m,
                                 const MlsPlane& plane, int degree) {
  const TangentAxes axes(plane.normal_W);
  NormalEquations fit = polynomial_equations(points, sum_grid, radius_m, plane, axes);
  const double weight = fit.a[0][0];
  if (!(weight > kMinSupport)) return {};
  const double mean_u = fit.a[0][1] / weight, mean_v = fit.a[0][2] / weight;
  if (mean_u * mean_u + mean_v * mean_v > kMaxBorder * kMaxBorder) return {};
  constexpr int kTermsOf[] = {1, 3, 6};
  for (int d = degree; d >= 0; --d) {
    if (!fit.solve(kTermsOf[d]) || (d > 0 && !(std::abs(fit.x[0]) <= kMaxHeight))) continue;
    const Vec3 slope = d > 0 ? Vec3(fit.x[1] * axes.u + fit.x[2] * axes.v) : Vec3::Zero();
    return {true, fit.x[0], slope};
  }
  return {};
}

}  // namespace

MlsSample MlsProjection::sample(Neighbourhood& near, const Vec3& x_W, const Vec3& side_W) const {
  const PointsView points = near.around(x_W).view();
  ExactMoments moments(near.sum_grid());
  for_each_weighted(points, x_W, radius_m_,
                    [&](double theta, double, const Vec3& e) { moments.add(theta, e); });
  MlsSample here;
  here.weight = moments.weight();
  if (!(here.weight > kMinSupport)) return here;
  const Vec3 mean = moments.mean();  // (a - x) / R
  const ThinnestAxis thin = thinnest_axis(moments.covariance());
  if (!(thin.middle > kMinVariance)) return here;
  const double ahead = side_W.isZero(0) ? -thin.axis.dot(mean) : thin.axis.dot(side_W);
  const Vec3 n = ahead < 0 ? Vec3(-thin.axis) : thin.axis;
  const double height = -n.dot(mean);
  if ((mean + height * n).norm() > kMaxBorder) return here;
  here.supported = true, here.value_m = radius_m_ * height, here.normal_W = n;
  return here;
}

MlsPlane MlsProjection::reference_plane(Neighbourhood& near, const Vec3& r_W, const Vec3& start_W) const {
  MlsPlane plane{true, r_W, start_W};
  double t = 0;  // unit: R
  for (int k = 0; k < kPlaneSteps; ++k) {
    const PointsView points = near.around(plane.q_W).view();
    const PlaneStep step = plane_step(points, near.sum_grid(), radius_m_, plane, t);
    if (!step.found) return {};
    const Vec3 turned = (plane.normal_W - step.slope).normalized();
    t = (t + step.offset) * plane.normal_W.dot(turned);
    if (!(std::abs(t) <= 1)) return {};
    plane.normal_W = turned;
    plane.q_W = r_W + (t * radius_m_) * turned;
    if (std::abs(step.offset) + step.slope.norm() <= kSamePlane) break;
  }
  if (plane.normal_W.dot(start_W) < 0) plane.normal_W = -plane.normal_W;
  return plane;
}

MlsFoot MlsProjection::project(Neighbourhood& near, const Vec3& x_W, const Vec3& start_W) const {
  const MlsFoot none{false, x_W};
  const Vec3 start = start_W.isZero(0) ? sample(near, x_W, start_W).normal_W : start_W;
  if (start.isZero(0)) return none;
  MlsFoot foot{true, x_W, start, start};
  for (int k = 0; k < kProjections; ++k) {
    const MlsPlane plane = reference_plane(near, foot.p_W, foot.plane_normal_W);
    if (!plane.found) return none;
    const PointsView points = near.around(plane.q_W).view();
    const LocalPolynomial fit = local_polynomial(points, near.sum_grid(), radius_m_, plane, degree_);
    if (!fit.found) return none;
    const Vec3 next_W = plane.q_W + (radius_m_ * fit.height) * plane.normal_W;
    foot.residual_m = (next_W - foot.p_W).norm();
    foot.p_W = next_W;
    foot.normal_W = (plane.normal_W - fit.slope).normalized();
    foot.plane_normal_W = plane.normal_W;
    if (foot.residual_m <= kSamePosition * radius_m_) break;
  }
  if (foot.normal_W.dot(start) < 0) foot.normal_W = -foot.normal_W;
  return foot;
}

namespace {

// h in units of the mean distance to the three nearest neighbours, and h while this distance is not known:
// the same multiple of 1.5 mm, the spacing of most scenes.
constexpr double kWidthInSpacings = 3, kUsualWidth_m = 0.0045;
constexpr double kMinWidth_m = 1e-6;
// Distances in units of h: distance between two checks of the HIP's path, and distance from which f alone
// decides.
constexpr double kCheckInWidths = 0.25, kClearInWidths = 0.5;
// Distances in units of R: longest slide in the tangent plane; slides up to kShortSlide use one test of
// progress only; a tangential distance below kMlsRest counts as none; largest residual of a settled
// projection.
constexpr double kLongestSlide = 0.25, kShortSlide = 1e-3, kMlsRest = 1e-5, kSettled = 1e-3;
constexpr int kSlideHalvings = 3;

// Returns the component of u perpendicular to the unit vector n.
Vec3 tangential_part(const Vec3& u, const Vec3& n) {
  return u - u.dot(n) * n;
}

bool is_behind(const MlsFoot& foot, const Vec3& p_W) {
  return foot.normal_W.dot(p_W - foot.p_W) < 0;
}

}  // namespace

Parameters parameters(MlsSurfaceParameters& p) {
  return {
      {"weight_width_m", &p.weight_width_m, 0, 1,
       "h of the weight exp(-d^2 / h^2) of a point at the distance d; points beyond R = 2.5 h have weight 0; "
       "0: three times the mean distance to the three nearest neighbours in the first frame"},
      {"degree", &p.degree, 1, 2, "degree of the polynomial that is fitted over the reference plane"},
      {"outside", choice(p.outside, {"sensor", "path"}), 0, 0,
       "outside of the surface while there is no contact; sensor: the side that the sensor sees; path: the "
       "side from which the proxy came"},
      {"view_direction", &p.view_direction, -1, 1,
       "viewing direction of the sensor; for images the ray of each pixel is used instead"},
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 0, 10000, "spring k_s between HIP and proxy", kLive},
      {"steps_per_tick", &p.steps_per_tick, 4, 100000,
       "number of checked positions and projections after which a haptic tick ends (up to 2 more)"},
  };
}

std::string validate(const MlsSurfaceParameters& p) {
  if (p.weight_width_m != 0 && p.weight_width_m < kMinWidth_m)
    return "weight_width_m: expected 0, or 0.000001 or more";
  return p.view_direction.norm() < 0.001 ? "view_direction: expected a vector of length 0.001 or more" : "";
}

MlsSurfaceRenderer::MlsSurfaceRenderer(const MlsSurfaceParameters& parameters, double, const Kernels& kernels)
    : RivalOf(parameters,
              MlsProjection::kSupportInWidths *
                  (parameters.weight_width_m > 0 ? parameters.weight_width_m : kUsualWidth_m),
              kernels),
      surface_(parameters.weight_width_m > 0 ? parameters.weight_width_m : kUsualWidth_m, parameters.degree),
      has_width_(parameters.weight_width_m > 0),
      nearest_(kernels) {
  view_.direction_W = parameters.view_direction;
}

void MlsSurfaceRenderer::reserve(std::size_t points) {
  RivalRenderer::reserve(points);
  if (!has_width_) nearest_.reserve(points);
}

bool MlsSurfaceRenderer::set_points(const NeighbourSearch& points) {
  view_ = view_point(points, p_.view_direction);
  if (!has_width_) choose_width(points);
  return true;
}

// Computes h from the spacing of the points, if there are enough of them.
void MlsSurfaceRenderer::choose_width(const NeighbourSearch& points) {
  const double spacing_m = mean_spacing_m(points, nearest_, kernels_, buffer_);
  if (!(spacing_m > 0)) return;
  surface_ = MlsProjection(kWidthInSpacings * spacing_m, p_.degree);
  near_.set_reach(surface_.support_radius_m());
  has_width_ = true;
}

MlsSample MlsSurfaceRenderer::sample(const Vec3& p_W) {
  ++steps_;
  const Vec3 side_W = p_.outside == OutsideRule::sensor ? Vec3(-view_.ray_to(p_W)) : side_W_;
  const MlsSample here = surface_.sample(near_, p_W, side_W);
  side_W_ = here.normal_W;
  if (here.supported) normal_W_ = here.normal_W;
  return here;
}

MlsFoot MlsSurfaceRenderer::project(const Vec3& p_W, const Vec3& start_W) {
  ++steps_;
  return surface_.project(near_, p_W, start_W);
}

// Moves the proxy to the projection.
void MlsSurfaceRenderer::stand_on(const MlsFoot& foot) {
  proxy_W_ = foot.p_W;
  normal_W_ = side_W_ = foot.normal_W;
  start_W_ = foot.plane_normal_W;
  residual_m_ = foot.residual_m;
}

// Computes one tick. It starts in the same way with and without a new frame, so that a frame with the same
// points changes nothing.
void MlsSurfaceRenderer::touch(const Vec3& hip_W, RenderOutput& out) {
  steps_ = 0;
  if (is_held_) out.converged = follow(hip_W);
  if (!is_held_) {
    out.converged = approach(hip_W);
    if (is_held_) out.converged = follow(hip_W);
  }
  report(hip_W, out);
}

// Moves from the proxy towards the HIP, up to the first checked position behind the surface. If no point is
// near, it skips the distance to the first point. Returns true if it has reached the HIP.
bool MlsSurfaceRenderer::approach(const Vec3& hip_W) {
  const double R = surface_.support_radius_m();
  MlsSample here = sample(proxy_W_);
  while (may_step()) {
    const Vec3 u = hip_W - proxy_W_;
    const double distance = u.norm();
    double path_length = kCheckInWidths * surface_.weight_width_m();
    if (path_length < distance && here.weight == 0)
      path_length += near_.first_hit_of_points(proxy_W_, u / distance, R, distance);
    const bool is_last = !(path_length < distance);
    proxy_W_ = is_last ? hip_W : Vec3(proxy_W_ + path_length / distance * u);
    here = sample(proxy_W_);
    if (begins_contact(here)) return false;
    if (is_last) return true;
  }
  return false;
}

// Returns true if the proxy is behind the surface. The proxy is then moved onto it, and held.
bool MlsSurfaceRenderer::begins_contact(const MlsSample& here) {
  if (!here.supported || here.value_m > kClearInWidths * surface_.weight_width_m()) return false;
  const MlsFoot foot = project(proxy_W_, here.normal_W);
  if (!foot.found || !is_behind(foot, proxy_W_)) return false;
  stand_on(foot);
  return is_held_ = true;
}

// Computes one tick in contact. Returns true if the proxy is at rest. The proxy is released where the surface
// ends, or when the HIP is in front of it.
bool MlsSurfaceRenderer::follow(const Vec3& hip_W) {
  MlsFoot here = project(proxy_W_, start_W_);
  bool may_slide = true;
  while (may_slide && here.found && is_behind(here, hip_W) && may_step()) may_slide = slide(here, hip_W);
  if (here.found)
    stand_on(here);
  else
    proxy_W_ = here.p_W, side_W_ = Vec3::Zero();
  is_held_ = here.found && is_behind(here, hip_W);
  return is_held_ && !may_slide;
}

// Moves in the tangent plane towards the HIP, and back to the surface. A slide must bring the proxy nearer to
// the HIP, in the new tangent plane or in space, or beyond the end of the surface. For short slides only the
// distance in the tangent plane counts, because squared distances are too coarse. Returns false if the proxy
// is at rest.
bool MlsSurfaceRenderer::slide(MlsFoot& here, const Vec3& hip_W) {
  const double R = surface_.support_radius_m();
  const Vec3 u = hip_W - here.p_W, tangential = tangential_part(u, here.normal_W);
  const double length = tangential.norm();
  if (length <= kMlsRest * R) return false;
  double stride = std::min(length, kLongestSlide * R);
  for (int k = 0; k <= kSlideHalvings; ++k, stride *= 0.5) {
    if (!may_step()) return true;
    const MlsFoot next = project(here.p_W + stride / length * tangential, here.plane_normal_W);
    const Vec3 rest = hip_W - next.p_W;
    const bool is_nearer = tangential_part(rest, next.normal_W).norm() < length ||
                           (stride > kShortSlide * R && rest.squaredNorm() < u.squaredNorm());
    if (next.found && !is_nearer) continue;
    here = next;
    return true;
  }
  return false;
}

void MlsSurfaceRenderer::report(const Vec3& hip_W, RenderOutput& out) {
  out.steps = steps_;
  const PointsView points = near_.around(proxy_W_).view();
  const ContactQuery query = query_near_proxy(points, near_.sum_grid(), surface_.support_radius_m(), out);
  out.contact_count = static_cast<int>(query.touching_count);
  if (!is_held_) return;
  const bool is_settled = residual_m_ <= kSettled * surface_.support_radius_m();
  out.state = is_settled ? ContactState::contact : ContactState::entrenched;
  out.force_N = stiffness_of(query) * (proxy_W_ - hip_W);
}

}  // namespace remote_touch
