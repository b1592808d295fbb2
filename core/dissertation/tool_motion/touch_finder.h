// Detects the points of the newest frame that are in the tool or near it: the collision list of 6.2.2.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/tiled_cloud.h"
#include "core/dissertation/tool_shape/distance_field.h"
#include "core/dissertation/tool_shape/voxel_tool.h"
#include "core/kernels/kernels.h"
#include "core/points/neighbour_search.h"

namespace remote_touch {

// Columns of doubles of one length, in one piece of memory.

// Columns begin at whole cache lines, each at a different offset in its page. Columns that are whole pages
// apart would share the same few lines of a cache, and evict each other if there are more of them than cache
// ways.
template <std::size_t kCount>
class ColumnBlock {
 public:
  // Makes room for `size` values in each column. The contents of the columns are lost if they grow.
  void grow(std::size_t size) {
    if (size <= size_) return;
    size_ = size;
    stride_ = (size + kPage - 1) / kPage * kPage + kShift;
    memory_.grow(kCount * stride_ + kLine);
  }
  double* operator[](std::size_t column) const {
    const auto at = reinterpret_cast<std::uintptr_t>(memory_.data()) / sizeof(double);
    return memory_.data() + (kLine - at % kLine) % kLine + column * stride_;
  }

 private:
  static constexpr std::size_t kLine = 64 / sizeof(double), kPage = 4096 / sizeof(double);
  static constexpr std::size_t kShift = 5 * kLine;  // 5 and the 64 lines of a page have no common factor

  Buffer<double> memory_;
  std::size_t size_ = 0, stride_ = 0;
};

// Lists of points are in the order of the cloud's tiles and stay valid until the next call.
class TouchFinder {
 public:
  TouchFinder(std::shared_ptr<const VoxelTool> tool, const Kernels& kernels);

  void on_frame(std::shared_ptr<const TiledCloud> cloud);  // allocates unless reserved
  void reserve(std::size_t padded_size);                   // reserves memory for clouds of this size
  const TiledCloud& cloud() const { return *cloud_; }
  const VoxelTool& tool() const { return *tool_; }
  // max_slope() is an upper bound of the length of the field's gradient where the field is below
  // kFieldMargin_m. grid_reach_m() is an upper bound of the distance of any position in the grid from the
  // tool's origin.
  double max_slope() const { return max_slope_; }
  double grid_reach_m() const { return grid_reach_m_; }
  // Upper bound of the field in shell and interior voxels. It can be above 0, because such a voxel can reach
  // about half a voxel out of the surface.
  double max_voxel_m() const { return max_voxel_m_; }

  // Returns the points in shell or interior voxels.
  std::span<const std::uint32_t> in_tool(const ToolPose& pose) const;
  // Returns all points whose field value is distance_m or less, and some that are a little farther away:
  // those in cells with a node below distance_m + 0.25 mm. pre: distance_m < kFieldMargin_m.
  std::span<const std::uint32_t> within(const ToolPose& pose, double distance_m) const {
    return within(*cloud_, pose, distance_m);
  }
  // Returns the same for another cloud, which has no more points than the finder's.
  std::span<const std::uint32_t> within(const TiledCloud& cloud, const ToolPose& pose,
                                        double distance_m) const;

  // Returns the groups of kLanes points that contain all points of a cloud whose field value is distance_m or
  // less, and some others. Valid until the next call, like the lists. pre: as above.
  std::span<const std::uint32_t> groups_within(const TiledCloud& cloud, const ToolPose& pose,
                                               double distance_m) const;

  // Returns the same groups of a cloud that has slabs, but fewer of the others. Writes a lower bound of the
  // field values of the points of each group into nearest_m, which has capacity for all groups.
  std::span<const std::uint32_t> slabs_within(const TiledCloud& cloud, const ToolPose& pose,
                                              double distance_m, double* nearest_m) const;

  Voxel voxel(const Vec3& p_T) const;
  // The voxels, for kernels.
  CellTable voxels() const { return table(voxels_); }
  // The slope of the field around every position of the grid, for kernels.
  SlopeTable slopes() const { return slopes_.table(); }

 private:
  CellTable table(const std::vector<std::int8_t>& values) const {
    const auto& n = tool_->grid.cells;
    return {values.data(), {n[0], n[1], n[2]}};
  }
  CellTransform to_cells(const ToolPose& pose) const;
  NearnessCode code_within(double distance_m) const;
  std::span<const std::uint32_t> tiles_within(const TiledCloud& cloud, const ToolPose& pose,
                                              double distance_m) const;
  std::span<const std::uint32_t> find(const TiledCloud& cloud, const ToolPose& pose, double distance_m,
                                      const std::vector<std::int8_t>& values, int min) const;

  std::shared_ptr<const VoxelTool> tool_;
  const Kernels& kernels_;
  const double max_slope_, grid_reach_m_, max_voxel_m_;
  const SlopeBlocks slopes_;
  std::vector<std::int8_t> voxels_, nearness_;  // value of every cell, and three more readable bytes
  std::shared_ptr<const TiledCloud> cloud_ = std::make_shared<TiledCloud>();
  mutable Buffer<std::uint32_t> rows_, tiles_, groups_, found_;
};

// The field of a tool at a pose, for kernels, and bounds of its change between poses.

inline constexpr double kMaxSearch_m = kFieldMargin_m - 1e-4;  // the search has no larger reach

// The tool has to outlive it.
PosedField posed_field(const VoxelTool& tool, const ToolPose& pose);

// Returns an upper bound of the change of the field, between two poses, at a point that is fixed in the world
// and in the grid: the slope of the field times the path of the point through the grid.
double max_change_m(const TouchFinder& finder, const ToolPose& from, const ToolPose& to);

// Returns the distance up to which points are searched: reach_m plus spare_m, but no more than kMaxSearch_m
// unless reach_m is.
inline double searched_m(double reach_m, double spare_m) {
  return std::max(reach_m, std::min(reach_m + spare_m, kMaxSearch_m));
}

// Returns the field value above which a point cannot have come within reach_m while the field changed by
// change_m. Returns infinity if the search did not reach so far.
inline double passed_m(double reach_m, double change_m) {
  const double passed = reach_m + change_m;
  return passed < kMaxSearch_m ? passed : std::numeric_limits<double>::infinity();
}

}  // namespace remote_touch
