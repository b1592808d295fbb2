#include "core/mesh/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "core/mesh/triangle_mesh.h"
#include "core/mesh/triangle_tree.h"
#include "core/points/vector.h"

namespace remote_touch {
namespace {

// A mean of unit vectors that is shorter than this value is rounding.
constexpr double kVanishes = 1e-12;

struct NormalSum {
  Vec3 sum = Vec3::Zero(), first = Vec3::Zero();
  double weights = 0;

  void add(double weight, const Vec3& normal) {
    if (weights == 0) first = normal;
    sum += weight * normal;
    weights += weight;
  }
  Vec3 mean() const { return sum.norm() > kVanishes * weights ? Vec3(sum.normalized()) : first; }
};

void add_faces(const TriangleMesh& mesh, Pseudonormals& normals) {
  normals.of_face.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 ab = mesh.vertices[b] - mesh.vertices[a], ac = mesh.vertices[c] - mesh.vertices[a];
    normals.of_face.push_back(ab.cross(ac).normalized());
  }
}

// The sides of a face follow its corners, so the side with these ends is unique.
int side_between(const std::array<int, 3>& triangle, int v, int w) {
  for (int side = 0; side < 2; ++side) {
    const int from = triangle[side], to = triangle[side + 1];
    if ((from == v && to == w) || (from == w && to == v)) return side;
  }
  return 2;
}

int forward_minus_back(std::span<const MeshEdge> sides) {
  int difference = 0;
  for (const MeshEdge& side : sides) difference += side.forward ? 1 : -1;
  return difference;
}

void add_edges(const TriangleMesh& mesh, Pseudonormals& normals) {
  normals.edges_of_face.resize(mesh.triangles.size());
  normals.vertex_on_border.assign(mesh.vertices.size(), 0);
  const std::vector<MeshEdge> edges = edges_by_vertices(mesh);
  for_each_edge(edges, [&](std::span<const MeshEdge> sides) {
    const int low = sides[0].low, high = sides[0].high;
    NormalSum sum;
    for (const MeshEdge& side : sides) {
      sum.add(1, normals.of_face[side.triangle]);
      normals.edges_of_face[side.triangle][side_between(mesh.triangles[side.triangle], low, high)] =
          static_cast<int>(normals.of_edge.size());
    }
    normals.of_edge.push_back(sum.mean());
    const bool on_border = forward_minus_back(sides) != 0;
    normals.edge_on_border.push_back(on_border);
    if (on_border) normals.vertex_on_border[low] = normals.vertex_on_border[high] = 1;
  });
}

void add_vertices(const TriangleMesh& mesh, Pseudonormals& normals) {
  std::vector<NormalSum> sums(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto& corners = mesh.triangles[t];
      const Vec3& v = mesh.vertices[corners[i]];
      const Vec3 next = mesh.vertices[corners[(i + 1) % 3]] - v,
                 last = mesh.vertices[corners[(i + 2) % 3]] - v;
      sums[corners[i]].add(angle_between(next, last), normals.of_face[t]);
    }
  normals.of_vertex.reserve(sums.size());
  for (const NormalSum& sum : sums) normals.of_vertex.push_back(sum.mean());
}

using Corners = std::array<Vec3, 3>;

// Finds the pairs of faces that cross, some of them several times. Compares the faces whose boxes overlap. A
// set of faces is divided at a plane, and the faces on the plane belong to both halves.
class CrossingSearch {
 public:
  using Use = std::function<void(int, int)>;  // takes two faces that cross

  CrossingSearch(const TriangleMesh& mesh, Use use) : mesh_(mesh), use_(std::move(use)) {
    BoundingBox all;
    for (const auto& triangle : mesh.triangles) {
      BoundingBox box;
      for (const int corner : triangle) box.extend(mesh.vertices[corner]);
      boxes_.push_back(box), all.extend(box);
    }
    if (!boxes_.empty()) rounding_m_ = 1e-12 * (all.diagonal().norm() + all.center().norm());
  }

  void search() const {
    std::vector<int> faces(mesh_.triangles.size());
    std::iota(faces.begin(), faces.end(), 0);
    search(std::move(faces));
  }

 private:
  static constexpr std::size_t kFew = 16;
  static constexpr double kDivides = 1.3;  // a useful plane leaves both halves together this many faces

  void search(std::vector<int> faces) const {
    for (int axis = 0; faces.size() > kFew && axis < 3; ++axis) {
      std::vector<int> below, above;
      divide(faces, axis, below, above);
      if (static_cast<double>(below.size() + above.size()) > kDivides * static_cast<double>(faces.size()))
        continue;
      faces = {};  // frees the memory before the next level takes some
      search(std::move(below)), search(std::move(above));
      return;
    }
    for (std::size_t i = 0; i < faces.size(); ++i)
      for (std::size_t j = i + 1; j < faces.size(); ++j)
        if (boxes_[faces[i]].intersects(boxes_[faces[j]]) && cross(faces[i], faces[j]))
          use_(faces[i], faces[j]);
  }

