#include "core/dissertation/sphere_tree/tool_spheres.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <unordered_set>
#include <utility>

#include "core/dissertation/tool_motion/contact_thinning.h"
#include "core/mesh/triangle_tree.h"
#include "core/parameters/parameter.h"
#include "core/points/order_statistic.h"
#include "core/points/vector.h"

namespace remote_touch {
namespace {

Vec3 corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t i) {
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][i])];
}

// Adds samples in rows that are parallel to the longest side, from a to a + base, up to the corner a + up. A
// mesh of small triangles has many more samples than one for every square of side spacing_m.
void add_rows(const Vec3& a, const Vec3& base, const Vec3& up, double spacing_m, std::vector<Vec3>& samples) {
  const double length = base.norm(), height = length > 0 ? base.cross(up).norm() / length : 0;
  const int columns = std::max(1, static_cast<int>(std::ceil(length / spacing_m))),
            rows = std::max(1, static_cast<int>(std::ceil(height / spacing_m)));
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double above = double(j) / rows, along = double(i) / columns;
      samples.push_back(a + above * up + (1 - above) * along * base);
    }
}

}  // namespace

std::vector<Vec3> surface_samples(const TriangleMesh& mesh, double spacing_m) {
  std::vector<Vec3> samples;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto side = [&](std::size_t i) { return Vec3(corner(mesh, t, (i + 1) % 3) - corner(mesh, t, i)); };
    std::size_t first = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (side(i).norm() > side(first).norm()) first = i;
    const Vec3 a = corner(mesh, t, first);
    add_rows(a, side(first), corner(mesh, t, (first + 2) % 3) - a, spacing_m, samples);
  }
  return samples;
}

std::vector<Vec3> thinned(const std::vector<Vec3>& positions, double spacing_m) {
  std::unordered_set<std::uint64_t> seen;
  std::vector<Vec3> kept;
  for (const Vec3& position : positions)
    if (seen.insert(cell_number(position, 1 / spacing_m)).second) kept.push_back(position);
  return kept;
}

double surface_area_m2(const TriangleMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = corner(mesh, t, 0);
    area += 0.5 * (corner(mesh, t, 1) - a).cross(corner(mesh, t, 2) - a).norm();
  }
  return area;
}

namespace {

constexpr double kMaxCellsOfBox = 1e7;  // a slim body along the diagonal of its box would need far more

}  // namespace

SphereCover::SphereCover(std::vector<Vec3> points, std::vector<Sphere> choice, double cell_m)
    : choice_(std::move(choice)), cell_m_(cell_m) {
  const BoundingBox box = points.empty() ? BoundingBox(Vec3(Vec3::Zero())) : bounding_box(points);
  low_ = box.min();
  const Vec3& high = box.max();
  while (((high - low_) / cell_m_ + Vec3::Ones()).prod() > kMaxCellsOfBox) cell_m_ *= 2;
  for (int axis = 0; axis < 3; ++axis)
    cells_[axis] = static_cast<std::int64_t>((high[axis] - low_[axis]) / cell_m_) + 1;
  const auto cell_of = [&](const Vec3& p) {
    return static_cast<std::size_t>((cell_along(2, p.z()) * cells_[1] + cell_along(1, p.y())) * cells_[0] +
                                    cell_along(0, p.x()));
  };
  starts_.resize(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1);
  points_.resize(points.size());
  std::vector<std::uint32_t> next(starts_.size());
  sort_by_cell(
      points.size(), starts_, next, [&](std::size_t i) { return cell_of(points[i]); },
      [&](std::size_t i, std::uint32_t to) { points_[to] = points[i]; });
}

// Returns the cell along an axis that contains x, or the nearest cell if x is outside the grid.
std::int64_t SphereCover::cell_along(int axis, double x) const {
  const double cell = std::clamp((x - low_[axis]) / cell_m_, 0.0, static_cast<double>(cells_[axis] - 1));
  return static_cast<std::int64_t>(cell);
}

template <class Act>
void SphereCover::within(const Sphere& sphere, const Act& act) const {
  std::int64_t first[3], last[3];
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = cell_along(axis, sphere.centre[axis] - sphere.radius_m);
    last[axis] = cell_along(axis, sphere.centre[axis] + sphere.radius_m);
  }
  const double squared = sphere.radius_m * sphere.radius_m;
  for (std::int64_t k = first[2]; k <= last[2]; ++k)
    for (std::int64_t j = first[1]; j <= last[1]; ++j) {
      // The cells of a row follow each other, and so do their points.
      const auto row = static_cast<std::size_t>((k * cells_[1] + j) * cells_[0]);
      const std::uint32_t begin = starts_[row + static_cast<std::size_t>(first[0])],
                          end = starts_[row + static_cast<std::size_t>(last[0]) + 1];
      for (std::uint32_t i = begin; i < end; ++i)
        if ((points_[i] - sphere.centre).squaredNorm() <= squared) act(i);
    }
}

