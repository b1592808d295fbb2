#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace remote_touch {
namespace {

using Vec2 = Eigen::Vector2d;
using Triangles = std::vector<std::array<int, 3>>;

// Twice the area of a triangle, positive counter-clockwise.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

Triangles fan(std::size_t corners) {
  Triangles triangles;
  for (int i = 2; i < static_cast<int>(corners); ++i) triangles.push_back({0, i - 1, i});
  return triangles;
}

// Twice the area of the polygon, along its normal.
Vec3 area_vector(const std::vector<Vec3>& corners) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i)
    sum += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
  return sum;
}

// True if no triangle of the polygon's fan has an area; the limit is that of is_degenerate().
bool is_line(const std::vector<Vec3>& corners) {
  double max_length = 0, max_area = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    max_length = std::max(max_length, (corners[i] - corners[0]).squaredNorm());
    max_area = std::max(max_area, (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]).norm());
  }
  return max_area <= 1e-10 * max_length;
}

// True if the loops of a polygon that crosses itself cancel each other: the area vector is rounding.
bool has_no_normal(const std::vector<Vec3>& corners, const Vec3& area) {
  double max_length = 0;
  for (const Vec3& corner : corners) max_length = std::max(max_length, (corner - corners[0]).squaredNorm());
  return area.norm() <= 1e-10 * max_length;
}

// True if the corners are in one plane, up to the rounding of single precision.
bool is_flat(const std::vector<Vec3>& corners, const Vec3& unit_normal) {
  double max_height = 0, max_length = 0;
  for (const Vec3& corner : corners) {
    max_height = std::max(max_height, std::abs((corner - corners[0]).dot(unit_normal)));
    max_length = std::max(max_length, (corner - corners[0]).norm());
  }
  return max_height <= 1e-6 * max_length;
}

// Projects the polygon so that it runs counter-clockwise: along its normal, so that the result does not
// depend on the axes of the file. In a plane any direction shows the same polygon. There the projection drops
// one coordinate and computes none, because rounding would bend straight edges.
std::vector<Vec2> seen_flat(const std::vector<Vec3>& corners, const Vec3& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const double sign = normal[axis] < 0 ? -1 : 1;
  Vec3 x = Vec3::Unit((axis + 1) % 3), y = sign * Vec3::Unit((axis + 2) % 3);
  const Vec3 unit_normal = normal.normalized();
  if (!is_flat(corners, unit_normal)) {
    x = (x - x.dot(unit_normal) * unit_normal).normalized();
    y = unit_normal.cross(x);
  }
  std::vector<Vec2> flat;
  for (const Vec3& corner : corners) flat.emplace_back(x.dot(corner), y.dot(corner));
  return flat;
}

// Returns true if the directions from the first corner to the others turn counter-clockwise from one to the
// next, and by less than half a turn in all.
bool has_fan(const std::vector<Vec2>& at) {
  for (std::size_t i = 2; i < at.size(); ++i)
    if (!(turn(at[0], at[1], at[i]) > 0) || !(turn(at[0], at[i - 1], at[i]) > 0)) return false;
  return true;
}

bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const bool boxes_meet = (a.cwiseMin(b).array() <= c.cwiseMax(d).array()).all() &&
                          (c.cwiseMin(d).array() <= a.cwiseMax(b).array()).all();
  return boxes_meet && !(turn(a, b, c) * turn(a, b, d) > 0) && !(turn(c, d, a) * turn(c, d, b) > 0);
}

// True if no edges meet, except neighbours in their common corner.
bool is_simple(const std::vector<Vec2>& at) {
  const std::size_t n = at.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 &from = at[i], &to = at[(i + 1) % n], &next = at[(i + 2) % n];
    if (turn(from, to, next) == 0 && (from - to).dot(next - to) > 0) return false;
    for (std::size_t j = i + 2; j < n; ++j)
      if ((j + 1) % n != i && meet(from, to, at[j], at[(j + 1) % n])) return false;
  }
  return true;
}

