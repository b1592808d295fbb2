// The points near a tool: as disks in the tool's field, as single points, and how many of them it touches.
//
// A search also finds points that lie a little beyond the reach. All of them are kept, and are only measured
// again, as long as the tool has moved so little that no other point can have come within reach. A kept group
// of points is skipped if it was so far away at the search that none of its points can have come within
// reach.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/dissertation/tool_motion/motion_program.h"
#include "core/dissertation/tool_motion/touch_finder.h"
#include "core/kernels/tool_kernels.h"
#include "core/mesh/voxel_tool.h"
#include "core/points/neighbour_search.h"
#include "core/rendering/frames_and_outputs.h"

namespace remote_touch {

// The look-ahead rule treats a point of a cloud as a small disk in the plane of its normal, so that corners
// of the tool do not sink between the points of a surface. Not in the dissertation.

// The disk of a point in the tool frame. A point without a normal (NaN) has no disk and is used as a point.
struct SurfaceDisk {
  Vec3 p_T, n_T;
  double radius_m;
  FieldSample at;       // the field at its centre
  double extent_m = 0;  // extent of the points that it represents, contact_thinning.h; 0: one point

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
// its lower bound as distance.
ToolContact far_contact(const SurfaceDisk& disk, double lower_bound_m);

// Computes the disks near a tool. The result is kept: another query for the same pose costs nothing.
class NearDisks {
 public:
  // Distance beyond the reach that is searched too.
  static constexpr double kSpare_m = 4e-4;
  static constexpr double kSearch_m = 3e-4;  // a search for the nearest position is made on closer disks only

  NearDisks(double disk_radius_ratio, double cell_m)
      : disk_radius_ratio_(disk_radius_ratio), cells_per_m_(1 / cell_m) {}

  // Sets the cloud: the finder's cloud, or fewer points that represent it. It has to outlive the queries.
  // Allocates unless reserve() was called for its size.
  void on_frame(const TiledCloud& cloud);
  void reserve(std::size_t padded_size);  // reserves memory for clouds of this size
  // Finds the disks whose centres are within reach_m and whose lower bounds are max_lower_m or less, in the
  // order of the cloud's tiles; no disks if there is no cloud. pre: reach_m <= kFieldMargin_m - 2e-4.
  void query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m,
             double max_lower_m = std::numeric_limits<double>::infinity());

  std::size_t size() const { return count_; }
  double lower_m(std::size_t i) const { return disks_[kLower][i]; }  // lower_bound_m()
  // Returns a lower bound of the distance from the disk to a convex tool. It is distance_m() if no search is
  // needed: lower_m() is kSearch_m or less, and the disk is flat in the field. Otherwise it is lower_m().
  double bound_m(std::size_t i) const { return disks_[kBound][i]; }
  double distance_m(std::size_t i) const { return disks_[kDistance][i]; }
  Vec3 p_T(std::size_t i) const { return three(kPlace, i); }
  // Returns cell_and_octant() of the disk's centre and of the direction against the gradient, in which a
  // contact there would push.
  std::uint64_t cell(std::size_t i) const { return std::bit_cast<std::uint64_t>(disks_[kCell][i]); }
  // Appends the contacts of the disks with these numbers: far_contact() if the lower bound is more than
  // kSearch_m, else near_contact() at the nearest position.
  void append_contacts(std::span<const std::uint32_t> numbers, const TouchFinder& finder,
                       const Kernels& kernels, double side, std::vector<ToolContact>& contacts);
  SurfaceDisk disk(std::size_t i) const {
    return {p_T(i),
            three(kNormal, i),
            disks_[kRadius][i],
            {distance_m(i), three(kGradient, i)},
            disks_[kExtent][i]};
  }
  // Returns the number of points that the last search found; not all of them become disks.
  std::size_t kept_points() const { return point_count_; }

 private:
  enum PointColumn { kX, kY, kZ, kNx, kNy, kNz, kSpacing, kPointExtent, kPointColumns };
  enum DiskColumn {
    kPlace = 0,
    kNormal = 3,
    kGradient = 6,
    kRadius = 9,
    kExtent,
    kDistance,
    kSlope,
    kLower,
    kBound,
    kCell,
    kDiskColumns
  };
  Vec3 three(std::size_t first, std::size_t i) const {
    return {disks_[first][i], disks_[first + 1][i], disks_[first + 2][i]};
  }
  void search(const TouchFinder& finder, const ToolPose& pose, double reach_m);
  DiskColumns columns() const;
  void finish_outside(const VoxelTool& tool, const DiskLimits& limits);
  void copy(std::size_t from, std::size_t to);

  const double disk_radius_ratio_, cells_per_m_;
  const TiledCloud* cloud_ = nullptr;
  // The kept points, and the pose and the reach of their search.
  ColumnBlock<kPointColumns> points_;
  Buffer<double> nearest_;  // least field value of each group of kLanes points at searched_at_
  std::size_t point_count_ = 0;
  ToolPose searched_at_;
  double searched_m_ = -1;
  bool is_new_ = false;  // the points were not measured since the search

  PosedField field_{};
  ColumnBlock<kDiskColumns> disks_;
  std::size_t count_ = 0;
  Buffer<ContactNumbers> contacts_;
  bool is_known_ = false;  // the columns are valid for the pose and limits below
  ToolPose pose_;
  double reach_m_ = 0, max_lower_m_ = 0;
};

// The groups that a kernel has to measure. A group whose nearest_m is above passed_m has no point within
// reach. If is_new is true, the kernel writes the nearest_m of all others.
struct GroupsInReach {
  const std::uint32_t* group;
  std::size_t count;
  double* nearest_m;  // least field value of the points of each group, or a lower bound of it
  bool is_new;
  double passed_m;
};

// Keeps the groups of points that are near a tool, so that not every pose needs a new search. If the cloud
// has a packed() one, the groups are those of that one.
class KeptGroups {
 public:
  static constexpr double kSpare_m = 4e-4;  // distance beyond the reach that is searched too

