#include "tests/doubles/simulated_haply.h"

#include <algorithm>
#include <cerrno>
#include <cmath>

namespace remote_touch {

class SimulatedHaply::Link final : public HaplyLink {
 public:
  explicit Link(SimulatedHaply& service) : service_(service) {}

  DeviceFault send(std::string_view text, double) noexcept override {
    if (service_.is_dead_ || service_.is_cut_) return kClosed;
    SimulatedClock& clock = service_.clock_;
    for (const HaplyCommand& command : haply_commands(std::string(text))) {
      service_.sent_.push_back({clock.now_ns(), command});
      service_.given_N_ = given_force_N(service_.world, command);
    }
    service_.answers_.push_back(
        {clock.now_ns() + service_.answers_after_ns, haply_state(service_.world, service_.given_N_)});
    return {};
  }

  DeviceFault receive(std::string_view& text, double deadline_s) noexcept override {
    SimulatedClock& clock = service_.clock_;
    const std::int64_t deadline_ns = std::llround(1e9 * deadline_s);
    for (;;) {
      if (service_.is_dead_ || service_.is_cut_) return kClosed;
      const bool is_owed = !service_.hangs_ && !service_.answers_.empty();
      if (is_owed && service_.answers_.front().due_ns <= clock.now_ns()) break;
      if (clock.now_ns() >= deadline_ns) return {"the Haply service does not answer", ETIMEDOUT};
      // The wait is split into steps, because an event during it may end it.
      clock.sleep_until_ns(std::min(deadline_ns, clock.now_ns() + kStep_ns));
    }
    last_ = std::move(service_.answers_.front().text);
    service_.answers_.pop_front();
    text = last_;
    return {};
  }

  void cut() noexcept override { service_.is_cut_ = true; }

 private:
  static constexpr DeviceFault kClosed{"the Haply service closed the connection"};
  static constexpr std::int64_t kStep_ns = 10'000;

  SimulatedHaply& service_;
  std::string last_;
};

std::unique_ptr<HapticDevice> SimulatedHaply::open(const std::string& settings) {
  is_cut_ = false;
  answers_.assign(1, {clock_.now_ns(), haply_inventory(world, given_N_)});
  return open_haply(settings, clock_, [this](const DeviceAddress&, const Clock&, double) {
    return std::make_unique<Link>(*this);
  });
}

void SimulatedHaply::resume() {
  hangs_ = false;
  for (Answer& answer : answers_) answer.due_ns = std::max(answer.due_ns, clock_.now_ns());
}

}  // namespace remote_touch
