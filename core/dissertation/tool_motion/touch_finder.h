// The points of a frame in the form that detection with a tool reads, and the detection of those that are in
// the tool or near it: the collision list of 6.2.2.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/dissertation/tool_motion/contact_thinning.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/kernels/kernels.h"
#include "core/kernels/tool_kernels.h"
#include "core/mesh/distance_field.h"
#include "core/mesh/voxel_tool.h"
#include "core/points/neighbour_search.h"
#include "core/points/number_columns.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

// The slab of a group of points: a flat disk that contains all of them. It is much thinner than a sphere
// around points of a surface, so that a tool can rest close to it without being near its points. Not in the
// dissertation.

// Every point is within radius_m of the centre, and within half_m of the plane through the centre with the
// normal n_W. n_W is zero, and half_m too, if the points lie on a line; the slab is then a ball.
struct GroupSlab {
  Vec3 centre_W, n_W;
  double radius_m, half_m;
};

// pre: there is a point, and all are finite.
GroupSlab group_slab(std::span<const Vec3> points);

// Every finite normal differs from the middle by no more than the deviation. Both are zero if there is none.
struct NormalCone {
  Vec3 middle_W;
  double deviation;
};
NormalCone normal_cone(std::span<const Vec3> normals_W);

// Eight points form a group, eight groups a tile, eight tiles a row, and eight rows a block. Part number i of
// each kind consists of parts 8 i .. 8 i + 7 of the kind below.
inline constexpr std::uint32_t kTilePoints = kLanes * kLanes, kBlockTiles = kLanes * kLanes;

struct BoundingSphere {
  Vec3 centre_W;
  double radius_m;
};

// Points first .. first + padded_count - 1, padded with far-away points to kTilePoints.
struct Tile {
  BoundingSphere sphere;
  std::uint32_t first, padded_count;
};

// Tiles first .. first + count - 1.
struct TileBlock {
  BoundingSphere sphere;
  std::uint32_t first, count;
};

// A change of single points, for a TiledCloud that is a changed copy of another one.
class PointChange {
 public:
  struct Point {
    Vec3 p_W, n_W;  // NaN: no normal
    double spacing_m;
  };
  virtual ~PointChange() = default;
  // Returns true if it can change or remove points in this sphere.
  virtual bool concerns(const BoundingSphere& sphere) const = 0;
  // Changes a point. Returns false if the point is to be left out.
  virtual bool apply(Point& point) const = 0;
};

// The points of a frame in the form that detection with a tool reads. Neighbouring points form tiles with
// bounding spheres, and tiles form blocks with bounding spheres, so that one test skips everything that is
// far from the tool.
class TiledCloud {
 public:
  // Assigns the points of a cloud. A tile of an organised cloud is 8 x 8 pixels; a tile of any other cloud is
  // up to 64 points along a space-filling curve. Points that are not finite are left out. If merged_cube_m is
  // above 0, a merged() cloud is made if it saves enough points, and a packed() one. Allocates.
  void assign(const PointCloud& cloud, double merged_cube_m = 0);
  // Assigns those tiles of another cloud that reach into a ball, in the same order and with their points
  // changed. Allocates, unless reserve() was called for at least as many points. If the cloud is an image,
  // that is the number of its pixels with both sides rounded up to 8.
  void assign(const TiledCloud& all, const BoundingSphere& ball, const PointChange& change);
  void reserve(std::size_t points);