// True if the triangle of a corner and its neighbours lies inside and contains no other corner.
bool is_ear(const std::vector<Vec2>& at, const std::vector<int>& left, std::size_t place) {
  const std::size_t n = left.size(), before = (place + n - 1) % n, after = (place + 1) % n;
  const Vec2 &a = at[left[before]], &b = at[left[place]], &c = at[left[after]];
  if (!(turn(a, b, c) > 0)) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (i == before || i == place || i == after) continue;
    const Vec2& p = at[left[i]];
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

// Cuts off one ear after the other. Returns nullopt if no ear is left before the polygon is used up.
std::optional<Triangles> ears(const std::vector<Vec2>& at) {
  std::vector<int> left(at.size());
  std::iota(left.begin(), left.end(), 0);
  Triangles triangles;
  for (std::size_t place = 0, tried = 0; left.size() > 2; place = (place + 1) % left.size()) {
    const std::size_t n = left.size();
    if (is_ear(at, left, place)) {
      triangles.push_back({left[(place + n - 1) % n], left[place], left[(place + 1) % n]});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(place));
      tried = 0;
    } else if (++tried == n) {
      return {};
    }
  }
  return triangles;
}

// Returns true if the areas of the triangles add up to that of the polygon. All areas are counted as
// positive, so an error of one cannot cancel that of another.
bool have_area_of_polygon(const Triangles& triangles, const std::vector<Vec2>& at) {
  double whole = 0, sum = 0;
  for (std::size_t i = 2; i < at.size(); ++i) whole += turn(at[0], at[i - 1], at[i]);
  for (const auto& [a, b, c] : triangles) sum += std::abs(turn(at[a], at[b], at[c]));
  return std::abs(sum - whole) <= 1e-9 * whole;
}

// Returns the root of a triangle's part in a forest of parents, and shortens the paths on the way.
int root_of(std::vector<int>& parent, int triangle) {
  while (parent[triangle] != triangle) triangle = parent[triangle] = parent[parent[triangle]];
  return triangle;
}

void count_edges(const std::vector<MeshEdge>& edges, MeshCheck& check) {
  for_each_edge(edges, [&](std::span<const MeshEdge> triangles) {
    if (triangles.size() == 1)
      ++check.boundary_edges;
    else if (triangles.size() > 2)
      ++check.non_manifold_edges;
    else if (triangles[0].forward == triangles[1].forward)
      ++check.inconsistent_edges;
  });
}

// Merges vertices: a vertex is replaced by the first one within reach of it. Cells that are twice the reach
// wide find it.
void weld(TriangleMesh& mesh, MeshRepair& done) {
  const BoundingBox box = bounding_box(mesh.vertices);
  const double reach = 1e-6 * box.sizes().maxCoeff();
  if (!(reach > 0)) return;
  using Cell = std::array<std::int64_t, 3>;
  std::map<Cell, std::vector<int>> cells;
  std::vector<int> now(mesh.vertices.size());
  std::vector<Vec3> kept;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 at = (mesh.vertices[v] - box.min()) / (2 * reach);
    const Cell cell{std::llround(at.x()), std::llround(at.y()), std::llround(at.z())};
    int same = -1;
    for (int n = 0; n < 27; ++n) {
      const auto found = cells.find({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1});
      if (found == cells.end()) continue;
      for (const int other : found->second)
        if ((kept[other] - mesh.vertices[v]).norm() <= reach && (same < 0 || other < same)) same = other;
    }
    if (same < 0) {
      same = static_cast<int>(kept.size());
      kept.push_back(mesh.vertices[v]);
      cells[cell].push_back(same);
    } else {
      ++done.welded_vertices;
    }
    now[v] = same;
  }
  mesh.vertices = std::move(kept);
  for (auto& triangle : mesh.triangles)
    for (int& corner : triangle) corner = now[corner];
}

