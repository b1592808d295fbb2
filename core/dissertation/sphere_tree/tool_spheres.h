// A tool as a sphere tree, made from its mesh in advance, 7.4: the dissertation uses the Sphere Tree Toolkit
// [118] for this. Leaves are balls inscribed in the tool, all enlarged by the same inflation_m. It is about
// the smallest with which max_leaves of them cover the surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/dissertation/sphere_tree/sphere_tree.h"
#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"

namespace remote_touch {

// Sample positions on a mesh's surface.

// Returns positions on every triangle, its corners among them. They are no farther apart than spacing_m along
// its longest side and along the height above it.
std::vector<Vec3> surface_samples(const TriangleMesh& mesh, double spacing_m);

// Keeps the first of the positions in every cube of side spacing_m.
std::vector<Vec3> thinned(const std::vector<Vec3>& positions, double spacing_m);

double surface_area_m2(const TriangleMesh& mesh);

// Covers many points by few spheres with a greedy algorithm: each next sphere is the one that covers most of
// the remaining points.

class SphereCover {
 public:
  // points: to be covered; choice: spheres to choose from; cell_m: cell size of the grid that finds points,
  // about the size of a sphere.
  SphereCover(std::vector<Vec3> points, std::vector<Sphere> choice, double cell_m);

  // Selects spheres of the choice, grown by inflation_m. It ends when every point is covered that any of them
  // covers, or when more than max are selected. If two spheres cover equally many points, the one that comes
  // first is selected.
  struct Result {
    std::vector<Sphere> spheres;
    std::size_t uncovered_count = 0;  // points that are not covered
  };
  Result cover(double inflation_m, std::size_t max) const;

 private:
  // Calls act(point) for the points in the sphere.
  template <class Act>
  void within(const Sphere& sphere, const Act& act) const;
  std::int64_t cell_along(int axis, double x) const;

  std::vector<Sphere> choice_;
  double cell_m_;
  Vec3 low_;
  std::int64_t cells_[3];
  std::vector<Vec3> points_;           // sorted by cell
  std::vector<std::uint32_t> starts_;  // first point of each cell; one more at the end
};

struct ToolSpheres {
  SphereTree spheres;  // tree in the tool frame
  double inflation_m = 0;
  // Deviation of the union of the leaves from the mesh, measured on dense samples. outside_m: largest
  // distance between the mesh and a position of a leaf outside it, at most inflation_m. surface_outside_m:
  // largest distance between the leaves and a position of the surface outside them; 0 but for rounding,
  // because the leaves were enlarged until they contained these samples.
  double outside_m = 0, surface_outside_m = 0;
};
std::string text(const ToolSpheres& spheres);

inline constexpr int kMinLeaves = 1, kMaxLeaves = 10000;

// Makes at most max_leaves leaves, or fewer if these suffice. Throws InputError if no node of the tool's grid
// is inside the tool.
ToolSpheres make_tool_spheres(const VoxelTool& tool, int max_leaves);  // pre: kMinLeaves to kMaxLeaves

}  // namespace remote_touch
