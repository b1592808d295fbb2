// Search over the points that a tracked sheet shows of a frame: the points in its region without their noise,
// and the points outside it unchanged.
#pragma once

#include <array>
#include <memory>

#include "core/beyond/tracked_surface/patch_region.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

// It is filled anew for every frame, without an allocation if reserve() was called for as many points.
// reserve() keeps the points that it holds.
class SheetSearch final : public NeighbourSearch {
 public:
  void reserve(std::size_t points, bool with_radius, bool with_stiffness);
  // Starts a new frame, with no points in the region. buffer: work buffer for points of the frame while
  // gather() runs. It has columns for radius and stiffness even if the frame has none.
  void start(const PatchRegion& region, std::shared_ptr<const NeighbourSearch> frame,
             std::shared_ptr<GatheredPoints> buffer);
  // Adds a point of the frame, given by its row in `gathered`, at the position where it is shown.
  void add(const PatchPlace& place, const GatheredPoints& gathered, std::size_t row);
  void finish();

  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override;
  std::size_t size() const override { return frame_->size(); }
  bool has_fixture_radius() const override { return frame_->has_fixture_radius(); }
  bool has_regions() const override { return frame_->has_regions(); }
  bool has_stiffness() const override { return frame_->has_stiffness(); }
  double max_fixture_radius_m() const override { return frame_->max_fixture_radius_m(); }

 private:
  static constexpr int kCells = 20;  // number along each side of the region
  struct Columns {
    Buffer<double> x, y, z, radius, stiffness;
    Buffer<std::uint32_t> index;
  };
  int cell_along(double coordinate) const;

  PatchRegion region_;
  std::shared_ptr<const NeighbourSearch> frame_;
  std::shared_ptr<GatheredPoints> buffer_;
  Columns added_, sorted_;  // added_: in the order of add(); sorted_: cell by cell
  Buffer<std::uint32_t> cell_of_;
  std::size_t count_ = 0;
  std::array<std::uint32_t, kCells * kCells + 1> start_{};
};

}  // namespace remote_touch
