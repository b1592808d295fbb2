#include "core/rivals/mls_surface_renderer.h"

#include <algorithm>

namespace remote_touch {

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
