#include "core/dissertation/tool_motion/touch_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/dissertation/tool_motion/contact_thinning.h"
#include "core/points/neighbour_search.h"
#include "core/points/number_columns.h"
#include "core/points/vector.h"

namespace remote_touch {
namespace {

constexpr double kWider = 1 + 1e-12;
constexpr double kMinArea_m2 = 1e-18;  // a smaller triangle shows no plane

}  // namespace

// The plane contains the directions to the farthest point and to the point that is farthest from the line to
// it.
GroupSlab group_slab(std::span<const Vec3> points) {
  BoundingBox box;
  for (const Vec3& p : points) box.extend(p);
  GroupSlab slab{0.5 * (box.min() + box.max()), Vec3::Zero(), 0, 0};
  Vec3 farthest = Vec3::Zero(), across = Vec3::Zero();
  for (const Vec3& p : points)
    if ((p - slab.centre_W).norm() > farthest.norm()) farthest = p - slab.centre_W;
  for (const Vec3& p : points) {
    const Vec3 cross = farthest.cross(p - slab.centre_W);
    if (cross.norm() > across.norm()) across = cross;
  }
  slab.radius_m = kWider * farthest.norm();
  if (!(across.norm() > kMinArea_m2)) return slab;
  slab.n_W = across.normalized();
  for (const Vec3& p : points)
    slab.half_m = std::max(slab.half_m, kWider * std::abs(slab.n_W.dot(p - slab.centre_W)));
  return slab;
}

NormalCone normal_cone(std::span<const Vec3> normals_W) {
  constexpr double kSpare = 1e-9;  // more than the rounding of normals and their products
  NormalCone cone{Vec3::Zero(), 0};
  int count = 0;
  for (const Vec3& n_W : normals_W)
    if (n_W.allFinite()) cone.middle_W += n_W, ++count;
  if (count == 0) return cone;
  cone.middle_W /= count;
  for (const Vec3& n_W : normals_W)
    if (n_W.allFinite()) cone.deviation = std::max(cone.deviation, (n_W - cone.middle_W).norm() + kSpare);
  return cone;
}

namespace {

constexpr double kSamePlace_m = 1e-6;  // closer points count as the same point
constexpr std::uint32_t kTileSide_px = 8;
const BoundingSphere kNoSphere{Vec3::Constant(kFarAway), 0};

// Returns a sphere that contains `count` items. Its centre is the middle of their box, and its radius is the
// smallest possible with this centre.
template <class Item>  // (i) -> BoundingSphere
BoundingSphere around(std::uint32_t count, const Item& item) {
  BoundingBox box;
  for (std::uint32_t i = 0; i < count; ++i) {
    const BoundingSphere s = item(i);
    box.extend(s.centre_W - Vec3::Constant(s.radius_m)).extend(s.centre_W + Vec3::Constant(s.radius_m));
  }
  BoundingSphere all{0.5 * (box.min() + box.max()), 0};
  for (std::uint32_t i = 0; i < count; ++i) {
    const BoundingSphere s = item(i);
    all.radius_m = std::max(all.radius_m, (s.centre_W - all.centre_W).norm() + s.radius_m);
  }
  all.radius_m *= 1 + 1e-12;  // rounding of the distances
  return all;
}

double median_or_0(std::vector<double>& values) {
  return values.empty() ? 0 : median_in_place(values);
}

bool meets(const BoundingSphere& a, const BoundingSphere& b) {
  const double reach = a.radius_m + b.radius_m;
  return (a.centre_W - b.centre_W).squaredNorm() <= reach * reach;
}

}  // namespace

void TiledCloud::add_point(const PointChange::Point& point) {
  const auto& [p, n, spacing_m] = point;
  x_.push_back(p.x()), y_.push_back(p.y()), z_.push_back(p.z());
  if (!n.allFinite()) ++without_normal_;
  nx_.push_back(n.x()), ny_.push_back(n.y()), nz_.push_back(n.z());
  spacing_m_.push_back(spacing_m);
}

void TiledCloud::add_point(const PointCloud& cloud, std::uint32_t i) {
  const Vec3 no_normal = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  add_point({cloud.point(i), cloud.has_normals() ? cloud.normal(i) : no_normal, 0});
}

void TiledCloud::add_tile(const PointCloud& cloud, std::span<const std::uint32_t> points) {
  if (points.empty()) return;
  const auto first = static_cast<std::uint32_t>(x_.size());
  for (const std::uint32_t i : points) add_point(cloud, i);
  finish_tile(first);
}

// Finishes the tile of the points added from `first` on, if there are any.
void TiledCloud::finish_tile(std::uint32_t first) {
  const auto count = static_cast<std::uint32_t>(x_.size()) - first;
  if (count == 0) return;
  while (x_.size() % kTilePoints != 0) {
    for (auto* column : {&x_, &y_, &z_, &nx_, &ny_, &nz_}) column->push_back(kFarAway);
    spacing_m_.push_back(0);
  }
  const auto sphere = around(count, [&](std::uint32_t i) { return BoundingSphere{point(first + i), 0}; });
  tiles_.push_back({sphere, first, static_cast<std::uint32_t>(x_.size()) - first});
  gather_groups(first);
}

// Copies a tile of another cloud without a change.
void TiledCloud::copy_tile(const TiledCloud& all, const Tile& tile) {
  const auto first = static_cast<std::uint32_t>(x_.size());
  const auto append = [](LineVector<double>& to, const LineVector<double>& from, std::size_t begin,
                         std::size_t count) {
    const auto at = from.begin() + static_cast<std::ptrdiff_t>(begin);
    to.insert(to.end(), at, at + static_cast<std::ptrdiff_t>(count));
  };
  constexpr LineVector<double> TiledCloud::*kColumns[] = {
      &TiledCloud::x_,  &TiledCloud::y_,  &TiledCloud::z_,        &TiledCloud::nx_,
      &TiledCloud::ny_, &TiledCloud::nz_, &TiledCloud::spacing_m_};
  for (const auto column : kColumns) append(this->*column, all.*column, tile.first, tile.padded_count);
  constexpr LineVector<double> Spheres::*kParts[] = {&Spheres::x, &Spheres::y, &Spheres::z,
                                                     &Spheres::radius_m};
  for (const auto part : kParts)
    append(group_spheres_.*part, all.group_spheres_.*part, tile.first / kLanes, tile.padded_count / kLanes);
  tiles_.push_back({tile.sphere, first, tile.padded_count});
  for (std::uint32_t i = tile.first; i < tile.first + tile.padded_count; ++i)
    without_normal_ += all.x_[i] != kFarAway && !all.normal(i).allFinite() ? 1 : 0;
}

void TiledCloud::change_tile(const TiledCloud& all, const Tile& tile, const PointChange& change) {
  const auto first = static_cast<std::uint32_t>(x_.size());
  for (std::uint32_t i = tile.first; i < tile.first + tile.padded_count; ++i) {
    if (all.x_[i] == kFarAway) continue;
    PointChange::Point point{all.point(i), all.normal(i), all.spacing_m(i)};
    if (change.apply(point)) add_point(point);
  }
  finish_tile(first);
}

void TiledCloud::reserve(std::size_t points) {
  const std::size_t tiles = points / kTilePoints + 1, padded = tiles * kTilePoints;
  for (auto* column : {&x_, &y_, &z_, &nx_, &ny_, &nz_, &spacing_m_, &extent_m_}) column->reserve(padded);
  for (auto* column : {&tile_spheres_, &group_spheres_}) {
    const std::size_t size = column == &tile_spheres_ ? tiles + kLanes : tiles * kLanes;
    for (auto* part : {&column->x, &column->y, &column->z, &column->radius_m}) part->reserve(size);
  }
  tiles_.reserve(tiles), blocks_.reserve(tiles / kBlockTiles + 1);
}

void TiledCloud::clear() {
  for (auto* column : {&x_, &y_, &z_, &nx_, &ny_, &nz_, &spacing_m_, &extent_m_}) column->clear();
  tile_spheres_.clear(), group_spheres_.clear();
  tiles_.clear(), blocks_.clear();
  number_.clear();
  for (auto& column : slabs_) column.clear();
  merged_.reset(), packed_.reset();
  without_normal_ = 0;
}

void TiledCloud::assign(const TiledCloud& all, const BoundingSphere& ball, const PointChange& change) {
  clear();
  reserve(all.padded_size());
  for (const TileBlock& block : all.blocks()) {
    if (!meets(block.sphere, ball)) continue;
    for (const Tile& tile : all.tiles(block)) {
      if (!meets(tile.sphere, ball)) continue;
      if (change.concerns(tile.sphere))
        change_tile(all, tile, change);
      else
        copy_tile(all, tile);
    }
  }
  extent_m_.assign(x_.size(), 0);
  finish();
}

void TiledCloud::finish() {
  gather_tile_spheres();
  gather_blocks();
  max_spacing_m_ = max_extent_m_ = 0;
  for (const double spacing_m : spacing_m_) max_spacing_m_ = std::max(max_spacing_m_, spacing_m);
  for (const double extent_m : extent_m_) max_extent_m_ = std::max(max_extent_m_, extent_m);
}

void TiledCloud::Spheres::add(const BoundingSphere& sphere) {
  x.push_back(sphere.centre_W.x()), y.push_back(sphere.centre_W.y()), z.push_back(sphere.centre_W.z());
  radius_m.push_back(sphere.radius_m);
}

// Adds the bounding spheres of the groups, beginning with the group of point `first`.
void TiledCloud::gather_groups(std::uint32_t first) {
  for (; first < x_.size(); first += kLanes) {
    std::uint32_t count = 0;
    while (count < kLanes && x_[first + count] != kFarAway) ++count;  // padding comes last
    group_spheres_.add(count == 0 ? kNoSphere : around(count, [&](std::uint32_t i) {
      return BoundingSphere{point(first + i), 0};
    }));
  }
}

void TiledCloud::gather_tile_spheres() {
  for (const Tile& tile : tiles_) tile_spheres_.add(tile.sphere);
  while (tile_spheres_.x.size() % kLanes != 0) tile_spheres_.add(kNoSphere);
}

void TiledCloud::gather_blocks() {
  for (std::uint32_t first = 0; first < tiles_.size(); first += kBlockTiles) {
    const std::uint32_t count = std::min(kBlockTiles, static_cast<std::uint32_t>(tiles_.size()) - first);
    blocks_.push_back(
        {around(count, [&](std::uint32_t i) { return tiles_[first + i].sphere; }), first, count});
  }
}

void TiledCloud::assign(const PointCloud& cloud, double merged_cube_m) {
  clear();
  if (cloud.image) {
    // The order is by blocks of 64 x 64 pixels, so that the tiles of a block lie together.
    const auto width = static_cast<std::uint32_t>(cloud.image->camera.width),
               height = static_cast<std::uint32_t>(cloud.image->camera.height);
    constexpr std::uint32_t kBlockSide_px = 8 * kTileSide_px;
    std::vector<std::uint32_t> points;
    for (std::uint32_t v0 = 0; v0 < height; v0 += kBlockSide_px)
      for (std::uint32_t u0 = 0; u0 < width; u0 += kBlockSide_px)
        for (std::uint32_t v = v0; v < std::min(v0 + kBlockSide_px, height); v += kTileSide_px)
          for (std::uint32_t u = u0; u < std::min(u0 + kBlockSide_px, width); u += kTileSide_px) {
            points.clear();
            for (std::uint32_t row = v; row < std::min(v + kTileSide_px, height); ++row)
              for (std::uint32_t column = u; column < std::min(u + kTileSide_px, width); ++column)
                if (cloud.is_measured(row * width + column)) points.push_back(row * width + column);
            add_tile(cloud, points);
          }
  } else {
    const std::vector<std::uint32_t> order = morton_order(cloud);
    for (std::size_t i = 0; i < order.size(); i += kTilePoints)
      add_tile(cloud, std::span(order).subspan(i, std::min<std::size_t>(kTilePoints, order.size() - i)));
  }
  measure_spacing(cloud);
  extent_m_.assign(x_.size(), 0);
  finish();
  if (!(merged_cube_m > 0) || !is_dense()) return;
  merge(merged_cube_m);
  pack();
}

// False if merged_points() would merge nothing.
bool TiledCloud::is_dense() const {
  return std::any_of(spacing_m_.begin(), spacing_m_.end(),
                     [](double spacing_m) { return spacing_m > 0 && spacing_m <= kMaxMergedSpacing_m; });
}

void TiledCloud::merge(double cube_m) {
  std::vector<CloudPoint> points;
  for (std::uint32_t i = 0; i < x_.size(); ++i)
    if (x_[i] != kFarAway) points.push_back({point(i), normal(i), spacing_m_[i]});
  const std::vector<PointOrDisk> fewer = merged_points(points, cube_m);
  if (fewer.empty()) return;
  merged_ = std::make_unique<TiledCloud>();
  merged_->assign_merged(fewer);
}

void TiledCloud::assign_merged(std::span<const PointOrDisk> points) {
  clear();
  PointCloud cloud;
  for (const PointOrDisk& point : points) cloud.append(point.p_W, point.n_W);
  const std::vector<std::uint32_t> order = morton_order(cloud);
  for (std::size_t i = 0; i < order.size(); i += kTilePoints) {
    const auto first = static_cast<std::uint32_t>(x_.size());
    for (std::size_t k = i; k < std::min<std::size_t>(i + kTilePoints, order.size()); ++k) {
      const PointOrDisk& point = points[order[k]];
      add_point({point.p_W, point.n_W, point.spacing_m});
      extent_m_.push_back(point.extent_m);
    }
    finish_tile(first);
    extent_m_.resize(x_.size(), 0);
  }
  finish();
}

void TiledCloud::measure_spacing(const PointCloud& cloud) {
  spacing_m_.assign(x_.size(), 0);
  if (cloud.image) {
    // Pixels on a slanted surface are farther apart. The factor is limited, because a depth camera measures
    // little beyond 70 degrees.
    const Vec3 camera_W = cloud.image->X_WC.translation(), axis_W = cloud.image->X_WC.linear().col(2);
    const double focal_px = std::min(cloud.image->camera.fx, cloud.image->camera.fy);  // the longer side
    for (std::uint32_t i = 0; i < x_.size(); ++i) {
      if (x_[i] == kFarAway) continue;
      const Vec3 ray = point(i) - camera_W;
      const double slant = std::max(1.0 / 3, std::abs(ray.normalized().dot(normal(i))));  // NaN: 1/3
      spacing_m_[i] = ray.dot(axis_W) / focal_px / slant;
    }
    return;
  }
  std::vector<double> nearest, of_tiles;
  for (const Tile& tile : tiles_) {
    nearest.clear();
    for (std::uint32_t i = tile.first; i < tile.first + tile.padded_count; ++i) {
      double min = std::numeric_limits<double>::infinity();
      for (std::uint32_t j = tile.first; j < tile.first + tile.padded_count; ++j) {
        const double squared = (point(i) - point(j)).squaredNorm();
        if (squared > kSamePlace_m * kSamePlace_m && squared < min) min = squared;
      }
      if (x_[i] != kFarAway && min < 1) nearest.push_back(std::sqrt(min));
    }
    of_tiles.push_back(median_or_0(nearest));
  }
  std::vector<double> sorted = of_tiles;
  const double usual = median_or_0(sorted);
  for (std::size_t t = 0; t < tiles_.size(); ++t)  // a tile of few points may contain no neighbours
    std::fill_n(spacing_m_.begin() + tiles_[t].first, tiles_[t].padded_count,
                of_tiles[t] > 0 ? std::min(of_tiles[t], 2 * usual) : usual);
}

// The packed() cloud of a dense one, with the slabs of its groups.

void TiledCloud::pack() {
  std::vector<Vec3> places;
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < x_.size(); ++i)
    if (x_[i] != kFarAway) places.push_back(point(i)), numbers.push_back(i);
  std::vector<std::uint32_t> order = compact_order(places);
  for (std::uint32_t& i : order) i = numbers[i];
  packed_ = std::make_unique<TiledCloud>();
  packed_->assign_packed(*this, order);
}

