// A normal for each point of a frame: the axis along which its nearest neighbours are thinnest (principal
// component analysis), turned towards the sensor. A normal is computed at its first use and kept until the
// next frame. Beside it, a cloud as an implicit surface, and exact sums over neighbours.
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/kernels/point_kernels.h"
#include "core/points/neighbour_search.h"
#include "core/points/vector.h"

namespace remote_touch {

// The axis along which a cloud is thinnest: the eigenvector of the smallest eigenvalue of a symmetric matrix.
// It is computed by cyclic Jacobi rotations in plain double, because the results of Eigen's solver differ in
// the last bits between x86-64 levels.
struct ThinnestAxis {
  Vec3 axis = Vec3::UnitX();  // unit; its sign has no meaning
  double smallest = 0;        // eigenvalue of this axis
  double middle = 0;          // next larger eigenvalue; if both are equal, the axis is not unique
};

// pre: the matrix is symmetric and finite. If a coordinate changes its sign, the signs of the off-diagonal
// elements of that coordinate change too. The axis is then the same, bit for bit, except for the sign of that
// coordinate.
ThinnestAxis thinnest_axis(const Eigen::Matrix3d& symmetric);

// The nearest neighbours of a position in a frame, for methods that adapt to the density of the points.
class NearestPoints {
 public:
  explicit NearestPoints(const Kernels& kernels) : kernels_(kernels) {}

  // Allocates memory for clouds of this number of points.
  void reserve(std::size_t points);
  // Finds the `count` points nearest to p. p itself is included if it is a point. If there are fewer within
  // 0.5 m, it finds all of these. The set is the same for every order of the points: points as far away as
  // the last one belong to it too. Returns the distance of the last one; 0 if no point was found. Allocates
  // only for a cloud larger than reserved.
  double find(const NeighbourSearch& points, const Vec3& p_W, int count);
  // Calls act(x - p) for each point of the set found last.
  template <class Act>
  void for_each(const Act& act) const {
    for (std::size_t i = 0; i < near_.size(); ++i)
      if (squared_[i] <= limit_) act(Vec3(offset(i)));
  }

 private:
  Vec3 offset(std::size_t i) const;
  std::size_t gather(const NeighbourSearch& points, double radius);

  const Kernels& kernels_;
  GatheredPoints near_;
  Buffer<double> squared_, sorted_;
  Vec3 p_W_ = Vec3::Zero();
  double limit_ = 0;         // largest squared distance of a point of the set
  double radius_m_ = 0.004;  // radius of the first ball, from the last search
};

// Returns the mean over the points of the mean distance to the three nearest other points: for a square grid
// without noise this is its spacing. A cloud of 20000 points or more is sampled. Returns 0 if there are fewer
// than four points. The order of the points has no effect. buffer: for a search without a stored cloud.
double mean_spacing_m(const NeighbourSearch& points, NearestPoints& nearest, const Kernels& kernels,
                      PointCloud& buffer);

// The sensor: its position, or only its viewing direction if it is far away.
struct ViewPoint {
  bool has_position = false;
  Vec3 position_W = Vec3::Zero();
  Vec3 direction_W{0, -1, 0};

  // Vector from the sensor to p; not of unit length.
  Vec3 ray_to(const Vec3& p_W) const { return has_position ? Vec3(p_W - position_W) : direction_W; }
};

// Returns the camera position of a stored frame with an image, else the direction.
ViewPoint view_point(const NeighbourSearch& points, const Vec3& direction_W);

class PointNormals {
 public:
  // neighbours: number of points of a plane fit, the point itself included; 3 or more.
  PointNormals(int neighbours, const Kernels& kernels) : neighbours_(neighbours), nearest_(kernels) {}

  void reserve(std::size_t points);
  // Starts a new frame. Allocates only for a frame larger than reserved. pre: the points live until the next
  // call.
  void set_points(const NeighbourSearch& points, const ViewPoint& view);
  // Returns the unit normal of the point with that index in the frame; zero if its neighbours span no plane.
  // The order of the points has no effect. Allocates nothing.
  Vec3 of(std::uint32_t number, const Vec3& x_W);
  NearestPoints& nearest() { return nearest_; }

 private:
  Vec3 compute(const Vec3& x_W);