void drop_useless(TriangleMesh& mesh, MeshRepair& done) {
  std::set<std::array<int, 3>> seen;
  std::vector<std::array<int, 3>> kept;
  for (const auto& triangle : mesh.triangles) {
    auto [a, b, c] = triangle;
    std::array<int, 3> corners = triangle;
    std::sort(corners.begin(), corners.end());
    // A triangle without area whose corners differ connects its neighbours, so it stays.
    if (a == b || b == c || c == a || !seen.insert(corners).second)
      ++done.dropped_triangles;
    else
      kept.push_back(triangle);
  }
  mesh.triangles = std::move(kept);
}

// Walks from triangle to triangle over the edges that two triangles share. Flips each triangle that runs
// along an edge in the same direction as its neighbour. The walk does not cross edges of three triangles or
// more. Returns the component of each triangle: the index of the component's first triangle. flipped: for
// each triangle, whether it was flipped.
std::vector<int> orient(TriangleMesh& mesh, std::vector<char>& flipped) {
  const std::vector<MeshEdge> edges = edges_by_vertices(mesh);
  struct Neighbour {
    int triangle;
    bool opposed;
  };
  std::vector<std::vector<Neighbour>> neighbours(mesh.triangles.size());
  for_each_edge(edges, [&](std::span<const MeshEdge> sides) {
    if (sides.size() != 2) return;
    const MeshEdge &a = sides[0], &b = sides[1];
    neighbours[a.triangle].push_back({b.triangle, a.forward == b.forward});
    neighbours[b.triangle].push_back({a.triangle, a.forward == b.forward});
  });
  std::vector<int> component(mesh.triangles.size(), -1);
  flipped.assign(mesh.triangles.size(), 0);
  for (std::size_t start = 0; start < component.size(); ++start) {
    if (component[start] >= 0) continue;
    component[start] = static_cast<int>(start);
    std::deque<int> open{static_cast<int>(start)};
    for (; !open.empty(); open.pop_front())
      for (const auto& [other, opposed] : neighbours[open.front()])
        if (component[other] < 0) {
          component[other] = static_cast<int>(start);
          flipped[other] = (flipped[open.front()] != 0) != opposed;
          open.push_back(other);
        }
  }
  for (std::size_t t = 0; t < flipped.size(); ++t)
    if (flipped[t]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  return component;
}

// Closes every loop of boundary edges: a loop of three edges by a triangle, a longer one by a fan around its
// middle.
void fill_holes(TriangleMesh& mesh, std::vector<int>& component, MeshRepair& done) {
  struct Way {
    int to, component;
  };
  std::multimap<int, Way> directions;  // edges along holes, opposite to the direction of their triangles
  const std::vector<MeshEdge> edges = edges_by_vertices(mesh);
  for_each_edge(edges, [&](std::span<const MeshEdge> sides) {
    if (sides.size() > 1) return;
    const auto [low, high, triangle, forward] = sides[0];
    directions.emplace(forward ? high : low, Way{forward ? low : high, component[triangle]});
  });
  while (!directions.empty()) {
    const int start = directions.begin()->first, part = directions.begin()->second.component;
    std::vector<int> loop;
    for (int at = start;;) {
      const auto next = directions.find(at);
      if (next == directions.end()) break;
      loop.push_back(at);
      at = next->second.to;
      directions.erase(next);
      if (at != start) continue;
      Vec3 middle = Vec3::Zero();
      for (const int v : loop) middle += mesh.vertices[v] / static_cast<double>(loop.size());
      const int centre = static_cast<int>(mesh.vertices.size());
      if (loop.size() > 3) mesh.vertices.push_back(middle);
      if (loop.size() == 3) mesh.triangles.push_back({loop[0], loop[1], loop[2]});
      for (std::size_t i = 0; loop.size() > 3 && i < loop.size(); ++i)
        mesh.triangles.push_back({loop[i], loop[(i + 1) % loop.size()], centre});
      component.resize(mesh.triangles.size(), part);
      ++done.filled_holes;
      break;
    }
  }
}

// Flips every part whose volume is negative. Changes `flipped` of its triangles as well; triangles that fill
// holes have no entry there.
void turn_outwards(TriangleMesh& mesh, const std::vector<int>& component, std::vector<char>& flipped) {
  std::map<int, std::vector<int>> parts;
  for (std::size_t t = 0; t < component.size(); ++t) parts[component[t]].push_back(static_cast<int>(t));
  for (const auto& [first, triangles] : parts) {
    // The volume is computed about a vertex of the part, so that it has the sign of most of the part even if
    // there are gaps.
    const Vec3 o = mesh.vertices[mesh.triangles[triangles.front()][0]];
    double volume = 0;
    for (const int t : triangles) {
      const auto [a, b, c] = mesh.triangles[t];
      volume += (mesh.vertices[a] - o).dot((mesh.vertices[b] - o).cross(mesh.vertices[c] - o));
    }
    if (volume >= 0) continue;
    for (const int t : triangles) {
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
      if (static_cast<std::size_t>(t) < flipped.size()) flipped[t] = flipped[t] == 0 ? 1 : 0;
    }
  }
}

}  // namespace