// A sphere never covers more points than before, so a count from an earlier round is an upper bound. Only the
// sphere on top of the heap has to be counted again.
SphereCover::Result SphereCover::cover(double inflation_m, std::size_t max) const {
  struct Entry {
    std::uint32_t count, sphere;
    bool operator<(const Entry& other) const {
      return count != other.count ? count < other.count : sphere > other.sphere;
    }
  };
  std::vector<std::uint8_t> covered(points_.size(), 0);
  const auto grown = [&](std::uint32_t i) {
    return Sphere{choice_[i].centre, choice_[i].radius_m + inflation_m};
  };
  const auto count_of = [&](std::uint32_t i) {
    std::uint32_t count = 0;
    within(grown(i), [&](std::uint32_t point) { count += covered[point] ? 0 : 1; });
    return count;
  };
  std::vector<Entry> entries(choice_.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (std::size_t i = 0; i < choice_.size(); ++i)
    entries[i] = {count_of(static_cast<std::uint32_t>(i)), static_cast<std::uint32_t>(i)};
  std::priority_queue<Entry> heap({}, std::move(entries));
  Result result;
  result.uncovered_count = points_.size();
  while (!heap.empty() && result.uncovered_count > 0 && result.spheres.size() <= max) {
    Entry best = heap.top();
    heap.pop();
    const std::uint32_t now = count_of(best.sphere);
    if (now == 0) continue;
    if (now < best.count && !heap.empty() && Entry{now, best.sphere} < heap.top()) {
      best.count = now;
      heap.push(best);
      continue;
    }
    within(grown(best.sphere), [&](std::uint32_t point) { covered[point] = 1; });
    result.spheres.push_back(grown(best.sphere));
    result.uncovered_count -= now;
  }
  return result;
}

namespace {

// Approximate number of surface positions to be covered: kSamples plus kSamplesOfLeaf for every leaf.
constexpr double kSamples = 60000, kSamplesOfLeaf = 100;
constexpr double kDenser = 0.4;      // relative spacing of the positions at which the result is measured
constexpr double kDominated = 0.85;  // see inscribed_balls()
constexpr int kBisections = 12;      // steps of the search for the growth
constexpr int kPlacesOfLeaf = 200;   // positions on a leaf at which its distance from the mesh is measured
constexpr std::size_t kLeavesOfNode = 8;

// Returns large balls inscribed in the tool: those around the nodes of the field that are near its medial
// axis. Every other node has a neighbour whose distance to the surface is larger by nearly the distance
// between the two nodes, so the neighbour's ball nearly contains this one.
std::vector<Sphere> inscribed_balls(const VoxelTool& tool, const TriangleTree& triangles) {
  const VoxelGrid& grid = tool.grid;
  const int n[3] = {grid.cells[0] + 1, grid.cells[1] + 1, grid.cells[2] + 1};
  const auto at = [&](int i, int j, int k) {
    return static_cast<double>(
        tool.distance_m[(static_cast<std::size_t>(k) * n[1] + static_cast<std::size_t>(j)) * n[0] +
                        static_cast<std::size_t>(i)]);
  };
  std::vector<Sphere> balls;
  for (int k = 1; k + 1 < n[2]; ++k)
    for (int j = 1; j + 1 < n[1]; ++j)
      for (int i = 1; i + 1 < n[0]; ++i) {
        const double here = -at(i, j, k);
        if (!(here > 0)) continue;
        double steepest = 0;
        for (int dk = -1; dk <= 1; ++dk)
          for (int dj = -1; dj <= 1; ++dj)
            for (int di = -1; di <= 1; ++di) {
              if (di == 0 && dj == 0 && dk == 0) continue;
              const double path_length = grid.size_m * std::sqrt(di * di + dj * dj + dk * dk);
              steepest = std::max(steepest, (-at(i + di, j + dj, k + dk) - here) / path_length);
            }
        if (steepest < kDominated) balls.push_back({grid.origin_T + grid.size_m * Vec3(i, j, k), here});
      }
      // Deep inside, the field can be too large by a voxel.
#pragma omp parallel for schedule(dynamic, 64)
  for (std::size_t i = 0; i < balls.size(); ++i)
    balls[i].radius_m = std::sqrt(triangles.nearest(balls[i].centre, 0).squared_m2);
  return balls;
}

// Finds the smallest growth with which max_leaves balls cover the surface, by bisection between zero and the
// size of the tool.
SphereCover::Result tightest(const SphereCover& cover, const VoxelTool& tool, std::size_t max_leaves,
                             double& inflation_m) {
  double low = 0, high = 2 * tool.reach_m;
  SphereCover::Result best = cover.cover(high, max_leaves);
  for (int i = 0; i < kBisections; ++i) {
    // Most of the range is far too much: the first steps divide by ten.
    const double middle = low == 0 ? 0.1 * high : 0.5 * (low + high);
    SphereCover::Result result = cover.cover(middle, max_leaves);
    if (result.uncovered_count == 0 && result.spheres.size() <= max_leaves)
      best = std::move(result), high = middle;
    else
      low = middle;
  }
  inflation_m = high;
  return best;
}

// Sorts leaves so that those near each other follow each other: it halves the list along the longest side of
// the box of the centres, and then halves each half.
void sort_by_place(std::span<Sphere> leaves) {
  if (leaves.size() <= 2) return;
  BoundingBox box;
  for (const Sphere& leaf : leaves) box.extend(leaf.centre);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  std::stable_sort(leaves.begin(), leaves.end(),
                   [axis](const Sphere& a, const Sphere& b) { return a.centre[axis] < b.centre[axis]; });
  // The first half has whole nodes only.
  const std::size_t nodes = (leaves.size() + kLeavesOfNode - 1) / kLeavesOfNode;
  const std::size_t half = leaves.size() > kLeavesOfNode ? (nodes / 2) * kLeavesOfNode : leaves.size() / 2;
  sort_by_place(leaves.first(half)), sort_by_place(leaves.subspan(half));
}

SphereTree tree_of(std::vector<Sphere> leaves) {
  sort_by_place(leaves);
  SphereTree tree;
  const std::span<const Sphere> all = leaves;
  for (std::size_t first = 0; first < all.size(); first += kLeavesOfNode)
    tree.add(all.subspan(first, std::min(kLeavesOfNode, all.size() - first)));
  tree.finish();
  return tree;
}

// Returns the largest distance between the leaves and a sample outside all of them; 0 if no sample is
// outside.
double max_surface_outside_m(std::span<const Vec3> samples, std::span<const Sphere> leaves) {
  double max_distance = 0;
#pragma omp parallel for reduction(max : max_distance)
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double min = std::numeric_limits<double>::infinity();
    for (const Sphere& leaf : leaves) min = std::min(min, (samples[i] - leaf.centre).norm() - leaf.radius_m);
    max_distance = std::max(max_distance, min);
  }
  return max_distance;
}

// Returns the largest distance from the mesh of those positions on leaves that lie outside it. The positions
// are spread evenly over each leaf. Returns 0 if none lies outside.
double max_outside_m(const VoxelTool& tool, const TriangleTree& triangles, std::span<const Sphere> leaves) {
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  double max_distance = 0;
#pragma omp parallel for schedule(dynamic) reduction(max : max_distance)
  for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
    int face = 0;
    for (int i = 0; i < kPlacesOfLeaf; ++i) {
      const double z = 1 - (2 * i + 1.0) / kPlacesOfLeaf, around = std::sqrt(1 - z * z);
      const Vec3 direction(around * std::cos(turn * i), around * std::sin(turn * i), z);
      const Vec3 place = leaves[leaf].centre + leaves[leaf].radius_m * direction;
      if (sample_field(tool, place).distance_m <= 0) continue;
      const TriangleTree::Nearest nearest = triangles.nearest(place, face);
      face = nearest.face;
      max_distance = std::max(max_distance, std::sqrt(nearest.squared_m2));
    }
  }
  return max_distance;
}

}  // namespace

