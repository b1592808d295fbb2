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

// Buffer for numbers that are written before they are read; memory that is never written is never allocated.
template <class T>
class Buffer {
 public:
  // When the buffer grows, the first `kept` values stay; all others are lost.
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

// Columns are allocated once, by reserve(); adding and clearing never allocate. The order of the points is
// whatever the search produced: no result depends on it.
class GatheredPoints {
 public:
  // Sets the columns, with capacity for every point of a cloud; allocates only if they are shorter.
  void reserve(std::size_t cloud_size, bool with_radius, bool with_stiffness);
  void clear() { count_ = 0; }
  // Appends those points of the run whose regions meet the ball. pre: reserve() for the run's cloud.
  void add(const PointRun& run, const Ball& ball, const Kernels& kernels);
  // Pads to whole lanes; to be called once after the last add().
  void finish();

  std::size_t size() const { return count_; }
  // The numbers that the points have in the frame, whatever the order of the search.
  const std::uint32_t* index() const { return index_.data(); }
  PointsView view() const;

 private:
  std::size_t count_ = 0;
  bool with_radius_ = false, with_stiffness_ = false;
  Buffer<double> x_, y_, z_, radius_, stiffness_;
  Buffer<std::uint32_t> index_;
};

}  // namespace remote_touch