  const int neighbours_;
  NearestPoints nearest_;
  const NeighbourSearch* points_ = nullptr;
  ViewPoint view_;
  std::uint32_t frame_ = 0;  // number of calls of set_points()
  std::vector<Vec3> normals_;
  std::vector<std::uint32_t> computed_in_;  // value of frame_ when the normal was computed
};

// A point cloud as an implicit surface: A. Leeper, S. Chan, K. Salisbury, "Point clouds can be represented as
// implicit surfaces for constraint-based haptic rendering", ICRA 2012, [84] of the dissertation. f is
// positive outside, and f = 0 is the surface. There are two kinds:
//
//   metaballs  f(p) = T - sum_i w(|p - x_i| / R): every point is expanded to a smooth ball
//   surfels    f(p) = n . (p - a) / R: a is the weighted mean of the points around p, n the axis along which
//              their weighted covariance is smallest (total least squares). The gradient is taken to be n.
//
// Lengths are in units of the support radius R, so f and its gradient are dimensionless. r_f of points is
// ignored. The bits are the same for every order of the points: the sums are pre-rounded as in
// core/kernels/kernels.h.

enum class SurfaceKind { metaballs, surfels };
// The weight w(q): 1 at q = 0; from q = 1 on both w and its slope are zero.
enum class SurfaceWeight {
  wyvill,   // 1 - 4/9 q^6 + 17/9 q^4 - 22/9 q^2
  wendland  // (1 - q)^4 (4 q + 1), the psi of (4.2)
};

// f and its gradient at a position. f is positive outside of all support, and the gradient is zero there.
struct SurfaceSample {
  bool supported = false;  // true: there are points within R
  double value = 1;
  Vec3 gradient = Vec3::Zero();

  // Returns the unit normal out of the surface; zero if the gradient is too short to have a direction.
  Vec3 normal() const;
  // Returns the estimated distance to the surface, f / |grad f|, in units of R, negative inside. It is exact
  // for a plane of surfels, else it is one Newton step. It is 1 with the sign of f if there is no gradient.
  double distance() const;
};

class PointSurface {
 public:
  // threshold: T of the metaballs, above 0.
  PointSurface(SurfaceKind kind, SurfaceWeight weight, double support_radius_m, double threshold)
      : kind_(kind), weight_(weight), radius_m_(support_radius_m), threshold_(threshold) {}

  // points: all points within R of p, and any beyond. sum_grid: M of core/kernels/kernels.h for that number
  // of points. side: surfels have no inside of their own. n is chosen within 90 degrees of side, or, if side
  // is zero, towards the side on which p is. One point, or points on a line, have no plane: p is then
  // outside.
  SurfaceSample at(const PointsView& points, double sum_grid, const Vec3& p_W, const Vec3& side) const;

  // Evaluates surfels that have a side. n is the weighted mean of the unit normals of the points. normals:
  // one for each point of the list; zero if a point has none.
  SurfaceSample oriented(const PointsView& points, const Vec3* normals, double sum_grid,
                         const Vec3& p_W) const;

 private:
  SurfaceSample metaballs(const PointsView& points, double sum_grid, const Vec3& p_W) const;
  SurfaceSample surfels(const PointsView& points, double sum_grid, const Vec3& p_W, const Vec3& side) const;

  SurfaceKind kind_;
  SurfaceWeight weight_;
  double radius_m_, threshold_;
};

// Sums that do not depend on the order of their terms: every term is rounded to a fixed grid first, as in
// core/kernels/kernels.h.

// Returns M of core/kernels/kernels.h for `terms` terms of magnitude 1.
inline double sum_grid_for(std::size_t terms) {
  return 1.5 * static_cast<double>(std::bit_ceil(terms + 1));
}

// A sum of terms of magnitude 1, up to the number of terms for which the grid was computed.
class ExactSum {
 public:
  explicit ExactSum(double grid) : grid_(grid) {}
  void add(double term) { sum_ += (term + grid_) - grid_; }
  double value() const { return sum_; }

 private:
  double grid_, sum_ = 0;
};

struct ExactVector {
  explicit ExactVector(double grid) : x(grid), y(grid), z(grid) {}
  void add(const Vec3& v) { x.add(v.x()), y.add(v.y()), z.add(v.z()); }
  Vec3 value() const { return {x.value(), y.value(), z.value()}; }
  ExactSum x, y, z;
};

// A sum of w e e^T, for vectors e of magnitude up to 1.
struct ExactSquares {
  explicit ExactSquares(double grid) : squares(grid), products(grid) {}
  void add(double weight, const Vec3& e) {
    squares.add(weight * e.cwiseProduct(e));
    products.add(weight * Vec3(e.y() * e.z(), e.z() * e.x(), e.x() * e.y()));
  }
  // Returns the sum divided by a number.
  Eigen::Matrix3d over(double divisor) const {
    const Vec3 xx = squares.value() / divisor, yz = products.value() / divisor;
    Eigen::Matrix3d c;
    c << xx.x(), yz.z(), yz.y(), yz.z(), xx.y(), yz.x(), yz.y(), yz.x(), xx.z();
    return c;
  }
  ExactVector squares, products;  // xx, yy, zz; yz, zx, xy
};

// First and second moments of weighted positions of magnitude up to 1: their mean and covariance.
class ExactMoments {
 public:
  explicit ExactMoments(double grid) : weights_(grid), first_(grid), second_(grid) {}
  void add(double weight, const Vec3& e) {
    weights_.add(weight);
    first_.add(weight * e);
    second_.add(weight, e);
  }
  double weight() const { return weights_.value(); }
  Vec3 mean() const { return first_.value() / weight(); }
  Eigen::Matrix3d covariance() const {
    const Vec3 m = mean();
    return second_.over(weight()) - m * m.transpose();
  }

 private:
  ExactSum weights_;
  ExactVector first_;
  ExactSquares second_;
};

}  // namespace remote_touch
