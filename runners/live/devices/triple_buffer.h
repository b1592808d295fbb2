// Passes the newest value from one thread to another, lock-free.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace remote_touch {

// One producer, one consumer. publish() and take() each need one atomic exchange. A slot belongs to one side
// at a time, so its old value is freed by the side that overwrites it.
template <class T>
class TripleBuffer {
 public:
  // The producer's slot, to be written before publish().
  T& back() { return slots_[back_]; }
  // Makes the written value the newest one. Returns false if the value before it was never taken.
  bool publish() {
    const std::uint32_t before = middle_.exchange(back_ | kNew, std::memory_order_acq_rel);
    back_ = before & kSlot;
    return (before & kNew) == 0;
  }

  // Returns true if a value was published since the last call. front() then returns the newest one.
  bool take() {
    if ((middle_.load(std::memory_order_relaxed) & kNew) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kSlot;
    return true;
  }
  T& front() { return slots_[front_]; }

 private:
  static constexpr std::uint32_t kSlot = 3, kNew = 4;

  std::array<T, 3> slots_{};
  alignas(64) std::atomic<std::uint32_t> middle_ = 1;
  alignas(64) std::uint32_t back_ = 0;
  alignas(64) std::uint32_t front_ = 2;
};

}  // namespace remote_touch
