// Places on the surface of a tool, in a few groups, each small enough for one patch of a tracked sheet.
#pragma once

#include <span>
#include <vector>

#include "core/dissertation/tool/shape/triangle_mesh.h"

namespace remote_touch {

// Places in the tool frame. Made once; nothing allocates afterwards.
class ToolPlaces {
 public:
  struct Group {
    Vec3 middle_T = Vec3::Zero();
    double radius_m = 0;  // distance of the farthest of its places from the middle
    std::size_t first = 0, count = 0;
  };

  // Selects places on the mesh's surface, spread evenly (each the farthest from those before it), at most
  // kMax, until all of the surface is within half of group_radius_m / 4 of one. Makes the smallest number of
  // groups that have that radius, but no more than max_groups. pre: the mesh has a vertex, group_radius_m and
  // max_groups are above 0.
  static constexpr std::size_t kMax = 256;
  ToolPlaces(const TriangleMesh& mesh, double group_radius_m, std::size_t max_groups);

  std::span<const Vec3> all() const { return places_T_; }
  std::span<const Group> groups() const { return groups_; }
  std::span<const Vec3> of(const Group& group) const { return all().subspan(group.first, group.count); }

 private:
  void divide(std::size_t groups);

  std::vector<Vec3> places_T_;  // group by group
  std::vector<Group> groups_;
};

}  // namespace remote_touch
