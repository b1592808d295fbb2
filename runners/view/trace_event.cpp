#include "runners/view/trace_event.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace remote_touch {

namespace {

constexpr std::size_t kMaxSpells = 50;

template <class T>
std::vector<T> values_or_none(const ColumnSource& trace, const std::string& name) {
  if (!trace.has(name)) return {};
  Column column = trace.column(name);
  auto* of_type = std::get_if<std::vector<T>>(&column.values);
  return of_type ? std::move(*of_type) : std::vector<T>{};
}

void find_pop_throughs(const ColumnSource& trace, std::vector<TraceEvent>& events) {
  const auto distance_m = values_or_none<double>(trace, "signed_distance");
  for (std::size_t i = 1; i < distance_m.size(); ++i)
    if (distance_m[i - 1] >= 0 && distance_m[i] < 0)
      events.push_back({i, "pop-through", "The proxy's centre gets below the true surface."});
}

void find_force_jump(const ColumnSource& trace, std::vector<TraceEvent>& events) {
  const auto force_N = values_or_none<double>(trace, "force");
  double largest = 0;
  std::size_t tick = 0;
  for (std::size_t i = 3; i + 2 < force_N.size(); i += 3) {
    const double jump = std::hypot(force_N[i] - force_N[i - 3], force_N[i + 1] - force_N[i - 2],
                                   force_N[i + 2] - force_N[i - 1]);
    if (jump > largest) largest = jump, tick = i / 3;
  }
  if (largest == 0) return;
  char text[80];
  std::snprintf(text, sizeof text, "The largest force jump, %.3g N in a tick.", largest);
  events.push_back({tick, "force jump", text});
}

// exhausted: the value that says so, in a column of numbers with names.
void find_spells(const ColumnSource& trace, const std::string& name, std::int32_t exhausted,
                 std::vector<TraceEvent>& events) {
  const auto column = values_or_none<std::int32_t>(trace, name);
  std::size_t found = 0;
  for (std::size_t i = 1; i < column.size() && found < kMaxSpells; ++i)
    if (column[i] == exhausted && column[i - 1] != exhausted) {
      std::size_t end = i;
      while (end < column.size() && column[end] == exhausted) ++end;
      events.push_back(
          {i, "not converged", "Ticks without convergence, " + std::to_string(end - i) + " in a row."});
      ++found;
    }
}

void find_task_steps(const ColumnSource& trace, std::vector<TraceEvent>& events) {
  const auto step = values_or_none<std::int32_t>(trace, "sequence_step");
  for (std::size_t i = 1; i < step.size(); ++i)
    if (step[i] != step[i - 1])
      events.push_back({i, "task", "Step " + std::to_string(step[i - 1]) + " of the task ended."});
}

}  // namespace

std::vector<TraceEvent> trace_events(const ColumnSource& trace) {
  std::vector<TraceEvent> events;
  find_pop_throughs(trace, events);
  find_force_jump(trace, events);
  if (trace.has("budget_exhausted"))
    find_spells(trace, "budget_exhausted", 1, events);
  else
    find_spells(trace, "converged", 0, events);
  find_task_steps(trace, events);
  std::stable_sort(events.begin(), events.end(),
                   [](const TraceEvent& a, const TraceEvent& b) { return a.tick < b.tick; });
  return events;
}

}  // namespace remote_touch
