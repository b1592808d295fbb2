#include "core/dissertation/sphere_tree/tool_spheres.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/dissertation/sphere_tree/sphere_cover.h"
#include "core/dissertation/sphere_tree/surface_samples.h"
#include "core/geometry/bounding_box.h"
#include "core/mesh/triangle_tree.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

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
