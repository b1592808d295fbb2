// The points of a frame in the form that detection with a tool reads. Neighbouring points form tiles with
// bounding spheres, and tiles form blocks with bounding spheres, so that one test skips everything that is
// far from the tool.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/dissertation/tool_motion/contact_thinning.h"
#include "core/kernels/tool_kernels.h"
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

}  // namespace remote_touch
