#include "core/rivals/implicit_surface_renderers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/rivals/point_normals.h"

namespace remote_touch {
namespace {

// Lengths are in units of R.
constexpr double kStride = 0.125;     // longest step of a walk or a slide
constexpr double kMaxNewton = 0.5;    // longest step back to the surface
constexpr double kOnSurface = 1e-10;  // a position at most this far from f = 0 is on the surface
constexpr double kMinMove = 1e-9;     // a shorter displacement counts as none
constexpr double kNearRest = 1e-4;    // strides up to this use the other test of progress
constexpr int kNewtonSteps = 10, kBisections = 12, kHalvings = 6;

bool is_inside(const SurfaceSample& sample) {
  return sample.supported && sample.distance() < -kOnSurface;
}

bool is_on_surface(const SurfaceSample& sample) {
  return sample.supported && std::abs(sample.distance()) <= kOnSurface;
}

// Returns v without its component along the unit vector n.
Vec3 less(const Vec3& v, const Vec3& n) {
  return v - v.dot(n) * n;
}

// Returns the integral of the weight over q^2, from q = h to q = 1. q: distance in units of R. h: height in
// the same units.
double weight_above(SurfaceWeight weight, double h) {
  if (weight == SurfaceWeight::wyvill) {
    const double a = 1 - h * h;
    return a * a * a * (5.0 / 27 + a / 9);
  }
  const double b = 1 - h, to_fifth = b * b * b * b * b;
  return 2 * to_fifth * (1 - 1.5 * b + b * b * (4.0 / 7));
}

// R in units of the mean distance to the three nearest neighbours, and R for a cloud of fewer than four
// points.
constexpr double kRadiusInSpacings = 3, kRadiusWithoutSpacing_m = 0.01;
// Lengths are in units of R: the longest step between two checks of the HIP's path, the longest slide of a
// tick in the tangent plane, and the longest projection. A displacement shorter than kSurfelRest counts as
// none.
constexpr double kCheckStride = 0.125, kMaxSlide = 0.5, kMaxProjection = 0.5, kSurfelRest = 1e-9;
constexpr int kMaxChecks = 64;

}  // namespace

RenderedContact rendered_contact(const ImplicitSurfaceParameters& p) {
  if (p.surface == SurfaceKind::surfels) return {};
  const double points = std::numbers::pi * (p.support_radius_m / kReferenceSpacing_m) *
                        (p.support_radius_m / kReferenceSpacing_m);
  double low = 0, high = 1;
  for (double middle = 0.5; middle > low && middle < high; middle = 0.5 * (low + high))
    (points * weight_above(p.weight, middle) > p.threshold ? low : high) = middle;
  return {p.support_radius_m * low};
}

Parameters parameters(ImplicitSurfaceParameters& p) {
  return {
      {"surface", choice(p.surface, {"metaballs", "surfels"}), 0, 0,
       "surface f = 0 of [84]; metaballs: f = T - sum of weights; surfels: f = n . (p - a), a plane by weighted total least squares"},
      {"weight", choice(p.weight, {"wyvill", "wendland"}), 0, 0,
       "weight w(q) at the distance q R; wyvill: 1 - 4/9 q^6 + 17/9 q^4 - 22/9 q^2; wendland: (1 - q)^4 (4 q + 1)"},
      {"support_radius_m", &p.support_radius_m, 1e-6, 1,
       "R of [84]: points at a larger distance have weight 0"},
      {"threshold", &p.threshold, 1e-3, 1000,
       "T of the metaballs [84]; with T below 1 a single point is solid"},
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 0, 10000, "spring k_s between HIP and proxy", kLive},
      {"steps_per_tick", &p.steps_per_tick, 1, 100000, "maximum number of evaluations of f in a haptic tick"},
  };
}

ImplicitSurfaceRenderer::ImplicitSurfaceRenderer(const ImplicitSurfaceParameters& parameters, double,
                                                 const Kernels& kernels)
    : RivalOf(parameters, parameters.support_radius_m, kernels),
      surface_(parameters.surface, parameters.weight, parameters.support_radius_m, parameters.threshold) {}

ImplicitSurfaceRenderer::Place ImplicitSurfaceRenderer::place(const Vec3& p_W, const Vec3& side) {
  ++steps_;
  const PointsView points = near_.around(p_W).view();
  return {p_W, surface_.at(points, near_.sum_grid(), p_W, side)};
}

