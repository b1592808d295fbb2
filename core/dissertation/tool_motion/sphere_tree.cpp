#include "core/dissertation/tool_motion/sphere_tree.h"

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
#include "core/points/neighbour_search.h"
#include "core/points/number_columns.h"
#include "core/points/vector.h"

namespace remote_touch {
namespace {

constexpr double kSphereRounding = 1 + 1e-12;  // factor on distances: a bounding sphere is never too small

// Returns the bounding sphere (7.3) of count items; item(i) returns a const Sphere&.
template <class Item>
Sphere around(std::size_t count, const Item& item) {
  Sphere all;
  for (std::size_t i = 0; i < count; ++i) all.centre += item(i).centre;
  all.centre /= static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i)
    all.radius_m = std::max(all.radius_m, (item(i).centre - all.centre).norm() + item(i).radius_m);
  all.radius_m *= kSphereRounding;
  return all;
}

std::size_t in_whole_groups(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

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

constexpr double kMaxCellsOfBox = 1e7;  // a slim body along the diagonal of its box would need far more

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

Sphere bounding_sphere(std::span<const Sphere> spheres) {
  assert(!spheres.empty());
  return around(spheres.size(), [&](std::size_t i) -> const Sphere& { return spheres[i]; });
}

void SphereTree::clear() {
  leaves_.clear();
  level_count_ = 0;
  for (std::vector<double>* column : {&x_, &y_, &z_, &radius_, &max_radius_}) column->clear();
  for (std::size_t axis = 0; axis < 3; ++axis) low_[axis].clear(), high_[axis].clear();
  run_starts_.clear();
}

std::vector<SphereNode>& SphereTree::new_level() {
  if (levels_.size() == level_count_) levels_.emplace_back();
  std::vector<SphereNode>& level = levels_[level_count_++];
  level.clear();
  return level;
}

void SphereTree::append_run(std::span<const Sphere> leaves) {
  run_starts_.push_back({x_.size(), max_radius_.size()});
  for (std::size_t first = 0; first < leaves.size(); first += kLanes)
    append_group(leaves.subspan(first, std::min(kLanes, leaves.size() - first)));
  const std::size_t padded = in_whole_groups(x_.size());
  for (std::vector<double>* column : {&x_, &y_, &z_}) column->resize(padded, kFarAway);
  radius_.resize(padded, 0);
  const std::size_t groups = max_radius_.size() - run_starts_.back().group;
  pad_groups(in_whole_groups(groups) - groups);
}

void SphereTree::append_group(std::span<const Sphere> leaves) {
  SphereBox box = SphereBox::around(leaves.front());
  for (const Sphere& leaf : leaves) {
    x_.push_back(leaf.centre.x()), y_.push_back(leaf.centre.y()), z_.push_back(leaf.centre.z());
    radius_.push_back(leaf.radius_m);
    box.add(SphereBox::around(leaf));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    low_[axis].push_back(box.low[i]), high_[axis].push_back(box.high[i]);
  }
  max_radius_.push_back(box.max_radius_m);
}

void SphereTree::pad_groups(std::size_t padding) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::vector<double>* column : {&low_[axis], &high_[axis]})
      column->insert(column->end(), padding, kFarAway);
  max_radius_.insert(max_radius_.end(), padding, 0);
}

void SphereTree::add(std::span<const Sphere> leaves) {
  if (leaves.empty()) return;
  if (level_count_ == 0) new_level();
  SphereBox box = SphereBox::around(leaves.front());
  for (const Sphere& leaf : leaves) box.add(SphereBox::around(leaf));
  levels_.front().push_back({bounding_sphere(leaves), box, static_cast<std::uint32_t>(leaves_.size()),
                             static_cast<std::uint32_t>(leaves.size())});
  leaves_.insert(leaves_.end(), leaves.begin(), leaves.end());
  append_run(leaves);
}

SphereRun SphereTree::run(std::size_t node) const {
  const auto [leaf, group] = run_starts_[node];
  const std::size_t end = node + 1 < run_starts_.size() ? run_starts_[node + 1].group : max_radius_.size();
  const auto from = [](const std::vector<double>& column, std::size_t start) {
    return column.data() + start;
  };
  return {from(x_, leaf),
          from(y_, leaf),
          from(z_, leaf),
          from(radius_, leaf),
          {from(low_[0], group), from(low_[1], group), from(low_[2], group)},
          {from(high_[0], group), from(high_[1], group), from(high_[2], group)},
          from(max_radius_, group),
          end - group,
          levels_.front()[node].first};
}

void SphereTree::finish() {
  while (level_count_ > 0 && top().size() > kBranching) {
    std::vector<SphereNode>& level = new_level();  // this may move the other levels
    const std::vector<SphereNode>& below = levels_[level_count_ - 2];
    for (std::size_t first = 0; first < below.size(); first += kBranching) {
      const std::size_t count = std::min(kBranching, below.size() - first);
      const Sphere sphere =
          around(count, [&](std::size_t i) -> const Sphere& { return below[first + i].sphere; });
      SphereBox box = below[first].box;
      for (std::size_t i = 1; i < count; ++i) box.add(below[first + i].box);
      level.push_back({sphere, box, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
    }
  }
}

// Adds the regions of points first .. first + count - 1 to the present patch. The radius is tested first,
// because most points of most frames have no region.
void RegionTree::gather(const PointCloud& cloud, std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t point = first; point < first + count; ++point) {
    const double radius_m = cloud.fixture_radius_m[point];
    if (!(radius_m > 0)) continue;
    if (!std::isfinite(radius_m) || !cloud.is_measured(point)) continue;
    patch_.push_back({cloud.point(point), radius_m});
    points_.push_back(point);
    stiffness_N_per_m_.push_back(cloud.stiffness_N_per_m.empty() ? std::numeric_limits<double>::quiet_NaN()
                                                                 : cloud.stiffness_N_per_m[point]);
  }
}

void RegionTree::close_patch() {
  spheres_.add(patch_);
  patch_.clear();
}

void RegionTree::add_patches_of_image(const PointCloud& cloud) {
  constexpr std::uint32_t kPatch = kPatchSide_px, kBlock = 4 * kPatch;
  const auto width = static_cast<std::uint32_t>(cloud.image->camera.width),
             height = static_cast<std::uint32_t>(cloud.image->camera.height);
  for (std::uint32_t v0 = 0; v0 < height; v0 += kBlock)
    for (std::uint32_t u0 = 0; u0 < width; u0 += kBlock)
      for (std::uint32_t v = v0; v < std::min(v0 + kBlock, height); v += kPatch)
        for (std::uint32_t u = u0; u < std::min(u0 + kBlock, width); u += kPatch) {
          for (std::uint32_t row = v; row < std::min(v + kPatch, height); ++row)
            gather(cloud, row * width + u, std::min(kPatch, width - u));
          close_patch();
        }
}

void RegionTree::add_patches_along_curve(const PointCloud& cloud) {
  for (const std::uint32_t point : morton_order(cloud)) {
    gather(cloud, point, 1);
    if (patch_.size() == kPatchPoints) close_patch();
  }
  close_patch();
}

void RegionTree::assign(const PointCloud& cloud) {
  spheres_.clear();
  points_.clear();
  stiffness_N_per_m_.clear();
  if (cloud.fixture_radius_m.empty()) return;
  if (cloud.image)
    add_patches_of_image(cloud);
  else
    add_patches_along_curve(cloud);
  spheres_.finish();
}

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
