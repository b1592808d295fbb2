// A clock that stands still until a thread sleeps. Other threads of a real run act beside the sleeper. Here
// their events happen during the sleep: in the same thread, at their own times, in the order in which they
// are due.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "runners/live/devices/clock.h"

namespace remote_touch {

// The clock begins at 0. Events that are due at the same moment happen in the order in which they were added,
// and before a sleep that ends at that moment is over. An event may sleep itself. If its sleep ends later
// than the sleep during which it happens, that one ends later, too. Only one thread may use the clock.
class SimulatedClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void sleep_until_ns(std::int64_t moment_ns) noexcept override {
    if (moment_ns <= now_ns_) return;
    while (!events_.empty() && events_.begin()->first.first <= moment_ns) happen();
    now_ns_ = std::max(now_ns_, moment_ns);
  }

  void at(double moment_s, std::function<void()> what) { add(ns(moment_s), {std::move(what), 0, 0}); }
  // Calls what() at first_s and then every period_s. Calls that are due while what() itself sleeps are
  // skipped. Returns the number for cancel().
  int every(double period_s, double first_s, std::function<void()> what) {
    const int id = ++last_id_;
    repeated_.insert(id);
    add(ns(first_s), {std::move(what), ns(period_s), id});
    return id;
  }
  void cancel(int id) {
    repeated_.erase(id);
    std::erase_if(events_, [id](const auto& event) { return event.second.id == id; });
  }

 private:
  struct Event {
    std::function<void()> what;
    std::int64_t period_ns;
    int id;  // 0: once
  };

  static std::int64_t ns(double time_s) { return std::llround(1e9 * time_s); }
  void add(std::int64_t due_ns, Event event) {
    events_.emplace(std::pair(std::max(due_ns, now_ns_), ++added_), std::move(event));
  }
  void happen() {
    auto node = events_.extract(events_.begin());
    std::int64_t due_ns = node.key().first;
    now_ns_ = std::max(now_ns_, due_ns);
    Event event = std::move(node.mapped());
    event.what();
    if (!repeated_.contains(event.id)) return;
    due_ns += event.period_ns;
    if (due_ns < now_ns_)
      due_ns += (now_ns_ - due_ns + event.period_ns - 1) / event.period_ns * event.period_ns;
    add(due_ns, std::move(event));
  }

  std::int64_t now_ns_ = 0;
  std::map<std::pair<std::int64_t, std::int64_t>, Event> events_;  // keys: due time, order of adding
  std::int64_t added_ = 0;
  int last_id_ = 0;
  std::set<int> repeated_;
};

// A moment of the clock.
constexpr std::int64_t ms(double time_ms) {
  return static_cast<std::int64_t>(1e6 * time_ms);
}

}  // namespace remote_touch