ToolSpheres make_tool_spheres(const VoxelTool& tool, int max_leaves) {
  const TriangleTree triangles(tool.mesh);
  std::vector<Sphere> balls = inscribed_balls(tool, triangles);
  if (balls.empty())
    throw InputError("tool", "no point of its grid is inside: expected a smaller renderer.tool_voxel_m");
  const double spacing_m =
      std::sqrt(2 * surface_area_m2(tool.mesh) / (kSamples + kSamplesOfLeaf * max_leaves));
  const SphereCover cover(thinned(surface_samples(tool.mesh, spacing_m), spacing_m), std::move(balls),
                          2 * spacing_m);
  ToolSpheres made;
  std::vector<Sphere> leaves =
      tightest(cover, tool, static_cast<std::size_t>(max_leaves), made.inflation_m).spheres;
  // Some of the surface between the covered positions is still outside the leaves.
  const double finer_m = kDenser * spacing_m;
  const std::vector<Vec3> dense = thinned(surface_samples(tool.mesh, finer_m), 0.5 * finer_m);
  const double remaining_m = std::max(0.0, max_surface_outside_m(dense, leaves));
  for (Sphere& leaf : leaves) leaf.radius_m += remaining_m;
  made.inflation_m += remaining_m;
  made.surface_outside_m = std::max(0.0, max_surface_outside_m(dense, leaves));
  made.outside_m = max_outside_m(tool, triangles, leaves);
  made.spheres = tree_of(std::move(leaves));
  return made;
}

std::string text(const ToolSpheres& made) {
  const auto mm = [](double metres) {
    const auto hundredths = static_cast<long>(std::ceil(1e5 * metres));  // never less than the true value
    const std::string part = std::to_string(100 + hundredths % 100);
    return std::to_string(hundredths / 100) + "." + part.substr(1);
  };
  return std::to_string(made.spheres.leaves().size()) + " spheres, at most " + mm(made.outside_m) +
         " mm outside the mesh; its surface is at most " + mm(made.surface_outside_m) + " mm outside them";
}

}  // namespace remote_touch
