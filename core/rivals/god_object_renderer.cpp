#include "core/rivals/god_object_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace remote_touch {
namespace {

// The fraction of its size by which a triangle is enlarged; it is far above rounding.
constexpr double kSeam = 1e-9;

// Returns the area of (a, b, p), seen along the normal, as a fraction of the area of the triangle. It is 0 or
// more on the inner side of the edge ab.
double beside_edge(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& normal, double doubled_area) {
  return (b - a).cross(p - a).dot(normal) / doubled_area;
}

bool contains(const Triangle& t, const Vec3& p) {
  const double doubled = (t.b - t.a).cross(t.c - t.a).dot(t.normal);
  return beside_edge(t.a, t.b, p, t.normal, doubled) >= -kSeam &&
         beside_edge(t.b, t.c, p, t.normal, doubled) >= -kSeam &&
         beside_edge(t.c, t.a, p, t.normal, doubled) >= -kSeam;
}

// Planes whose normals span less than this (squared sine, or volume) are not combined, because their
// intersection is far away or does not exist. The choices without one of them remain.
constexpr double kParallel = 1e-9;

// Radius of the ball in which the mesh is computed, and longest motion of one round, in units of the edge
// limit.
constexpr double kMeshed = 0.5, kMaxStride = 0.25;
// Tolerance in units of the surface offset: a shorter motion counts as none, and a plane may be violated by
// it.
constexpr double kRestTolerance = 1e-6;

}  // namespace

void GridMesh::reserve(std::size_t points) {
  triangles_.grow(2 * points);
  index_plus_one_.grow(2 * points);  // room for a last row that is not full
}

void GridMesh::assign(const GatheredPoints& points, int columns, const Ball& ball) {
  count_ = 0;
  if (points.size() == 0) return;
  const auto wide = static_cast<std::uint32_t>(columns);
  std::uint32_t first_row = ~0u, last_row = 0, first_column = ~0u, last_column = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t row = points.index()[i] / wide, column = points.index()[i] % wide;
    first_row = std::min(first_row, row), last_row = std::max(last_row, row);
    first_column = std::min(first_column, column), last_column = std::max(last_column, column);
  }
  const std::size_t width = last_column - first_column + 1, height = last_row - first_row + 1;
  std::fill_n(index_plus_one_.data(), width * height, 0u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t row = points.index()[i] / wide, column = points.index()[i] % wide;
    index_plus_one_[(row - first_row) * width + (column - first_column)] = static_cast<std::uint32_t>(i) + 1;
  }

  const PointsView view = points.view();
  const auto point = [&](std::uint32_t place) {
    return Vec3(view.x[place - 1], view.y[place - 1], view.z[place - 1]);
  };
  for (std::size_t row = 0; row + 1 < height; ++row) {
    for (std::size_t column = 0; column + 1 < width; ++column) {
      const std::uint32_t* const upper = index_plus_one_.data() + row * width + column;
      const std::uint32_t a = upper[0], b = upper[1], c = upper[width], d = upper[width + 1];
      const int measured = (a != 0) + (b != 0) + (c != 0) + (d != 0);
      if (measured < 3) continue;
      if (a != 0 && b != 0 && c != 0) add(point(a), point(b), point(c), ball);
      if (d != 0 && c != 0 && b != 0) add(point(d), point(c), point(b), ball);
      if (c == 0) add(point(a), point(b), point(d), ball);
      if (b == 0) add(point(a), point(d), point(c), ball);
    }
  }
}

void GridMesh::add(const Vec3& a, const Vec3& b, const Vec3& c, const Ball& ball) {
  const double limit = edge_limit_m_ * edge_limit_m_;
  if (!((b - a).squaredNorm() <= limit && (c - b).squaredNorm() <= limit && (a - c).squaredNorm() <= limit))
    return;
  const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  const Vec3 nearest = ball.centre.cwiseMax(low).cwiseMin(high);
  if ((nearest - ball.centre).squaredNorm() > ball.radius * ball.radius) return;
  const Vec3 n = (b - a).cross(c - a);
  const double length = n.norm();
  if (!(length > 0)) return;  // three points on a line form no triangle
  triangles_[count_++] = {a, b, c, n / length};
}

std::optional<Crossing> GridMesh::first_crossing(const Vec3& from, const Vec3& to) const {
  std::optional<Crossing> first;
  for (const Triangle& t : triangles()) {
    const double over = t.normal.dot(from - t.a), side = over < 0 ? -1 : 1;
    const Crossing crossing{&t, side * over, side * t.normal.dot(to - t.a)};
    if (!(crossing.start > 0 && crossing.end <= 0)) continue;
    if (first && !(crossing.fraction() < first->fraction())) continue;
    if (contains(t, from + crossing.fraction() * (to - from))) first = crossing;
  }
  return first;
}

bool PlaneConstraints::add(const Vec3& normal, const Vec3& point, double offset_m) {
  if (count_ == kMaxCount) return false;
  planes_[count_++] = {normal, point, offset_m};
  return true;
}

// Tries the motions from the goal onto one, two and three planes, and keeps the shortest one that obeys all
// planes.
PlaneConstraints::Nearest PlaneConstraints::nearest(const Vec3& goal) const {
  std::array<double, kMaxCount> rise;  // by which the goal must rise along each normal
  for (std::size_t i = 0; i < count_; ++i)
    rise[i] = planes_[i].normal.dot(planes_[i].point - goal) + planes_[i].offset_m;
  double shortest = std::numeric_limits<double>::infinity();
  Nearest best{false, goal, 0};
  const auto offer = [&](const Vec3& motion, int active_planes) {
    const double squared = motion.squaredNorm();
    if (!(squared < shortest)) return;
    for (std::size_t i = 0; i < count_; ++i)
      if (!(planes_[i].normal.dot(motion) >= rise[i] - slack_m_)) return;
    shortest = squared, best = {true, goal + motion, active_planes};
  };
  offer(Vec3::Zero(), 0);
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec3& n_i = planes_[i].normal;
    offer(rise[i] * n_i, 1);
    for (std::size_t j = i + 1; j < count_; ++j) {
      // y - goal = l_i n_i + l_j n_j, with the multipliers from the equations of both planes.
      const Vec3 &n_j = planes_[j].normal, ij = n_i.cross(n_j);
      const double between = n_i.dot(n_j), rest = ij.squaredNorm();
      if (rest > kParallel) {
        const double l_i = (rise[i] - between * rise[j]) / rest, l_j = (rise[j] - between * rise[i]) / rest;
        offer(l_i * n_i + l_j * n_j, 2);
      }
      for (std::size_t k = j + 1; k < count_; ++k) {  // Cramer's rule
        const Vec3 &n_k = planes_[k].normal, jk = n_j.cross(n_k), ki = n_k.cross(n_i);
        const double volume = n_i.dot(jk);
        if (std::abs(volume) > kParallel) offer((rise[i] * jk + rise[j] * ki + rise[k] * ij) / volume, 3);
      }
    }
  }
  return best;
}

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
    : RivalOf(parameters, parameters.max_edge_length_m, kernels),
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
