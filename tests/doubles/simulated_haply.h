// Haply's Inverse service on a simulated clock: a link that answers each command after a time, or not at all.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "runners/live/devices/haply.h"
#include "tests/doubles/haply_world.h"
#include "tests/doubles/simulated_clock.h"

namespace remote_touch {

class SimulatedHaply {
 public:
  struct Sent {
    std::int64_t at_ns;
    HaplyCommand command;
  };

  explicit SimulatedHaply(SimulatedClock& clock) : clock_(clock) {}
  // Opens the adapter at this service. settings is appended to its address.
  std::unique_ptr<HapticDevice> open(const std::string& settings = "");

  HaplyWorld world;
  std::int64_t answers_after_ns = 200'000;
  // The service does not answer from now on. Answers that were due come with resume().
  void hang() { hangs_ = true; }
  void resume();
  // Ends the connection.
  void die() { is_dead_ = true; }

  const std::vector<Sent>& sent() const { return sent_; }
  bool is_cut() const { return is_cut_; }

 private:
  class Link;
  struct Answer {
    std::int64_t due_ns;
    std::string text;
  };

  SimulatedClock& clock_;
  std::vector<Sent> sent_;
  std::deque<Answer> answers_;
  Vec3 given_N_ = Vec3::Zero();
  bool hangs_ = false, is_dead_ = false, is_cut_ = false;
};

}  // namespace remote_touch
