#include "core/rivals/god_object_renderer.h"

#include <algorithm>
#include <sstream>

namespace remote_touch {

namespace {

// Radius of the ball in which the mesh is computed, and longest motion of one round, in units of the edge
// limit.
constexpr double kMeshed = 0.5, kMaxStride = 0.25;
// Tolerance in units of the surface offset: a shorter motion counts as none, and a plane may be violated by
// it.
constexpr double kRestTolerance = 1e-6;

}  // namespace

Parameters parameters(GodObjectParameters& p) {
  return {
      {"max_edge_length_m", &p.max_edge_length_m, 1e-6, 1,
       "triangles with a longer edge are ignored, as at depth edges"},
      {"surface_offset_m", &p.surface_offset_m, 1e-9, 0.01,
       "distance that the god-object keeps from constraint planes, so that its side is unambiguous"},
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 0, 10000,
       "spring k_s between HIP and god-object, Zilles and Salisbury 1995", kLive},
      {"steps_per_tick", &p.steps_per_tick, 1, 100000, "maximum number of iterations in a haptic tick"},
  };
}

std::string validate(const GodObjectParameters& p) {
  constexpr double kMinRatio = 10;
  if (kMinRatio * p.surface_offset_m <= p.max_edge_length_m) return {};
  std::ostringstream text;
  text << "surface_offset_m = " << p.surface_offset_m
       << ": expected at most a tenth of max_edge_length_m = " << p.max_edge_length_m;
  return text.str();
}

GodObjectRenderer::GodObjectRenderer(const GodObjectParameters& parameters, double, const Kernels& kernels)
    : RivalRenderer(parameters.max_edge_length_m, parameters.stiffness_N_per_m, kernels),
      p_(parameters),
      mesh_(parameters.max_edge_length_m),
      planes_(kRestTolerance * parameters.surface_offset_m) {}

void GodObjectRenderer::reserve(std::size_t points) {
  RivalRenderer::reserve(points);
  mesh_.reserve(points);
}

bool GodObjectRenderer::set_points(const NeighbourSearch& points) {
  mesh_.reserve(points.size());
  columns_ = points.organised_columns();
  is_meshed_ = false;
  return columns_ > 0;
}

// Updates the mesh around the god-object. It is large enough for every motion of one round; triangles farther
// away have no effect.
void GodObjectRenderer::update_mesh() {
  const double radius = kMeshed * p_.max_edge_length_m, margin = radius - kMaxStride * p_.max_edge_length_m;
  if (is_meshed_ && (proxy_W_ - meshed_W_).squaredNorm() <= margin * margin) return;
  meshed_W_ = proxy_W_;
  is_meshed_ = true;
  // The reach has a margin for rounding, so that no triangle is lost.
  const double reach = (radius + p_.max_edge_length_m) * (1 + 1e-9);
  mesh_.assign(near_.within(meshed_W_, reach), columns_, {meshed_W_, radius * (1 + 1e-9)});
}

void GodObjectRenderer::touch(const Vec3& hip_W, RenderOutput& out) {
  rounds_ = 0;
  active_planes_ = 0;
  out.converged = false;
  while (rounds_ < p_.steps_per_tick && !out.converged) out.converged = !follow(hip_W);
  report(hip_W, out);
}

// Moves the god-object to the position that is nearest to the HIP and that the triangles in the way allow.
// Returns true if it moved.
bool GodObjectRenderer::follow(const Vec3& hip_W) {
  const Vec3 start_W = proxy_W_;
  planes_.clear();
  while (rounds_ < p_.steps_per_tick) {
    ++rounds_;
    const PlaneConstraints::Nearest nearest = planes_.nearest(hip_W);
    active_planes_ = nearest.found ? nearest.active_planes : 3;
    if (!nearest.found || go(nearest.position)) break;
  }
  return (proxy_W_ - start_W).norm() > kRestTolerance * p_.surface_offset_m;
}

// Moves straight towards the goal, by at most one stride, or up to the first triangle, whose plane is then
// added. Returns true if this search for planes is over, because no triangle was in the way or there are too
// many planes.
bool GodObjectRenderer::go(const Vec3& goal) {
  update_mesh();
  const Vec3 displacement = goal - proxy_W_;
  const double length = displacement.norm(), max_length = kMaxStride * p_.max_edge_length_m;
  const Vec3 end = length > max_length ? Vec3(proxy_W_ + (max_length / length) * displacement) : goal;
  const std::optional<Crossing> crossing = mesh_.first_crossing(proxy_W_, end);
  if (!crossing) {
    proxy_W_ = end;
    return true;
  }
  const Triangle& t = *crossing->triangle;
  const Vec3 normal = t.normal.dot(proxy_W_ - t.a) < 0 ? Vec3(-t.normal) : t.normal;
  if (crossing->start > p_.surface_offset_m)
    proxy_W_ +=
        (crossing->start - p_.surface_offset_m) / (crossing->start - crossing->end) * (end - proxy_W_);
  return !planes_.add(normal, t.a, p_.surface_offset_m);
}

void GodObjectRenderer::report(const Vec3& hip_W, RenderOutput& out) {
  const PointsView points = near_.around(proxy_W_).view();
  const ContactQuery query = query_near_proxy(points, near_.sum_grid(), p_.max_edge_length_m, out);
  out.steps = rounds_;
  if (active_planes_ == 0) return;
  const Vec3 push = proxy_W_ - hip_W;
  out.contact_count = active_planes_;
  out.state = ContactState::contact;
  out.force_N = stiffness_of(query) * push;
  if (!push.isZero(0)) normal_W_ = push.normalized();
}

}  // namespace remote_touch
