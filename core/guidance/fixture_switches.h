// Which of the fixtures of a task count: a task locks and unlocks them while it runs.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace remote_touch {

// Fixtures by their place in the list. Set in the haptic loop, read where frames are processed; a change
// counts from the next frame that is processed.
class FixtureSwitches {
 public:
  static constexpr std::size_t kMost = 64;

  bool is_on(std::size_t fixture) const {
    return fixture >= kMost || (off_.load(std::memory_order_relaxed) >> fixture & 1) == 0;
  }
  // pre: below kMost
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
