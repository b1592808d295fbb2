// The look-ahead rule treats a point of a cloud as a small disk in the plane of its normal, so that corners
// of the tool do not sink between the points of a surface. Not in the dissertation.
#pragma once

#include "core/dissertation/tool/dynamics/motion_program.h"
#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/kernels/disk_search.h"

namespace remote_touch {

// The disk of a point in the tool frame. A point without a normal (NaN) has no disk and is used as a point.
struct SurfaceDisk {
  Vec3 p_T, n_T;
  double radius_m;
  FieldSample at;       // the field at its centre
  double extent_m = 0;  // extent of the points that it represents, merged_points.h; 0: one point

  bool has_normal() const { return n_T.allFinite(); }
};

// True if a field of this slope in the plane of a disk counts as flat. No position on the disk is searched
// then.
inline bool is_flat(double slope, double radius_m, double extent_m) {
  return slope < disk_search::kFlatSlope && (extent_m == 0 || slope * radius_m < disk_search::kFlatDepth_m);
}

// Returns a lower bound of the distance from the disk to the tool, if the field is nowhere steeper than at
// the centre.
double lower_bound_m(const SurfaceDisk& disk);

struct DiskPosition {
  Vec3 p_T;
  FieldSample at;
  bool at_rim = false;
};

// Returns the position on the disk that is nearest to the tool, or deepest in it.
DiskPosition nearest_position(const VoxelTool& tool, const SurfaceDisk& disk);

// Returns the constraint of a disk at its nearest position; its distance is the field there. If that position
// lies within the disk, n is the disk's normal, on the side that the field gives. n comes from the tool's
// surface if the position is at the rim, if the disk meets the tool edge-on, or for a point; but if the tool
// is flush with the disk, n is the disk's normal again. known_side is +1 or -1 of the normal; 0: not known.
// If the position is inside the tool, known_side overrides the field and the rim, because a frame can put
// points anywhere in the tool, and the field does not show from which side they came.
ToolContact near_contact(const VoxelTool& tool, const SurfaceDisk& disk, const DiskPosition& nearest,
                         double known_side);
// Returns the constraint of a disk that is too far from the tool to be worth a search: at its centre, with
// its lower bound as distance. pre: the bound is above 0.
ToolContact far_contact(const SurfaceDisk& disk, double lower_bound_m);

}  // namespace remote_touch