// Computes one tick. It starts in the same way with and without a new frame, so that a frame with the same
// points changes nothing.
void ImplicitSurfaceRenderer::touch(const Vec3& hip_W, RenderOutput& out) {
  steps_ = 0;
  Place here = place(proxy_W_, side_);
  if (is_inside(here.sample)) settle(here);
  while (steps_ < p_.steps_per_tick && !is_inside(here.sample)) {
    if (advance(here, hip_W)) continue;
    out.converged = true;
    break;
  }
  proxy_W_ = here.p_W;
  side_ = here.sample.supported ? here.sample.normal() : Vec3::Zero();
  if (!side_.isZero(0)) normal_W_ = side_;
  report(here, hip_W, out);
}

// Moves by Newton's steps to f = 0. Returns false if they do not reach it; here is then their last position.
bool ImplicitSurfaceRenderer::settle(Place& here) {
  for (int k = 0; k < kNewtonSteps && here.sample.supported; ++k) {
    if (is_on_surface(here.sample)) return true;
    const Vec3 n = here.sample.normal();
    if (n.isZero(0)) return false;
    const double step = std::clamp(here.sample.distance(), -kMaxNewton, kMaxNewton);
    here = place(here.p_W - (p_.support_radius_m * step) * n, n);
  }
  return is_on_surface(here.sample);
}

// Moves by one step of the scheme. Returns false if the proxy is at rest.
bool ImplicitSurfaceRenderer::advance(Place& here, const Vec3& hip_W) {
  const Vec3 u = hip_W - here.p_W;
  if (u.isZero(0)) return false;
  const bool held = is_on_surface(here.sample) && here.sample.normal().dot(u) < 0;
  return held ? slide(here, hip_W) : walk(here, hip_W);
}

// Moves straight towards the HIP, by one stride or up to the surface. If no point is near, it first skips the
// distance to the first point.
bool ImplicitSurfaceRenderer::walk(Place& here, const Vec3& hip_W) {
  const double R = p_.support_radius_m, distance = (hip_W - here.p_W).norm();
  const Vec3 direction = (hip_W - here.p_W) / distance;
  double path_length = kStride * R;
  if (!here.sample.supported) path_length += near_.first_hit_of_points(here.p_W, direction, R, distance);
  const Vec3 goal = path_length < distance ? Vec3(here.p_W + path_length * direction) : hip_W;
  const Place next = place(goal, here.sample.normal());
  if (!is_inside(next.sample)) {
    here = next;
    return true;
  }
  const Vec3 start = here.p_W;
  stop_at_surface(here, next);
  return (here.p_W - start).norm() > kMinMove * R;
}

// Bisects the segment between the two positions, then continues with Newton's steps.
void ImplicitSurfaceRenderer::stop_at_surface(Place& outside, Place inside) {
  for (int k = 0; k < kBisections && !is_on_surface(outside.sample); ++k) {
    const Place middle = place(0.5 * (outside.p_W + inside.p_W), outside.sample.normal());
    (is_inside(middle.sample) ? inside : outside) = middle;
  }
  Place settled = outside;
  if (settle(settled)) outside = settled;
}

// Moves in the tangent plane towards the HIP, and back to the surface. A step must bring the proxy nearer to
// the HIP. Squared distances are too coarse to show this near rest; there the remaining tangential distance
// must become shorter.
bool ImplicitSurfaceRenderer::slide(Place& here, const Vec3& hip_W) {
  const Vec3 n = here.sample.normal(), u = hip_W - here.p_W, tangential = less(u, n);
  const double length = tangential.norm(), R = p_.support_radius_m;
  if (length <= kMinMove * R) return false;
  double stride = std::min(length, kStride * R);
  for (int k = 0; k < kHalvings; ++k, stride *= 0.5) {
    Place next = place(here.p_W + (stride / length) * tangential, n);
    const bool beyond_edge = !next.sample.supported;
    if (!beyond_edge && !settle(next)) continue;
    const Vec3 rest = hip_W - next.p_W;
    const bool is_better = stride > kNearRest * R ? rest.squaredNorm() < u.squaredNorm()
                                                  : less(rest, next.sample.normal()).norm() < length;
    if (!beyond_edge && !is_better) continue;
    here = next;
    return true;
  }
  return false;
}

