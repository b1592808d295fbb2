// A lock-free queue of fixed length from one thread to another.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <vector>

namespace remote_touch {

// One producer, one consumer. Allocates on construction only.
template <class T>
class Ring {
 public:
  // min_capacity: rounded up to a power of two.
  explicit Ring(std::size_t min_capacity) : slots_(std::bit_ceil(min_capacity)) {}

  // The slot to write next, or null if the queue is full; push() passes it on.
  T* next_slot() {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - start_.load(std::memory_order_acquire) == slots_.size()) return nullptr;
    return &slots_[end & (slots_.size() - 1)];
  }
  void push() { end_.store(end_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  // The oldest value, or null; pop() removes it.
  T* oldest() {
    const std::size_t start = start_.load(std::memory_order_relaxed);
    if (start == end_.load(std::memory_order_acquire)) return nullptr;
    return &slots_[start & (slots_.size() - 1)];
  }
  void pop() { start_.store(start_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

 private:
  std::vector<T> slots_;
  alignas(64) std::atomic<std::size_t> end_ = 0;
  alignas(64) std::atomic<std::size_t> start_ = 0;
};

}  // namespace remote_touch
