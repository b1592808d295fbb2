// A neighbour search over points in the order of their indices, in blocks with bounding boxes. It can be
// filled repeatedly without allocating. Points with neighbouring indices should be near each other, as in an
// image or a grid.
#pragma once

#include <vector>

#include "core/geometry/vector.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

class BlockSearch final : public NeighbourSearch {
 public:
  void reserve(std::size_t points);
  // Sets the number of points. All points are missing until set() is called for them. The memory is kept.
  void clear(std::size_t points, int columns, bool with_radius, bool with_stiffness);
  void set(std::size_t number, const Vec3& p_W) {
    x_[number] = p_W.x(), y_[number] = p_W.y(), z_[number] = p_W.z();
  }
  void set_fixture_radius(std::size_t number, double radius_m) { radius_[number] = radius_m; }
  void set_stiffness(std::size_t number, double N_per_m) { stiffness_[number] = N_per_m; }
  // Must be called after the last set().
  void finish();

  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override;
  std::size_t size() const override { return x_.size(); }
  bool has_fixture_radius() const override { return !radius_.empty(); }
  bool has_regions() const override { return max_radius_m_ > 0; }
  double max_fixture_radius_m() const override { return max_radius_m_; }
  bool has_stiffness() const override { return !stiffness_.empty(); }
  int organised_columns() const override { return columns_; }

 private:
  std::vector<double> x_, y_, z_, radius_, stiffness_;
  std::vector<BoundingBox> boxes_;
  double max_radius_m_ = 0;
  int columns_ = 0;
};

}  // namespace remote_touch
