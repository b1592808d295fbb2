// Results of sweeps, made by hand.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_comparison.h"

namespace remote_touch::made_sweeps {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Texts = std::vector<std::string>;

inline Column numbers(const std::string& name, std::size_t count, double step) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<double>(i) * step);
  return {name, "1", "scenario." + name, values};
}
inline Column names(const std::string& name, const Texts& texts) {
  std::vector<std::int32_t> places;
  for (std::size_t i = 0; i < texts.size(); ++i) places.push_back(static_cast<std::int32_t>(i));
  return {name, "1", "renderer." + name, places, 1, texts};
}

// A sweep with the measures "event" and "depth": all runs are done and all values are 0.
inline SweepResult sweep(std::vector<Column> axes, int replicates) {
  SweepResult result;
  result.axes = std::move(axes);
  result.replicates = replicates;
  result.measures = {{"event", "1", "1 when it happened", {}}, {"depth", "m", "", {}}};
  result.start(false);
  result.state.assign(result.run_count(), RunState::done);
  for (Column& measure : result.measures) measure.values = std::vector<double>(result.run_count(), 0.0);
  return result;
}
inline SweepResult row(std::size_t cells) {
  return sweep({numbers("x", cells, 1)}, 1);
}
// A sweep as large as the map of Fig 4.13: 5396 runs in nine parts of about 600.
inline SweepResult map() {
  return sweep({numbers("sigma", 76, 0.0002), numbers("acceleration", 71, 0.1)}, 1);
}

inline std::vector<double>& event(SweepResult& result) {
  return std::get<std::vector<double>>(result.measures[0].values);
}
inline std::vector<double>& depth(SweepResult& result) {
  return std::get<std::vector<double>>(result.measures[1].values);
}
inline void flip(SweepResult& a, SweepResult& b, std::size_t run, bool in_candidate) {
  event(a)[run] = in_candidate ? 0 : 1, event(b)[run] = in_candidate ? 1 : 0;
}
inline Judgement whole(const SweepComparison& comparison, std::size_t measure) {
  return comparison.at(0, measure).judgement;
}

}  // namespace remote_touch::made_sweeps