void TiledCloud::assign_packed(const TiledCloud& all, std::span<const std::uint32_t> points) {
  for (std::size_t i = 0; i < points.size(); i += kTilePoints) {
    const auto first = static_cast<std::uint32_t>(x_.size());
    for (const std::uint32_t k : points.subspan(i, std::min<std::size_t>(kTilePoints, points.size() - i))) {
      add_point({all.point(k), all.normal(k), all.spacing_m(k)});
      number_.push_back(k);
    }
    finish_tile(first);
  }
  number_.resize(x_.size(), 0);
  extent_m_.assign(x_.size(), 0);
  gather_slabs();
  finish();
}

// Replaces the bounding spheres of the groups by slabs, whose spheres have the same centres and radii.
void TiledCloud::gather_slabs() {
  group_spheres_.clear();
  std::vector<Vec3> points, normals;
  for (std::uint32_t first = 0; first < x_.size(); first += kLanes) {
    points.clear(), normals.clear();
    for (std::uint32_t i = first; i < first + kLanes; ++i)
      if (x_[i] != kFarAway) points.push_back(point(i)), normals.push_back(normal(i));
    const GroupSlab slab =
        points.empty() ? GroupSlab{Vec3::Constant(kFarAway), Vec3::Zero(), 0, 0} : group_slab(points);
    group_spheres_.add({slab.centre_W, slab.radius_m});
    const NormalCone cone = normal_cone(normals);
    const double values[] = {slab.n_W.x(),      slab.n_W.y(),      slab.n_W.z(),      slab.half_m,
                             cone.middle_W.x(), cone.middle_W.y(), cone.middle_W.z(), cone.deviation};
    for (std::size_t k = 0; k < slabs_.size(); ++k) slabs_[k].push_back(values[k]);
  }
}

}  // namespace remote_touch