  void on_frame() { searched_m_ = -1; }   // call it for each new cloud of the finder
  void reserve(std::size_t padded_size);  // reserves memory for clouds of this size
  // Returns groups that contain all points whose field value is reach_m or less, in order. Valid until the
  // next call. pre: reach_m <= kFieldMargin_m - 2e-4, and reserve() was called for the finder's cloud.
  GroupsInReach within(const TouchFinder& finder, const ToolPose& pose, double reach_m);
  void on_measured();  // call it after the kernel, if it measured all groups

 private:
  void search(const TouchFinder& finder, const ToolPose& pose, double reach_m);
  void drop_far_groups();

  Buffer<std::uint32_t> groups_;
  Buffer<double> nearest_m_;  // least field value of each group at searched_at_, or a lower bound
  std::size_t count_ = 0;
  ToolPose searched_at_;
  double searched_m_ = -1;
  bool is_new_ = false;  // not all groups were measured since the search
};

// Finds the points near a tool as single points: none is merged, and none is a disk.
class NearPoints {
 public:
  void on_frame() { groups_.on_frame(), count_ = 0; }  // call it for each new cloud
  void reserve(std::size_t padded_size);               // reserves memory for clouds of this size
  // Finds the points of the finder's cloud whose field value is reach_m or less, in the order of the packed()
  // cloud's tiles. pre: reach_m <= kFieldMargin_m - 2e-4, and reserve() was called for the finder's cloud.
  void query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m);
  // Does the same, but leaves out some of the points that are certain to keep way.touch during the motion,
  // and some of those with a normal away from way.ahead_W. pre: way.far is reach_m.
  void query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, const SlabWay& way);

  // Returns true if the field value of a point is below value_m. The search covers points up to search_m, so
  // that the next query does not need one. The points of the last query are lost. pre: value_m <= search_m,
  // and as above.
  bool has_below(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double value_m,
                 double search_m);

  std::size_t size() const { return count_; }
  Vec3 p_T(std::size_t i) const { return {points_[kX][i], points_[kY][i], points_[kZ][i]}; }
  double distance_m(std::size_t i) const { return points_[kDistance][i]; }  // the field there
  // Index of the point in the packed() cloud of the finder's.
  std::uint32_t number(std::size_t i) const { return static_cast<std::uint32_t>(points_[kNumber][i]); }

 private:
  enum Column { kX, kY, kZ, kDistance, kNumber, kColumns };
  void measure(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m,
               const GroupsInReach& groups);
  void finish_outside(const VoxelTool& tool, double reach_m);

  KeptGroups groups_;
  struct OnWay {
    Buffer<std::uint32_t> index, group;
    Buffer<double> nearest_m;
  };
  OnWay on_way_;
  ColumnBlock<kColumns> points_;
  std::size_t count_ = 0;
};

struct Touched {
  ContactState state = ContactState::free;  // entrenched: some points are in interior voxels
  int points = 0;
  int clusters = 0;               // number of 10 mm cells of the tool frame with touched points
  double nearest_distance_m = 0;  // smallest field value of a point; infinite beyond the reach
};

// Counts the points of a cloud that the tool touches at a pose. Every point is counted by itself. The voxel
// in which a point lies, or its distance, classifies most points. Only for the others, the nearest position
// on the disk is searched.
class TouchedPoints {
 public:
  static constexpr double kTouch_m = 1e-4;  // a disk closer to the tool than this is touched

  // Counts points in voxels. If with_disks is true, points whose disk touches the tool count too.
  TouchedPoints(double disk_radius_ratio, bool with_disks)
      : disk_radius_ratio_(disk_radius_ratio), touch_m_(with_disks ? kTouch_m : kNever_m) {
    points_.grow(kPortion), disks_.grow(kPortion + kLanes), contacts_.grow(kPortion);
  }

  void on_frame() { groups_.on_frame(); }  // call it for each new cloud of the finder
  void reserve(std::size_t padded_size);   // reserves memory for clouds of this size
  // Counts the touched points among those whose field value is reach_m or less. A point is touched if it lies
  // in a shell or interior voxel and its field value is voxels_m or less, or if its disk touches the tool.
  // pre: reach_m <= kFieldMargin_m - 2e-4, and reserve() was called for the finder's cloud.
  Touched query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m,
                double voxels_m);

 private:
  static constexpr double kNever_m = -std::numeric_limits<double>::infinity();

  void add_unclear(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                   const TouchLimits& limits, Touched& all);
  void search_disks(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                    std::span<const std::uint32_t> numbers);
  void add_single(std::uint32_t number, const TouchFinder& finder, const ToolPose& pose,
                  const TouchLimits& limits, Touched& all);
  void add_touched(const Vec3& p_T, ContactState state, Touched& all);

  const double disk_radius_ratio_, touch_m_;
  KeptGroups groups_;
  Buffer<std::uint32_t> unclear_;
  // The disks of some unclear points, and the distances of their nearest positions; NaN: not known.
  static constexpr std::size_t kPortion = 256;
  ColumnBlock<8> points_;
  ColumnBlock<16> disks_;
  Buffer<ContactNumbers> contacts_;
  Vec3 disk_p_T(std::size_t i) const { return {disks_[0][i], disks_[1][i], disks_[2][i]}; }
  Buffer<std::uint64_t> clusters_;
  std::size_t cluster_count_ = 0, unclear_count_ = 0;
};

}  // namespace remote_touch
