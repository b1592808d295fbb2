// A point of a cloud as the look-ahead rule treats it: a small disk in the plane of its normal, so that
// corners of the tool do not sink between the points of a surface. Not in the dissertation.
#pragma once

#include "core/kernels/disk_search.h"
#include "core/tool/dynamics/motion_program.h"
#include "core/tool/voxels/voxel_tool.h"

namespace remote_touch {

// In the tool frame. Without a normal (NaN) it is a point.
struct SurfaceDisk {
  Vec3 p_T, n_T;
  double radius_m;
  FieldSample at;       // the field at its centre
  double extent_m = 0;  // of the points that it stands for, merged_points.h; 0: of one point

  bool has_normal() const { return n_T.allFinite(); }
};

// Whether a field of this slope in the plane of a disk counts as flat: no place of the disk is searched then.
inline bool is_flat(double slope, double radius_m, double extent_m) {
  return slope < disk_search::kFlatSlope && (extent_m == 0 || slope * radius_m < disk_search::kFlatDepth_m);
}

// Lower bound of the distance from the disk to the tool, if the field is nowhere steeper than at the centre.
double lower_bound_m(const SurfaceDisk& disk);

struct DiskPlace {
  Vec3 p_T;
  FieldSample at;
  bool at_rim = false;
};

// The position on the disk that is nearest to the tool, or deepest in it.
DiskPlace nearest_place(const VoxelTool& tool, const SurfaceDisk& disk);

// The constraint of a disk at its nearest position, with the field there as distance. If that lies within the
// disk, n is the disk's normal, on the side given by the field; at its rim, or for a point, n comes from the
// tool's surface. Inside the tool known_side, +1 or -1 of the normal (0: not known), overrides the field: a
// frame can put points anywhere in the tool, and then the field does not show where they came from.
ToolContact near_contact(const VoxelTool& tool, const SurfaceDisk& disk, const DiskPlace& nearest,
                         double known_side);
// For a disk too far from the tool to be worth a search: at its centre, with its lower bound as distance.
// pre: the bound is above 0.
ToolContact far_contact(const SurfaceDisk& disk, double lower_bound_m);

}  // namespace remote_touch
