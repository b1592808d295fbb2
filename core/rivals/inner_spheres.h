// Fills a tool with inner spheres: spheres inside its mesh that do not overlap. R. Weller and G. Zachmann,
// "Inner sphere trees for proximity and penetration queries", Robotics: Science and Systems 2009, describe
// them as a greedy packing on a discrete distance field. The same authors' "ProtoSphere: A GPU-assisted
// prototype guided sphere packing algorithm for arbitrary objects" (2010) moves the centre of each next
// sphere, the prototype, away from the nearest obstacle (the surface, or a sphere that was packed before),
// with steps that become shorter.
//
// Ours: the prototype starts at the node of the tool's grid around which the largest sphere fits, because
// the source's start in every cell of a grid needs a GPU. The radius is exact: the distance to the nearest
// triangle, or to the nearest earlier sphere.
//
// Beyond the source, a tool that equals its mirror image in a coordinate plane has a packing that does, too:
// a sphere is packed with its images, or lies on the plane if they would overlap. Only the last sphere may
// lack images. Without this rule a symmetric tool on a plane would feel a torque that comes from its packing
// only.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/dissertation/sphere_tree/sphere_tree.h"
#include "core/dissertation/tool_shape/voxel_tool.h"

namespace remote_touch {

// The spheres are in the tool frame, the largest ones first (nearly: a prototype can find more room than its
// node has). No two overlap, and none leaves the mesh, but for 1e-9 m of rounding.
struct InnerSpheres {
  std::vector<Sphere> spheres;
  double coverage = 0;  // volume of the spheres divided by that of the tool, 0 to 1
  // The neighbours of sphere i are neighbour[first_neighbour[i]] .. neighbour[first_neighbour[i + 1] - 1], in
  // rising order. Spheres are neighbours if the gap between them is a voxel or less. The gaps of the spanning
  // tree with the smallest sum of gaps are added, so that every sphere can be reached from every other one.
  std::vector<std::uint32_t> first_neighbour, neighbour;

  std::span<const std::uint32_t> neighbours(std::uint32_t i) const {
    return {neighbour.data() + first_neighbour[i], neighbour.data() + first_neighbour[i + 1]};
  }
};
std::string text(const InnerSpheres& made);

inline constexpr int kMaxInnerSpheres = 5000;

// Packs at most max_spheres spheres. It ends earlier if no node of the grid has room for a sphere of 0.9
// voxels; about half a million nodes are tried at most, in a larger tool only some of its nodes. The result
// is the same on every x86-64. pre: 1 <= max_spheres <= kMaxInnerSpheres, and the tool was made without
// outer_field. Throws InputError if there is no room for one sphere.
InnerSpheres make_inner_spheres(const VoxelTool& tool, int max_spheres);

// Finds the sphere that contains a position, among spheres that do not overlap.
class SphereLocator {
 public:
  // Sorts the spheres into the cells of a grid around them: 96 along its longest side. Keeps the spheres by
  // reference. pre: at least one sphere, all finite and with a radius above 0.
  explicit SphereLocator(std::span<const Sphere> spheres);

  // Returns the number of the sphere whose centre is nearer to p than its radius; the lowest number if
  // rounding makes two spheres overlap. p is in the frame of the spheres and may be NaN. Does not allocate.
  std::optional<std::uint32_t> at(const Vec3& p) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Vec3& p) const;
  std::size_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((k * cells_[1] + j) * cells_[0] + i);
  }
  template <class Act>
  void for_cells_of(const Sphere& sphere, const Act& act) const;

  std::span<const Sphere> spheres_;
  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();
  double cell_m_ = 1;
  Cell cells_{1, 1, 1};
  std::vector<std::uint32_t> first_;   // first entry of each cell in number_; one more at the end
  std::vector<std::uint32_t> number_;  // spheres that reach into each cell, in rising order
};

}  // namespace remote_touch
