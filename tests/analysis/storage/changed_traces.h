// A lift, and copies of its trace that are changed by hand.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "analysis/storage/trace_comparison.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch::changed_traces {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Columns = std::vector<Column>;
using Texts = std::vector<std::string>;

inline const Columns& lift() {
  static const Columns columns = [] {
    SimulationOptions options;
    options.hash_frames = true;
    return simulate(Experiment::load("fig4.12"), options).columns();
  }();
  return columns;
}

template <class Columns>
auto& find(Columns& columns, const std::string& name) {
  for (auto& column : columns)
    if (column.name == name) return column;
  throw std::out_of_range(name);
}
inline std::vector<double>& numbers(Columns& columns, const std::string& name) {
  return std::get<std::vector<double>>(find(columns, name).values);
}
inline std::vector<std::int32_t>& integers(Columns& columns, const std::string& name) {
  return std::get<std::vector<std::int32_t>>(find(columns, name).values);
}
inline std::vector<std::uint64_t>& hashes(Columns& columns, const std::string& name) {
  return std::get<std::vector<std::uint64_t>>(find(columns, name).values);
}
inline double& proxy_x(Columns& columns, std::size_t tick) {
  return numbers(columns, "proxy_position")[3 * tick];
}
inline std::size_t length() {
  return lift().front().length();
}

// Returns the first tick, not before `from`, in which the frame is new if new_frame (else the same as before)
// and the state is new if new_state (else the same).
inline std::size_t tick_where(bool new_frame, bool new_state, std::size_t from = 100) {
  Columns columns = lift();
  const auto &frame = integers(columns, "frame_index"), &state = integers(columns, "state");
  for (std::size_t i = from; i < length(); ++i)
    if ((frame[i] != frame[i - 1]) == new_frame && (state[i] != state[i - 1]) == new_state) return i;
  throw std::out_of_range("no such tick");
}
inline std::size_t quiet_tick() {
  return tick_where(false, false);
}

using Change = std::function<void(Columns&)>;
inline TraceComparison compare(const Columns& baseline, const Columns& candidate,
                               const Tolerances& tolerances = {}, const Texts& configuration = {}) {
  return compare_traces(ColumnsInMemory(baseline), ColumnsInMemory(candidate), tolerances, configuration);
}
inline TraceComparison after(const Change& change, const Tolerances& tolerances = {},
                             const Texts& configuration = {}) {
  Columns candidate = lift();
  change(candidate);
  return compare(lift(), candidate, tolerances, configuration);
}
// Returns the divergence. If there is none, the test fails and a default divergence is returned.
inline Divergence divergence(const TraceComparison& comparison) {
  EXPECT_FALSE(comparison.is_same());
  EXPECT_TRUE(comparison.divergence);
  return comparison.divergence.value_or(Divergence{});
}

}  // namespace remote_touch::changed_traces
