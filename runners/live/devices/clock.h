// The clock of a live run: sensors, devices and the loop between them read the time from it and wait on it;
// and what threads in real time need: rights, and a value that passes from one to another.
#pragma once

#include <time.h>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <string>

namespace remote_touch {

// Times count from a fixed but arbitrary origin and never decrease. A clock must outlive the objects that use
// it.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual std::int64_t now_ns() const noexcept = 0;
  // Returns at moment_ns or later. Returns at once if that time has passed.
  virtual void sleep_until_ns(std::int64_t moment_ns) noexcept = 0;

  double now_s() const noexcept { return 1e-9 * static_cast<double>(now_ns()); }
  void sleep_s(double time_s) noexcept { sleep_until_ns(now_ns() + std::llround(1e9 * time_s)); }
};

// The clock of this machine, CLOCK_MONOTONIC.
class SteadyClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return kNsPerS * now.tv_sec + now.tv_nsec;
  }
  void sleep_until_ns(std::int64_t moment_ns) noexcept override {
    const timespec moment{moment_ns / kNsPerS, moment_ns % kNsPerS};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &moment, nullptr) == EINTR) continue;
  }

 private:
  static constexpr std::int64_t kNsPerS = 1'000'000'000;
};

inline Clock& steady_clock() {
  static SteadyClock clock;
  return clock;
}

// Requests the real-time settings that an ordinary Linux system offers: SCHED_FIFO at priority 80 and a fixed
// processor for the calling thread, and locked memory for the process. None of them is required. Memory is
// locked page by page as it is used, because locking all at once would also commit the memory that reserve()
// only reserved. Returns one line: the requests granted, and why the others were not.
std::string become_real_time();

// Requests a higher priority for the calling thread, which monitors a loop in real time. It stays at its own
// priority if the request is refused.
void outrank_the_loop() noexcept;

// Passes the newest value from one thread to another, lock-free.
//
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
