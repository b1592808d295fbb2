// The points near the proxy, copied into contiguous columns that the kernels read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "core/geometry/vector.h"
#include "core/kernels/gather_kernels.h"
#include "core/kernels/kernels.h"
#include "core/kernels/points_view.h"

namespace remote_touch {

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

}  // namespace remote_touch