void ImplicitSurfaceRenderer::report(const Place& here, const Vec3& hip_W, RenderOutput& out) {
  const PointsView points = near_.around(proxy_W_).view();
  const ContactQuery query = query_near_proxy(points, near_.sum_grid(), p_.support_radius_m, out);
  out.contact_count = static_cast<int>(query.touching_count);
  out.steps = steps_;
  const Vec3 u = hip_W - proxy_W_;
  if (is_inside(here.sample)) {
    out.state = ContactState::entrenched;
    if (here.sample.normal().isZero(0)) out.status = RenderStatus::degenerate_normal;
  } else if (is_on_surface(here.sample) && here.sample.normal().dot(u) < 0) {
    out.state = ContactState::contact;
  }
  if (out.state != ContactState::free) out.force_N = -stiffness_of(query) * u;
}

Parameters parameters(SurfelParameters& p) {
  return {
      {"support_radius_m", &p.support_radius_m, 0, 1,
       "R of [84]: points at a larger distance have weight 0; 0: three times the mean distance to the three nearest neighbours in the first frame"},
      {"weight", choice(p.weight, {"wyvill", "wendland"}), 0, 0,
       "weight w(q) at the distance q R; wyvill: 1 - 4/9 q^6 + 17/9 q^4 - 22/9 q^2; wendland: (1 - q)^4 (4 q + 1)"},
      {"normal_neighbours", &p.normal_neighbours, 3, 100,
       "number of nearest points, the point itself included, whose thinnest axis is the normal of a point"},
      {"previous_normal_fraction", &p.previous_normal_fraction, 0, 0.99,
       "weight of the previous tick's normal in the normal of a tick; the new normal has the remaining weight"},
      {"friction", &p.friction, 0, 2,
       "coefficient of friction: the proxy slides by the tangential distance of the HIP minus this coefficient times "
       "the depth of the HIP"},
      {"fused_frames", &p.fused_frames, 1, 4, "number of newest frames that are joined to one cloud"},
      {"view_direction", &p.view_direction, -1, 1,
       "viewing direction of the sensor, to which normals are turned; for images the ray of each pixel is used instead"},
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 0, 10000, "spring k_s between HIP and proxy", kLive},
  };
}

std::string validate(const SurfelParameters& p) {
  return p.view_direction.norm() < 0.001 ? "view_direction: expected a vector of length 0.001 or more" : "";
}

SurfelRenderer::SurfelRenderer(const SurfelParameters& parameters, double, const Kernels& kernels)
    : RivalOf(parameters, kRadiusWithoutSpacing_m, kernels), radius_m_(parameters.support_radius_m) {
  for (int frame = 0; frame < p_.fused_frames; ++frame)
    frames_.push_back({nullptr, PointNormals(p_.normal_neighbours, kernels)});
}

void SurfelRenderer::reserve(std::size_t points) {
  RivalRenderer::reserve(points);
  for (FusedFrame& frame : frames_) frame.normals.reserve(points);
  gathered_normals_.grow(points + kLanes);
}

std::shared_ptr<const NeighbourSearch> SurfelRenderer::shown(const Frame& frame) {
  newest_ = (newest_ + 1) % frames_.size();
  FusedFrame& newest = frames_[newest_];
  newest.points = frame.points;
  newest.normals.set_points(*frame.points, view_point(*frame.points, p_.view_direction));
  return frames_.size() == 1 ? frame.points : make_search(joined());
}

// Joins the points of the frames, each in the order of every_point(). The normals must be those of each frame
// by itself: the joined cloud has no camera, and repeated points have no plane.
PointCloud SurfelRenderer::joined() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  PointCloud all;
  const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (FusedFrame& frame : frames_) {
    frame.first = all.size();
    if (!frame.points) continue;
    const PointCloud& cloud = frame.points->every_point(kernels_, buffer_);
    append(all.x, cloud.x), append(all.y, cloud.y), append(all.z, cloud.z);
    if (cloud.stiffness_N_per_m.empty() && all.stiffness_N_per_m.empty()) continue;
    all.stiffness_N_per_m.resize(frame.first, kNone);
    append(all.stiffness_N_per_m, cloud.stiffness_N_per_m);
    all.stiffness_N_per_m.resize(all.size(), kNone);
  }
  return all;
}

// Returns the normal of a point of the joined cloud, or of the newest frame if only that one is shown.
Vec3 SurfelRenderer::normal_of(std::uint32_t number, const Vec3& x_W) {
  std::size_t frame = frames_.size() - 1;
  while (number < frames_[frame].first) --frame;
  return frames_[frame].normals.of(number - static_cast<std::uint32_t>(frames_[frame].first), x_W);
}

