// A point of a cloud in the look-ahead rule: a small disk in the plane of its normal, so that corners of the
// tool do not sink between the points of a surface. Not in the dissertation.
#pragma once

#include "core/tool/dynamics/motion_program.h"
#include "core/tool/voxels/voxel_tool.h"

namespace remote_touch {

// In the tool frame. Without a normal (NaN) it is a point.
struct SurfaceDisk {
  Vec3 p_T, n_T;
  double radius_m;
  FieldSample at;  // the field in its middle

  bool has_normal() const { return n_T.allFinite(); }
};

// No place of the disk is nearer to the tool, if the field falls no steeper than it does in the middle.
double lower_bound_m(const SurfaceDisk& disk);

// A slope of the field up to which a disk lies flat in it.
inline constexpr double kFlatSlope = 0.05;

struct DiskPlace {
  Vec3 p_T;
  FieldSample at;
  bool at_rim = false;
};

// The place of the disk that is nearest to the tool, or deepest in it.
DiskPlace nearest_place(const VoxelTool& tool, const SurfaceDisk& disk);

// The constraint of a disk at its nearest place, with the field there as distance. A disk that is met inside
// is a plane, on the side that the field tells; its rim, or a point, is met by the surface of the tool.
// Inside the tool known_side, +1 or -1 of the normal, counts where it is given (0: none): a frame can put
// points anywhere in the tool, and then the field does not tell where they came from.
ToolContact near_contact(const VoxelTool& tool, const SurfaceDisk& disk, const DiskPlace& nearest,
                         double known_side);
// Of a disk too far from the tool to be worth a search: in its middle, with its lower bound as distance.
// pre: the bound is above 0.
ToolContact far_contact(const SurfaceDisk& disk, double lower_bound_m);

}  // namespace remote_touch
