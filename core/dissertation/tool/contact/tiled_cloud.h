// The points of a frame as the tool's collision detection reads them: in tiles of neighbours with bounding
// spheres, and blocks of tiles with theirs, so that whatever is far from the tool is skipped with one test.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/dissertation/tool/contact/merged_points.h"
#include "core/geometry/point_cloud.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch {

// Eight points are a group, eight groups a tile, eight tiles a row, eight rows a block: the parts of number i
// have the numbers 8 i .. 8 i + 7.
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

// A change of the points of a cloud, for a cloud that is shown differently.
class PointChange {
 public:
  struct Point {
    Vec3 p_W, n_W;  // NaN: no normal
    double spacing_m;
  };
  virtual ~PointChange() = default;
  // True if it can change points in this sphere.
  virtual bool concerns(const BoundingSphere& sphere) const = 0;
  // Changes a point. Returns false if the point is not shown.
  virtual bool show(Point& point) const = 0;
};

class TiledCloud {
 public:
  // Assigns the points of a cloud. The tiles of an organised cloud are 8 x 8 pixels, those of others up to 64
  // points along a space-filling curve. Points that are not finite are left out. merged_cube_m: if above 0, a
  // merged() cloud is made where that is worth it. Allocates.
  void assign(const PointCloud& cloud, double merged_cube_m = 0);
  // Assigns the tiles of another cloud that reach into a ball, with their points changed, in the same order.
  // Allocates unless reserve() was called for as many points, or for the pixels of an image, sides rounded up
  // to 8.
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
  // Bounding spheres of every tile, padded to whole rows, and of every group; a far-away one if it has no
  // point.
  SphereColumns tile_spheres() const { return tile_spheres_.columns(); }
  SphereColumns group_spheres() const { return group_spheres_.columns(); }

  Vec3 point(std::uint32_t i) const { return {x_[i], y_[i], z_[i]}; }
  Vec3 normal(std::uint32_t i) const { return {nx_[i], ny_[i], nz_[i]}; }  // NaN: none
  // Returns the distance to the points around it. With an image: the size of a pixel at the point's depth, up
  // to three times larger if the surface is seen at a slant. Otherwise: the median distance of the tile's
  // points to their nearest neighbours, at most twice the median over all tiles.
  double spacing_m(std::uint32_t i) const { return spacing_m_[i]; }
  double max_spacing_m() const { return max_spacing_m_; }
  // Returns the largest extent of a point: 0, or in a merged() cloud the largest distance of a represented
  // point from the middle of its disk.
  double max_extent_m() const { return max_extent_m_; }
  // Returns the cloud of fewer points that represent all, merged_points(); null if there is none.
  const TiledCloud* merged() const { return merged_.get(); }
  int without_normal() const { return without_normal_; }

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
  void merge(double cube_m);
  void assign_merged(std::span<const MergedPoint> points);

  std::vector<TileBlock> blocks_;
  std::vector<Tile> tiles_;
  std::vector<double> x_, y_, z_, nx_, ny_, nz_;
  std::vector<double> spacing_m_, extent_m_;
  struct Spheres {
    std::vector<double> x, y, z, radius_m;

    void clear() { x.clear(), y.clear(), z.clear(), radius_m.clear(); }
    void add(const BoundingSphere& sphere);
    SphereColumns columns() const { return {x.data(), y.data(), z.data(), radius_m.data()}; }
  };
  Spheres tile_spheres_, group_spheres_;
  double max_spacing_m_ = 0, max_extent_m_ = 0;
  std::unique_ptr<TiledCloud> merged_;
  int without_normal_ = 0;
};

}  // namespace remote_touch
