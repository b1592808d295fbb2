#include "core/mesh/mesh_repair.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <set>

#include "core/geometry/vector.h"
#include "core/mesh/mesh_check.h"

namespace remote_touch {

namespace {

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
  for (std::size_t first = 0, last; first < edges.size(); first = last) {
    for (last = first + 1;
         last < edges.size() && edges[last].low == edges[first].low && edges[last].high == edges[first].high;)
      ++last;
    if (last - first != 2) continue;
    const MeshEdge &a = edges[first], &b = edges[first + 1];
    neighbours[a.triangle].push_back({b.triangle, a.forward == b.forward});
    neighbours[b.triangle].push_back({a.triangle, a.forward == b.forward});
  }
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
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto same = [&](std::size_t other) {
      return other < edges.size() && edges[other].low == edges[e].low && edges[other].high == edges[e].high;
    };
    if (same(e - 1) || same(e + 1)) continue;  // e - 1 of 0 is no edge
    const int from = edges[e].forward ? edges[e].high : edges[e].low;
    const int to = edges[e].forward ? edges[e].low : edges[e].high;
    directions.emplace(from, Way{to, component[edges[e].triangle]});
  }
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

}  // namespace remote_touch