  void divide(const std::vector<int>& faces, int axis, std::vector<int>& below,
              std::vector<int>& above) const {
    std::vector<double> middles;
    for (const int f : faces) middles.push_back(boxes_[f].center()[axis]);
    const auto middle = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
    std::nth_element(middles.begin(), middle, middles.end());
    for (const int f : faces) {
      if (boxes_[f].min()[axis] <= *middle) below.push_back(f);
      if (boxes_[f].max()[axis] >= *middle) above.push_back(f);
    }
  }

  // Two faces cross if no plane has one of them on one side and the other one on the other. If there is such
  // a plane, its normal is that of a face, or normal to a side of each face, or, if both faces are in one
  // plane, in that plane and normal to a side.
  bool cross(int f, int g) const {
    const Corners a = corners(f), b = corners(g);
    const Vec3 n = normal(a);
    const Interval b_along_n = along(n, b, a[0]);
    const bool is_in_plane = b_along_n.low > -rounding_m_ && b_along_n.high < rounding_m_;
    if (!is_in_plane && (are_apart(n, a, b) || are_apart(normal(b), a, b))) return false;
    for (int i = 0; i < 3; ++i) {
      const Vec3 side_a = a[(i + 1) % 3] - a[i], side_b = b[(i + 1) % 3] - b[i];
      if (are_apart(side_a.cross(n), a, b) || are_apart(side_b.cross(n), a, b)) return false;
      for (int j = 0; !is_in_plane && j < 3; ++j)
        if (are_apart(side_a.cross(b[(j + 1) % 3] - b[j]), a, b)) return false;
    }
    return true;
  }

  struct Interval {
    double low = std::numeric_limits<double>::infinity(), high = -low;
  };
  static Interval along(const Vec3& direction, const Corners& corners, const Vec3& origin) {
    Interval interval;
    for (const Vec3& corner : corners) {
      const double place = direction.dot(corner - origin);
      interval.low = std::min(interval.low, place), interval.high = std::max(interval.high, place);
    }
    return interval;
  }
  bool are_apart(const Vec3& direction, const Corners& a, const Corners& b) const {
    const double length = direction.norm();
    if (!(length > 0)) return false;
    const Interval of_a = along(direction, a, a[0]), of_b = along(direction, b, a[0]);
    return std::min(of_a.high - of_b.low, of_b.high - of_a.low) <= rounding_m_ * length;
  }

  Corners corners(int face) const {
    const auto& [a, b, c] = mesh_.triangles[face];
    return {mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
  }
  static Vec3 normal(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).normalized(); }

  const TriangleMesh& mesh_;
  Use use_;
  std::vector<BoundingBox> boxes_;
  double rounding_m_ = 0;
};

// Returns the number of the part of each face. A part is connected by edges of two faces, neither of which is
// crossed. So the side is the same on the whole part.
std::vector<int> uncrossed_parts(const TriangleMesh& mesh, const std::vector<char>& is_crossed, int& count) {
  const std::vector<MeshEdge> edges = edges_by_vertices(mesh);
  std::vector<MeshEdge> joining;
  for_each_edge(edges, [&](std::span<const MeshEdge> sides) {
    if (sides.size() != 2 || is_crossed[sides[0].triangle] || is_crossed[sides[1].triangle]) return;
    joining.insert(joining.end(), sides.begin(), sides.end());
  });
  return parts_of(mesh, joining, count);
}

// Returns the number of the closed part of each face. sheet_of: the sheet of each face; a sheet is connected
// by edges of two faces. A sheet is a part if it is closed by itself; else all sheets that end at an edge
// belong together.
std::vector<int> closed_parts(const TriangleMesh& mesh, const std::vector<int>& sheet_of, int& count) {
  const std::vector<MeshEdge> edges = edges_by_vertices(mesh);
  std::vector<MeshEdge> joining;
  for_each_edge(edges, [&](std::span<const MeshEdge> sides) {
    const auto ends_here = [&](int sheet) {
      int difference = 0;
      for (const MeshEdge& side : sides)
        if (sheet_of[side.triangle] == sheet) difference += side.forward ? 1 : -1;
      return difference != 0;
    };
    for (const MeshEdge& side : sides)
      if (sides.size() == 2 || ends_here(sheet_of[side.triangle])) joining.push_back(side);
  });
  return parts_of(mesh, joining, count);
}

bool are_all_inverted_in_one(const std::vector<int>& part_of, int count, const std::vector<FaceSide>& sides) {
  std::vector<char> is_inverted(static_cast<std::size_t>(count), 1);
  for (std::size_t f = 0; f < sides.size(); ++f)
    if (sides[f] != FaceSide::inverted) is_inverted[part_of[f]] = 0;
  return std::find(is_inverted.begin(), is_inverted.end(), 1) != is_inverted.end();
}

using Triangles = std::vector<std::array<int, 3>>;

// Returns the sign of the volume of a closed part; 0 if rounding hides it, as of a sheet with two sides.
int volume_sign(const std::vector<Vec3>& vertices, const Triangles& part) {
  const Vec3& o = vertices[part.front()[0]];
  double volume = 0, rounding = 0;
  for (const auto& [i, j, k] : part) {
    const Vec3 a = vertices[i] - o, b = vertices[j] - o, c = vertices[k] - o;
    volume += a.dot(b.cross(c));
    rounding += 1e-14 * a.norm() * b.norm() * c.norm();
  }
  return (volume > rounding) - (volume < -rounding);
}

// True if a part of negative volume is no hollow: no part of positive volume has it wholly inside.
// is_crossed: false if no face is crossed.
bool has_negative_part_outside(const TriangleMesh& mesh, const std::vector<int>& part_of, int count,
                               bool is_crossed) {
  std::vector<Triangles> parts(static_cast<std::size_t>(count));
  for (std::size_t f = 0; f < part_of.size(); ++f) parts[part_of[f]].push_back(mesh.triangles[f]);
  std::vector<int> outer, negative;
  for (int part = 0; part < count; ++part)
    if (const int sign = volume_sign(mesh.vertices, parts[part]))
      (sign > 0 ? outer : negative).push_back(part);
  if (negative.empty()) return false;
  std::set<std::pair<int, int>> crossing;
  const auto cross = [&](int f, int g) { crossing.emplace(std::minmax(part_of[f], part_of[g])); };
  if (is_crossed) CrossingSearch(mesh, cross).search();
  TriangleMesh alone{mesh.vertices, {}};
  for (const int part : outer) {
    alone.triangles = parts[part];
    const TriangleTree tree(alone);
    std::erase_if(negative, [&](int other) {
      const auto& [a, b, c] = parts[other].front();
      const Vec3 middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
      return !crossing.contains(std::minmax(part, other)) && tree.winding_number(middle) > 0.5;
    });
  }
  return !negative.empty();
}

// Returns the side of one face by the winding numbers on both sides of its middle.
FaceSide side_of(const TriangleMesh& mesh, const TriangleTree& tree, int face) {
  const auto& [a, b, c] = mesh.triangles[face];
  const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
  const Vec3 normal = (q - p).cross(r - p);
  const Vec3 away = 1e-6 * std::sqrt(normal.norm()) * normal.normalized(), middle = (p + q + r) / 3;
  const double in_front = tree.winding_number(middle + away), behind = tree.winding_number(middle - away);
  if (in_front > 0.5 && behind > 0.5) return FaceSide::inner;
  return in_front < -0.5 && behind < 0.5 ? FaceSide::inverted : FaceSide::boundary;
}

}  // namespace

