// Volume, centre of mass and inertia of a solid of uniform density.
#pragma once

#include "core/dissertation/tool/shape/triangle_mesh.h"
#include "core/dissertation/tool/shape/voxel_tool.h"

namespace remote_touch {

struct MassProperties {
  double volume_m3 = 0;
  Vec3 centre = Vec3::Zero();
  Eigen::Matrix3d inertia_m2 = Eigen::Matrix3d::Zero();  // about the centre, divided by the mass
};

// Computes the exact values, as sums over the tetrahedra from one point to every triangle. pre: a closed
// mesh. Faces that point inwards give a negative volume, and the same centre and inertia.
MassProperties mass_properties(const TriangleMesh& mesh);

// Computes them from the nodes inside, each as a cube of one voxel: for a mesh with gaps, for which the sum
// above has no meaning.
MassProperties mass_properties(const VoxelGrid& grid, const std::vector<std::uint8_t>& inside_nodes);

}  // namespace remote_touch
