// Sums that do not depend on the order of their terms: every term is rounded to a fixed grid first, as in
// core/kernels/kernels.h.
#pragma once

#include <bit>
#include <cstddef>

#include "core/geometry/vector.h"

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

// First and second moments of weighted positions of magnitude up to 1: their mean and covariance.
class ExactMoments {
 public:
  explicit ExactMoments(double grid) : weights_(grid), first_(grid), squares_(grid), products_(grid) {}
  void add(double weight, const Vec3& e) {
    weights_.add(weight);
    first_.add(weight * e);
    squares_.add(weight * e.cwiseProduct(e));
    products_.add(weight * Vec3(e.y() * e.z(), e.z() * e.x(), e.x() * e.y()));
  }
  double weight() const { return weights_.value(); }
  Vec3 mean() const { return first_.value() / weight(); }
  Eigen::Matrix3d covariance() const {
    const Vec3 xx = squares_.value() / weight(), yz = products_.value() / weight(), m = mean();
    Eigen::Matrix3d c;
    c << xx.x(), yz.z(), yz.y(), yz.z(), xx.y(), yz.x(), yz.y(), yz.x(), xx.z();
    c -= m * m.transpose();
    return c;
  }

 private:
  ExactSum weights_;
  ExactVector first_, squares_, products_;  // squares: xx, yy, zz; products: yz, zx, xy
};

}  // namespace remote_touch
