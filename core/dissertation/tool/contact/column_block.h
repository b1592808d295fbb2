// Columns of doubles of one length, in one piece of memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/search/gathered_points.h"

namespace remote_touch {

// Columns begin at whole cache lines, each at a different offset in its page. Columns that are whole pages
// apart would share the same few lines of a cache, and evict each other if there are more of them than cache
// ways.
template <std::size_t kCount>
class ColumnBlock {
 public:
  // Makes room for `size` values in each column. The contents of the columns are lost if they grow.
  void grow(std::size_t size) {
    if (size <= size_) return;
    size_ = size;
    stride_ = (size + kPage - 1) / kPage * kPage + kShift;
    memory_.grow(kCount * stride_ + kLine);
  }
  double* operator[](std::size_t column) const {
    const auto at = reinterpret_cast<std::uintptr_t>(memory_.data()) / sizeof(double);
    return memory_.data() + (kLine - at % kLine) % kLine + column * stride_;
  }

 private:
  static constexpr std::size_t kLine = 64 / sizeof(double), kPage = 4096 / sizeof(double);
  static constexpr std::size_t kShift = 5 * kLine;  // 5 and the 64 lines of a page have no common factor

  Buffer<double> memory_;
  std::size_t size_ = 0, stride_ = 0;
};

}  // namespace remote_touch