Pseudonormals pseudonormals(const TriangleMesh& mesh) {
  Pseudonormals normals;
  add_faces(mesh, normals);
  add_edges(mesh, normals);
  add_vertices(mesh, normals);
  return normals;
}

bool is_closed_surface(const TriangleMesh& mesh) {
  const std::vector<MeshEdge> edges = edges_by_vertices(mesh);
  bool is_closed = true;
  for_each_edge(edges, [&](std::span<const MeshEdge> sides) {
    is_closed = is_closed && forward_minus_back(sides) == 0;
  });
  return is_closed;
}

std::vector<char> crossed_faces(const TriangleMesh& mesh) {
  std::vector<char> is_crossed(mesh.triangles.size(), 0);
  CrossingSearch(mesh, [&](int f, int g) { is_crossed[f] = is_crossed[g] = 1; }).search();
  return is_crossed;
}

std::vector<FaceSide> face_sides(const TriangleMesh& mesh) {
  const std::vector<char> is_crossed = crossed_faces(mesh);
  int count = 0;
  const std::vector<int> part_of = uncrossed_parts(mesh, is_crossed, count);
  if (count == 1)
    return std::vector(mesh.triangles.size(),
                       signed_volume(mesh) < 0 ? FaceSide::inverted : FaceSide::boundary);
  // The largest face of each part tells its side, because its middle is clear of its neighbours.
  const auto area = [&](int face) {
    const auto& [a, b, c] = mesh.triangles[face];
    return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).squaredNorm();
  };
  std::vector<int> largest(static_cast<std::size_t>(count), -1);
  for (std::size_t f = 0; f < part_of.size(); ++f) {
    int& face = largest[part_of[f]];
    if (face < 0 || area(static_cast<int>(f)) > area(face)) face = static_cast<int>(f);
  }
  const TriangleTree tree(mesh);
  std::vector<FaceSide> of_part;
  for (const int face : largest)
    of_part.push_back(is_crossed[face] ? FaceSide::crossed : side_of(mesh, tree, face));
  std::vector<FaceSide> sides;
  for (const int part : part_of) sides.push_back(of_part[part]);
  return sides;
}

bool has_inverted_part_in(const TriangleMesh& mesh, const std::vector<FaceSide>& sides) {
  int sheets = 0, parts = 0;
  const std::vector<int> sheet_of = uncrossed_parts(mesh, std::vector<char>(sides.size(), 0), sheets);
  if (are_all_inverted_in_one(sheet_of, sheets, sides)) return true;
  const std::vector<int> part_of = closed_parts(mesh, sheet_of, parts);
  const bool is_crossed = std::find(sides.begin(), sides.end(), FaceSide::crossed) != sides.end();
  return has_negative_part_outside(mesh, part_of, parts, is_crossed);
}

}  // namespace remote_touch