  std::span<const TileBlock> blocks() const { return blocks_; }
  std::span<const Tile> tiles(const TileBlock& block) const {
    return {tiles_.data() + block.first, block.count};
  }
  const double* x() const { return x_.data(); }
  const double* y() const { return y_.data(); }
  const double* z() const { return z_.data(); }
  std::size_t padded_size() const { return x_.size(); }  // padding included
  PointColumns columns() const {
    return {x_.data(),  y_.data(),  z_.data(),         nx_.data(),
            ny_.data(), nz_.data(), spacing_m_.data(), extent_m_.data()};
  }
  // Bounding spheres of every tile, padded to whole rows, and of every group. A sphere without points is a
  // far-away one.
  SphereColumns tile_spheres() const { return tile_spheres_.columns(); }
  SphereColumns group_spheres() const { return group_spheres_.columns(); }
  // Slabs of every group. pre: has_slabs().
  SlabColumns slabs() const {
    const auto& s = slabs_;
    return {group_spheres(), s[0].data(), s[1].data(),
            s[2].data(),     s[3].data(), {s[4].data(), s[5].data(), s[6].data()},
            s[7].data()};
  }
  bool has_slabs() const { return !slabs_[0].empty(); }

  Vec3 point(std::uint32_t i) const { return {x_[i], y_[i], z_[i]}; }
  Vec3 normal(std::uint32_t i) const { return {nx_[i], ny_[i], nz_[i]}; }  // NaN: none
  // Returns the distance from a point to its neighbours. If there is an image, it is the size of a pixel at
  // the point's depth, up to three times larger if the surface is slanted to the ray or the point has no
  // normal. If there is no image, it is the median distance of the tile's points to their nearest neighbours,
  // at most twice the median over all tiles.
  double spacing_m(std::uint32_t i) const { return spacing_m_[i]; }
  double max_spacing_m() const { return max_spacing_m_; }
  // Returns the largest extent of a point: 0, or in a merged() cloud the largest distance of a represented
  // point from the middle of its disk.
  double max_extent_m() const { return max_extent_m_; }
  // Returns the cloud of fewer points that represent all, merged_points(); null if there is none.
  const TiledCloud* merged() const { return merged_.get(); }
  // Returns a cloud of the same points in an order in which groups are smaller, with slabs, if the points are
  // dense and assign() was asked to merge; else this cloud. number() is the index in this cloud of point i of
  // that one.
  const TiledCloud& packed() const { return packed_ ? *packed_ : *this; }
  std::uint32_t number(std::uint32_t i) const { return number_.empty() ? i : number_[i]; }
  int count_without_normal() const { return without_normal_; }

 private:
  void add_tile(const PointCloud& cloud, std::span<const std::uint32_t> points);
  void add_point(const PointCloud& cloud, std::uint32_t i);
  void add_point(const PointChange::Point& point);
  void finish_tile(std::uint32_t first);
  void copy_tile(const TiledCloud& all, const Tile& tile);
  void change_tile(const TiledCloud& all, const Tile& tile, const PointChange& change);
  void clear();
  void gather_groups(std::uint32_t first);
  void finish();
  void gather_tile_spheres();
  void gather_blocks();
  void measure_spacing(const PointCloud& cloud);
  bool is_dense() const;
  void merge(double cube_m);
  void pack();
  void assign_packed(const TiledCloud& all, std::span<const std::uint32_t> points);
  void gather_slabs();
  void assign_merged(std::span<const PointOrDisk> points);

  std::vector<TileBlock> blocks_;
  std::vector<Tile> tiles_;
  LineVector<double> x_, y_, z_, nx_, ny_, nz_;
  LineVector<double> spacing_m_, extent_m_;
  struct Spheres {
    LineVector<double> x, y, z, radius_m;

    void clear() { x.clear(), y.clear(), z.clear(), radius_m.clear(); }
    void add(const BoundingSphere& sphere);
    SphereColumns columns() const { return {x.data(), y.data(), z.data(), radius_m.data()}; }
  };
  Spheres tile_spheres_, group_spheres_;
  double max_spacing_m_ = 0, max_extent_m_ = 0;
  std::unique_ptr<TiledCloud> merged_, packed_;
  std::vector<std::uint32_t> number_;
  std::array<LineVector<double>, 8> slabs_;  // normal, half thickness, facing, deviation
  int without_normal_ = 0;
};

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