std::optional<std::vector<std::array<int, 3>>> polygon_triangles(const std::vector<Vec3>& corners) {
  if (is_line(corners)) return fan(corners.size());
  const Vec3 area = area_vector(corners);
  if (has_no_normal(corners, area)) return {};
  const std::vector<Vec2> at = seen_flat(corners, area);
  if (has_fan(at)) return fan(corners.size());
  if (!is_simple(at)) return {};
  std::optional<Triangles> triangles = ears(at);
  if (triangles && !have_area_of_polygon(*triangles, at)) return {};
  return triangles;
}

std::vector<MeshEdge> edges_by_vertices(const TriangleMesh& mesh) {
  std::vector<MeshEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int from = mesh.triangles[t][i], to = mesh.triangles[t][(i + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), static_cast<int>(t), from < to});
    }
  std::sort(edges.begin(), edges.end(), [](const MeshEdge& a, const MeshEdge& b) {
    return std::tie(a.low, a.high, a.triangle, a.forward) < std::tie(b.low, b.high, b.triangle, b.forward);
  });
  return edges;
}

std::vector<int> parts_of(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges, int& count) {
  std::vector<int> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t e = 1; e < edges.size(); ++e) {
    if (edges[e].low != edges[e - 1].low || edges[e].high != edges[e - 1].high) continue;
    const int a = root_of(parent, edges[e - 1].triangle), b = root_of(parent, edges[e].triangle);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<int> part(parent.size());
  count = 0;
  for (std::size_t t = 0; t < parent.size(); ++t) {  // a root is the first triangle of its part
    const int root = root_of(parent, static_cast<int>(t));
    part[t] = root == static_cast<int>(t) ? count++ : part[root];
  }
  return part;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Vec3 o = mesh.vertices.front();  // a point near the mesh reduces rounding errors
  double six_volumes = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    six_volumes += (mesh.vertices[a] - o).dot((mesh.vertices[b] - o).cross(mesh.vertices[c] - o));
  return six_volumes / 6;
}

bool is_degenerate(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const auto [a, b, c] = triangle;
  if (a == b || b == c || c == a) return true;
  const Vec3 ab = mesh.vertices[b] - mesh.vertices[a], ac = mesh.vertices[c] - mesh.vertices[a];
  const double max_length = std::max({ab.squaredNorm(), ac.squaredNorm(), (ab - ac).squaredNorm()});
  return ab.cross(ac).norm() <= 1e-10 * max_length;
}

