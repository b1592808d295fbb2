// Volume, centre of mass and inertia of a solid of uniform density.
#pragma once

#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

struct MassProperties {
  double volume_m3 = 0;
  Vec3 centre = Vec3::Zero();
  Eigen::Matrix3d inertia_m2 = Eigen::Matrix3d::Zero();  // about the centre, divided by the mass
};

// Computes the exact values, as sums over the tetrahedra between one point and every triangle. pre: a closed
// mesh. If the faces point inwards, the volume is negative; the centre and the inertia are the same.
MassProperties mass_properties(const TriangleMesh& mesh);

// Computes the values from the nodes inside, each as a cube of one voxel. This is for a mesh with gaps, for
// which the sum above has no meaning.
MassProperties mass_properties(const VoxelGrid& grid, const std::vector<std::uint8_t>& inside_nodes);

}  // namespace remote_touch
