// Positions on the surface of a tool, in a few groups. Each group is small enough for one patch of a tracked
// sheet.
#pragma once

#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// The positions are in the tool frame. Nothing is allocated after construction.
class ToolPositions {
 public:
  struct Group {
    Vec3 middle_T = Vec3::Zero();
    double radius_m = 0;  // distance of its farthest position from the middle
    std::size_t first = 0, count = 0;
  };

  // Selects at most kMax positions on the surface of the mesh, spread evenly: each one is the farthest from
  // those before it. It stops when every sampled position of the surface is within group_radius_m / 8 of a
  // selected one. Then it divides them into the smallest number of groups with radii up to group_radius_m,
  // but at most max_groups groups. pre: the mesh has a vertex; group_radius_m and max_groups are positive.
  static constexpr std::size_t kMax = 256;
  ToolPositions(const TriangleMesh& mesh, double group_radius_m, std::size_t max_groups);

  std::span<const Vec3> all() const { return positions_T_; }
  std::span<const Group> groups() const { return groups_; }
  std::span<const Vec3> of(const Group& group) const { return all().subspan(group.first, group.count); }

 private:
  void divide(std::size_t groups);

  std::vector<Vec3> positions_T_;  // group by group
  std::vector<Group> groups_;
};

}  // namespace remote_touch