MeshCheck check_mesh(const TriangleMesh& mesh) {
  MeshCheck check;
  check.vertices = static_cast<int>(mesh.vertices.size());
  check.triangles = static_cast<int>(mesh.triangles.size());
  for (const Vec3& v : mesh.vertices) check.bad_vertices += !v.allFinite();
  for (const auto& triangle : mesh.triangles)
    check.bad_indices += std::any_of(triangle.begin(), triangle.end(),
                                     [&](int corner) { return corner < 0 || corner >= check.vertices; });
  if (!check.readable()) return check;
  const std::vector<MeshEdge> edges = edges_by_vertices(mesh);
  parts_of(mesh, edges, check.parts);
  count_edges(edges, check);
  for (const auto& triangle : mesh.triangles) check.degenerate_triangles += is_degenerate(mesh, triangle);
  check.volume_m3 = signed_volume(mesh);
  return check;
}

std::string text(const MeshCheck& check) {
  std::string faults;
  const auto add = [&](int count, const std::string& one, const std::string& many) {
    if (count > 0)
      faults += (faults.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
  };
  if (check.triangles == 0) return "no triangles";
  add(check.bad_vertices, "vertex that is not finite", "vertices that are not finite");
  add(check.bad_indices, "triangle with a corner that is not a vertex",
      "triangles with a corner that is not a vertex");
  if (!faults.empty()) return faults;
  add(check.boundary_edges, "boundary edge", "boundary edges");
  add(check.non_manifold_edges, "non-manifold edge", "non-manifold edges");
  add(check.inconsistent_edges, "edge between faces of opposite orientation",
      "edges between faces of opposite orientation");
  std::string all = faults.empty() ? "closed" : "not closed: " + faults;
  faults.clear();
  add(check.parts, "part", "parts");
  add(check.triangles, "triangle", "triangles");
  add(check.degenerate_triangles, "of them degenerate", "of them degenerate");
  if (check.inverted()) faults += ", inside out";
  return all + " (" + faults + ")";
}

TriangleMesh repair_mesh(const TriangleMesh& mesh, MeshRepair& done) {
  done = {};
  TriangleMesh repaired = mesh;
  if (repaired.vertices.empty()) return repaired;
  weld(repaired, done);
  drop_useless(repaired, done);
  std::vector<char> flipped;  // not of bool, because the library checks no index of such a vector
  std::vector<int> component = orient(repaired, flipped);
  fill_holes(repaired, component, done);
  turn_outwards(repaired, component, flipped);
  done.flipped_triangles = static_cast<int>(std::count(flipped.begin(), flipped.end(), 1));
  return repaired;
}

std::string text(const MeshRepair& done) {
  std::string all;
  const auto add = [&](const char* verb, int count, const char* what) {
    if (count > 0)
      all += (all.empty() ? "" : ", ") + std::string(verb) + " " + std::to_string(count) + " " + what;
  };
  add("welded", done.welded_vertices, "vertices");
  add("dropped", done.dropped_triangles, "triangles");
  add("turned", done.flipped_triangles, "triangles");
  add("filled", done.filled_holes, "holes");
  return all.empty() ? "nothing" : all;
}

std::vector<Vec3> surface_points(const TriangleMesh& mesh, double spacing_m) {
  std::vector<Vec3> points = mesh.vertices;
  for (const auto& corners : mesh.triangles) {
    const Vec3 &a = mesh.vertices[static_cast<std::size_t>(corners[0])],
               &b = mesh.vertices[static_cast<std::size_t>(corners[1])],
               &c = mesh.vertices[static_cast<std::size_t>(corners[2])];
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    constexpr double kMostAlong = 100;
    const int n = static_cast<int>(std::min(std::ceil(longest / spacing_m), kMostAlong));
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j <= n; ++j)
        if (i + j > 0 && j < n)
          points.push_back(a + (static_cast<double>(i) / n) * (b - a) +
                           (static_cast<double>(j) / n) * (c - a));
  }
  return points;
}

}  // namespace remote_touch
