// Columns of numbers that begin at a cache line, so that a vector of a whole line is read from one line.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace remote_touch {

inline constexpr std::size_t kLineBytes = 64;

template <class T>
struct WholeLines {
  using value_type = T;  // NOLINT(readability-identifier-naming): the name that the standard library has

  WholeLines() = default;
  template <class Other>
  explicit(false) WholeLines(const WholeLines<Other>&) {}
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{kLineBytes}));
  }
  void deallocate(T* memory, std::size_t) { ::operator delete (memory, std::align_val_t{kLineBytes}); }
  template <class Other>
  bool operator==(const WholeLines<Other>&) const {
    return true;
  }
};

template <class T>
using LineVector = std::vector<T, WholeLines<T>>;

}  // namespace remote_touch