bool SurfelRenderer::set_points(const NeighbourSearch& points) {
  gathered_normals_.grow(points.size() + kLanes);
  if (radius_m_ == 0 && points.size() > 0) {
    radius_m_ =
        kRadiusInSpacings * mean_spacing_m(points, frames_[newest_].normals.nearest(), kernels_, buffer_);
    if (radius_m_ == 0) radius_m_ = kRadiusWithoutSpacing_m;
  }
  return true;
}

SurfaceSample SurfelRenderer::sample(const Vec3& p_W) {
  ++samples_;
  if (radius_m_ == 0) return {};
  const GatheredPoints& near = near_.within(p_W, radius_m_);
  PointsView points = near.view();
  points.radius = nullptr;
  for (std::size_t i = 0; i < near.size(); ++i)
    gathered_normals_[i] = normal_of(near.index()[i], {points.x[i], points.y[i], points.z[i]});
  const PointSurface surface(SurfaceKind::surfels, p_.weight, radius_m_, 1);
  return surface.oriented(points, gathered_normals_.data(), sum_grid_for(near.size()), p_W);
}

void SurfelRenderer::touch(const Vec3& hip_W, RenderOutput& out) {
  samples_ = 0;
  const Vec3 before_W = proxy_W_;
  if (is_held_) follow(hip_W);
  if (!is_held_) {
    approach(hip_W);
    if (is_held_) follow(hip_W);
  }
  out.converged = (proxy_W_ - before_W).norm() <= kSurfelRest * radius_m_;
  report(hip_W, out);
}

void SurfelRenderer::release(const Vec3& hip_W) {
  is_held_ = false;
  depth_m_ = 0;
  proxy_W_ = hip_W;
}

// Moves from the last HIP position to the current one, up to the first checked position behind the surface.
// If no point is near, it skips the distance to the first point. After kMaxChecks checks it stops; the next
// tick continues from there.
void SurfelRenderer::approach(const Vec3& hip_W) {
  const double R = radius_m_;
  for (int check = 1; check <= kMaxChecks; ++check) {
    const Vec3 u = hip_W - proxy_W_;
    const double distance = u.norm();
    double path_length = kCheckStride * R;
    if (path_length < distance && R > 0 && near_.within(proxy_W_, R).size() == 0)
      path_length += near_.first_hit(proxy_W_, u / distance, R, distance);
    const bool is_last = !(path_length < distance) || R == 0;
    proxy_W_ = is_last ? hip_W : Vec3(proxy_W_ + path_length / distance * u);
    const SurfaceSample here = sample(proxy_W_);
    if (here.supported && here.value < 0) {
      is_held_ = true;
      normal_W_ = here.normal();
    }
    if (is_held_ || is_last) return;
  }
}

// Computes one tick in contact.
void SurfelRenderer::follow(const Vec3& hip_W) {
  const double R = radius_m_;
  const Vec3 u = hip_W - proxy_W_, tangential = u - u.dot(normal_W_) * normal_W_;
  const double length = tangential.norm(), held_back = p_.friction * std::max(0.0, -u.dot(normal_W_));
  const double slide = std::min(length - held_back, kMaxSlide * R);
  const Vec3 to_W = slide > 0 ? Vec3(proxy_W_ + slide / length * tangential) : proxy_W_;
  const SurfaceSample here = sample(to_W);
  if (!here.supported) return release(hip_W);
  const Vec3 blended =
      p_.previous_normal_fraction * normal_W_ + (1 - p_.previous_normal_fraction) * here.normal();
  normal_W_ = blended.norm() > 0.1 ? Vec3(blended.normalized()) : here.normal();
  const double projection = std::clamp(here.value, -kMaxProjection, kMaxProjection);
  proxy_W_ = to_W - projection * R * normal_W_;
  depth_m_ = std::max(0.0, (projection - here.value) * R);
  if (normal_W_.dot(hip_W - proxy_W_) >= depth_m_) release(hip_W);
}

void SurfelRenderer::report(const Vec3& hip_W, RenderOutput& out) {
  out.steps = samples_;
  const GatheredPoints& near = near_.within(proxy_W_, radius_m_);
  const ContactQuery query = query_near_proxy(near.view(), sum_grid_for(near.size()), radius_m_, out);
  out.contact_count = static_cast<int>(query.touching_count);
  if (!is_held_) return;
  out.state = depth_m_ > 0 ? ContactState::entrenched : ContactState::contact;
  out.force_N = stiffness_of(query) * (proxy_W_ - hip_W);
}

}  // namespace remote_touch
