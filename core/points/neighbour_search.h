// Searches for the points near a position, and orders of points in which neighbours follow each other. Every
// search returns the same set: all points whose forbidden regions meet a ball, |x - centre| <= radius + r_f,
// compared as squares in double; without regions r_f is 0. The searches differ in which points they test.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/kernels/point_kernels.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

// Returns the indices of the measured points along a Morton curve through the cloud's bounding box: most
// points follow a neighbour. Points in the same cell of the curve keep the order of the cloud.
std::vector<std::uint32_t> morton_order(const PointCloud& cloud);

// Returns the indices of the points in an order with compact runs, whose boxes are nearly cubes. Each run of
// 8, 64, 512 or 4096 that begins at a multiple of its length is one part of a halving of the cloud, across
// its longest side each time. So all runs but the last are full. pre: the points are finite.
std::vector<std::uint32_t> compact_order(std::span<const Vec3> points);

// The points near the proxy, copied into contiguous columns that the kernels read.

struct Ball {
  Vec3 centre;
  double radius;
};

// Buffer for numbers that are written before they are read. It is not initialised, so memory pages that are
// never written use no physical memory.
template <class T>
class Buffer {
 public:
  // Enlarges the buffer to `size` values if it is smaller. The first `kept` values stay; all others are lost.
  void grow(std::size_t size, std::size_t kept = 0) {
    if (size <= size_) return;
    auto more = std::make_unique_for_overwrite<T[]>(size);
    for (std::size_t i = 0; i < kept; ++i) more[i] = numbers_[i];
    numbers_ = std::move(more), size_ = size;
  }
  T* data() const { return numbers_.get(); }
  T& operator[](std::size_t i) const { return numbers_[i]; }

 private:
  std::unique_ptr<T[]> numbers_;
  std::size_t size_ = 0;
};

// The columns are allocated once, by reserve(); adding and clearing never allocate. The order of the points
// depends on the search, but no result depends on it.
class GatheredPoints {
 public:
  // Selects the columns and gives them capacity for every point of a cloud. Allocates only if they are
  // shorter.
  void reserve(std::size_t cloud_size, bool with_radius, bool with_stiffness);
  void clear() { count_ = 0; }
  // Appends the points of the run whose regions meet the ball. pre: reserve() was called for the run's cloud.
  void add(const PointRun& run, const Ball& ball, const Kernels& kernels);
  // Pads the columns to whole lanes. Call it once after the last add().
  void finish();

  std::size_t size() const { return count_; }
  // Returns the indices of the points in the frame, which do not depend on the order of the search.
  const std::uint32_t* index() const { return index_.data(); }
  PointsView view() const;
  // Returns the points as a run, from which some can be appended to another list. Valid until the list
  // changes.
  PointRun run() const;

 private:
  std::size_t count_ = 0;
  bool with_radius_ = false, with_stiffness_ = false;
  Buffer<double> x_, y_, z_, radius_, stiffness_;
  Buffer<std::uint32_t> index_;
};

class NeighbourSearch {
 public:
  virtual ~NeighbourSearch() = default;
  // Adds the points whose regions meet the ball to out, which has capacity for size() points. A ball with NaN
  // adds none. It does not call finish(). Only one thread may call it at a time, because an implementation
  // may cache results for the next call.
  virtual void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const = 0;
  virtual std::size_t size() const = 0;
  // Returns every measured point, in the order of the search. The default writes the points that gather()
  // finds within 1e6 m of the origin into buffer: positions, and radii and stiffness if there are any, but no
  // normals and no colours. A search over a stored cloud returns the cloud itself, with all its columns;
  // there the missing measurements are included as NaN.
  virtual const PointCloud& every_point(const Kernels& kernels, PointCloud& buffer) const;
  // Returns the cloud that is searched, in the order of the search; null if its points are computed on
  // demand.
  virtual const PointCloud* stored_cloud() const { return nullptr; }
  virtual bool has_fixture_radius() const { return false; }
  // Returns true if some radius is above 0, that is if there are forbidden regions, chapter 5.
  virtual bool has_regions() const { return false; }
  virtual bool has_stiffness() const { return false; }
  // Returns an upper bound of r_f of the cloud, m.
  virtual double max_fixture_radius_m() const { return 0; }
  // Returns the number of columns of an organised frame; 0: unorganised. The point in a row and column has
  // the index row x columns + column in GatheredPoints::index(), for every order of the search.
  virtual int organised_columns() const { return 0; }
};

// A search over a stored cloud.
class CloudSearch : public NeighbourSearch {
 public:
  explicit CloudSearch(PointCloud cloud);
  std::size_t size() const override { return cloud_.size(); }
  bool has_fixture_radius() const override { return !cloud_.fixture_radius_m.empty(); }
  bool has_regions() const override { return max_fixture_radius_ > 0; }
  bool has_stiffness() const override { return !cloud_.stiffness_N_per_m.empty(); }
  double max_fixture_radius_m() const override { return max_fixture_radius_; }
  int organised_columns() const override { return cloud_.columns(); }
  const PointCloud* stored_cloud() const override { return &cloud_; }
  const PointCloud& every_point(const Kernels&, PointCloud&) const override { return cloud_; }

