// Sums that do not depend on the order of their terms: every term is rounded to a fixed grid first, as in
// core/kernels/kernels.h.
#pragma once

#include <bit>
#include <cstddef>

#include "core/points/vector.h"

namespace remote_touch {

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
