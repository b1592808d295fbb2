// Switches that lock and unlock fixtures while a task runs.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace remote_touch {

// A fixture is identified by its index in the list of rules. The switches are set in the haptic loop and read
// where frames are processed. A change has an effect from the next processed frame on.
class FixtureSwitches {
 public:
  static constexpr std::size_t kMaxCount = 64;

  // One bit for each fixture, set if it is off.
  std::uint64_t off() const { return off_.load(std::memory_order_relaxed); }
  static bool is_on(std::uint64_t off, std::size_t fixture) {
    return fixture >= kMaxCount || (off >> fixture & 1) == 0;
  }
  bool is_on(std::size_t fixture) const { return is_on(off(), fixture); }
  // pre: below kMaxCount
  void set(std::size_t fixture, bool on) {
    const std::uint64_t bit = std::uint64_t{1} << fixture;
    if (on)
      off_.fetch_and(~bit, std::memory_order_relaxed);
    else
      off_.fetch_or(bit, std::memory_order_relaxed);
  }

 private:
  std::atomic<std::uint64_t> off_ = 0;
};

}  // namespace remote_touch