 protected:
  PointRun run(std::size_t first, std::size_t count) const;
  // Returns a ball that contains every point whose region meets the given one: its radius is larger by the
  // largest r_f of the cloud.
  Ball widened(const Ball& ball) const { return {ball.centre, ball.radius + max_fixture_radius_}; }
  PointCloud cloud_;

 private:
  double max_fixture_radius_ = 0;
};

// Tests every point: the oracle for the others, and the best choice for a few hundred points.
class BruteForceSearch final : public CloudSearch {
 public:
  using CloudSearch::CloudSearch;
  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override;
};

// Tests the points of the image window onto which the ball is projected, 4.2.2. pre: cloud.image is correct.
class ImageWindowSearch final : public CloudSearch {
 public:
  explicit ImageWindowSearch(PointCloud cloud);
  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override;

 private:
  RigidTransform X_CW_;
  double nearest_depth_m_;  // smallest depth of the whole image
};

// Tests the cells of a uniform grid that the ball's bounding box meets. Points are stored cell by cell, and
// neighbouring cells along z are contiguous, so that they are tested as one run.
class UniformGridSearch final : public CloudSearch {
 public:
  // cell_m is increased until there are at most about four cells per point. Throws std::invalid_argument if
  // it is not positive.
  UniformGridSearch(PointCloud cloud, double cell_m);
  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override;
  int organised_columns() const override { return columns_; }

 private:
  int cell_along(int axis, double coordinate) const;
  void choose_cells(double cell_m);
  void sort_points_by_cell();

  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();
  double cells_per_m_ = 1;
  int cells_[3] = {1, 1, 1};
  int columns_;                                // columns of the given cloud; the stored points are sorted by
                                               // cell
  std::vector<std::uint32_t> cell_start_;      // first stored position of each cell, and the end
  std::vector<std::uint32_t> original_index_;  // original number of each stored point
};

// Returns an image window search for a cloud with an image, brute force for at most 256 points, the grid
// otherwise.
std::unique_ptr<NeighbourSearch> make_search(PointCloud cloud, double cell_m = 0.004);

// The points around a moving proxy, gathered once and kept while the proxy stays near. A kept list belongs to
// a small cube of space, not to the path of the proxy: around() always returns the same points for a
// position, so results do not depend on history or on the search used. A few lists are kept, because a proxy
// on noisy points moves back and forth between neighbouring cubes.
class Neighbourhood {
 public:
  // reach (m): the list of a queried position holds every point with r_n <= reach, and some beyond.
  Neighbourhood(double reach, const Kernels& kernels);

  // Changes the reach. All kept lists become invalid.
  void set_reach(double reach);
  // Allocates memory for clouds of up to `points` points.
  void reserve(std::size_t points, bool with_radius, bool with_stiffness);
  // Replaces the cloud; all kept lists become invalid. Allocates if the cloud is the largest so far.
  void set_points(std::shared_ptr<const NeighbourSearch> points);
  // Returns the points around p. Valid until the next call.
  const GatheredPoints& around(const Vec3& p);
  // Returns the points of around(p); without most of those beyond the reach if p has moved little since the
  // last call. The points beyond the reach depend on earlier calls, so no result may depend on them. A narrow
  // list saves time because a slow proxy reads it in many steps. Valid until the next call.
  const GatheredPoints& narrowed(const Vec3& p);
  // Searches anew and returns all points with r_n <= radius of p, and possibly some beyond. Valid until the
  // next call.
  const GatheredPoints& within(const Vec3& p, double radius);
  // Returns the distance that a ball of the given radius can move from p along the unit vector u before it
  // meets a region, (4.9), (5.9), or limit if it meets none before. Tests the whole swept tube.
  double first_hit(const Vec3& p, const Vec3& u, double radius, double limit) {
    return first_hit(p, u, radius, limit, true);
  }
  // Returns the same distance for points without their r_f.
  double first_hit_of_points(const Vec3& p, const Vec3& u, double radius, double limit) {
    return first_hit(p, u, radius, limit, false);
  }

  bool has_regions() const { return points_->has_regions(); }

  // Returns M of kernels.h for sums over the present list.
  double sum_grid() const { return cache_[current_].sum_grid; }

 private:
  struct CachedList {
    Vec3 centre = Vec3::Zero();
    bool valid = false;
    double sum_grid = 1.5;
    GatheredPoints points = {};
  };
  void forget_lists();
  void gather(CachedList& kept);
  double first_hit(const Vec3& p, const Vec3& u, double radius, double limit, bool with_regions);

  double reach_;
  double pitch_;  // edge of the cubes
  double list_radius_;
  double narrow_margin_;
  const Kernels& kernels_;
  std::shared_ptr<const NeighbourSearch> points_;
  std::array<CachedList, 4> cache_;
  std::size_t current_ = 0;
  GatheredPoints tube_;  // gathered for one call
  // The points of cache_[narrow_of_] within the reach of any position nearer than narrow_margin_ to
  // narrow_.centre.
  CachedList narrow_;
  std::size_t narrow_of_ = 0;
  Vec3 last_W_ = Vec3::Zero();  // position in the last call of narrowed()
};

}  // namespace remote_touch
