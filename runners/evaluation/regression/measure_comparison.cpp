#include "runners/evaluation/regression/measure_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "analysis/measures/no_value.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/stored_configuration.h"

namespace remote_touch {

namespace {

struct Measured {
  std::size_t ticks = 0;
  std::vector<std::optional<double>> values = {};  // none for a measure that does not apply
  bool lacks_outcome = false;                      // an outcome depends on a held depth that is not known
};

// Returns held_depth_m() of the configuration that a trace stores; 0 if the trace stores none. Returns none
// if this program cannot read the configuration or does not have its renderer.
std::optional<double> stored_held_depth_m(const TextAttributes& trace) {
  const std::string configuration = attribute(trace, "config");
  if (configuration.empty()) return 0;
  try {
    const std::string today = stored_configuration(configuration);
    return held_depth_m(Experiment::from_json(today, "configuration").rendered_contact());
  } catch (const InputError&) {
    return std::nullopt;
  }
}

// True for measures that depend on Trace::held_depth_m.
bool needs_held_depth(const std::string& measure) {
  return measure == "popped_through" || measure == "tool_popped_through" ||
         measure == "wrong_side_fraction" || measure.starts_with("first_pop_through_");
}

std::optional<Measured> measured(const ColumnSource& source, const TextAttributes& attributes) {
  auto trace = trace_of([&](const std::string& name) {
    return source.has(name) ? std::optional(source.column(name)) : std::nullopt;
  });
  if (!trace) return std::nullopt;
  const std::optional<double> held_depth_m = stored_held_depth_m(attributes);
  trace->held_depth_m = held_depth_m.value_or(0);
  Measured result{trace->length()};
  for (const Measure& measure : measures()) {
    if (!applies(measure, *trace)) {
      result.values.emplace_back();
      continue;
    }
    const bool is_known = held_depth_m || !needs_held_depth(measure.name);
    const double value = measure.compute(*trace);
    result.lacks_outcome |= !is_known && is_outcome(measure.name) && !std::isnan(value);
    result.values.emplace_back(is_known ? value : kNoValue);
  }
  return result;
}

}  // namespace

std::optional<std::vector<ValueComparison>> compare_measures(const ColumnSource& baseline,
                                                             const TextAttributes& baseline_attributes,
                                                             const ColumnSource& candidate,
                                                             const TextAttributes& candidate_attributes,
                                                             const Tolerances& tolerances) {
  const auto before = measured(baseline, baseline_attributes);
  const auto now = before ? measured(candidate, candidate_attributes) : std::nullopt;
  if (!now || now->ticks != before->ticks || now->ticks == 0) return std::nullopt;
  std::vector<ValueComparison> all;
  for (std::size_t i = 0; i < measures().size(); ++i) {
    const Measure& measure = measures()[i];
    const std::optional<double>&b = before->values[i], &c = now->values[i];
    if (!b || !c) continue;
    const Tolerance tolerance = tolerance_of(tolerances, measure.name);
    const bool is_unknown = needs_held_depth(measure.name) && (before->lacks_outcome || now->lacks_outcome);
    all.push_back({measure.name, measure.unit, measure.better, tolerance, *b, *c,
                   is_unknown ? Judgement::changed : judge_value(*b, *c, measure.better, tolerance)});
  }
  const bool same_outcome = std::none_of(all.begin(), all.end(), [](const ValueComparison& measure) {
    return is_outcome(measure.name) && measure.judgement != Judgement::equal;
  });
  for (ValueComparison& measure : all)
    if (!same_outcome && !is_outcome(measure.name) && measure.judgement != Judgement::equal)
      measure.judgement = Judgement::changed;
  return all;
}

namespace {

// The mean time between two ticks, s; none if the trace does not state it.
std::optional<double> tick_s(const ColumnSource& trace, std::size_t& ticks) {
  if (!trace.has("time")) return std::nullopt;
  const Column time = trace.column("time");
  const auto* time_s = std::get_if<std::vector<double>>(&time.values);
  if (!time_s || time_s->size() < 2) return std::nullopt;
  ticks = time_s->size();
  return (time_s->back() - time_s->front()) / static_cast<double>(ticks - 1);
}

std::string text_of_outcome(const ValueComparison& measure) {
  if (!std::isfinite(measure.baseline) && !std::isfinite(measure.candidate))
    return measure.name + " is unknown in both runs";
  if (!std::isfinite(measure.baseline) || !std::isfinite(measure.candidate))
    return measure.name + " is unknown in one run";
  if (measure.name == "popped_through") return "one run popped through";
  if (measure.name == "tool_popped_through") return "the tool of one run popped through";
  return measure.name + " differs";
}

}  // namespace

std::string tick_difference(const ColumnSource& baseline, const ColumnSource& candidate) {
  std::size_t before = 0, now = 0;
  const auto a = tick_s(baseline, before), b = tick_s(candidate, now);
  constexpr double kRounding = 1e-9;  // relative; a time is a tick's number over the rate, exact to 1e-16
  if (!a || !b || before != now || std::abs(*a - *b) <= kRounding * std::abs(*a)) return {};
  char text[120];
  std::snprintf(text, sizeof text, "the baseline has a tick every %.6g ms, the candidate every %.6g ms",
                1e3 * *a, 1e3 * *b);
  return text;
}

std::string outcome_difference(const std::vector<ValueComparison>& measures) {
  for (const ValueComparison& measure : measures)
    if (is_outcome(measure.name) && measure.judgement != Judgement::equal)
      return text_of_outcome(measure) + ": the other measures are not judged";
  return {};
}

}  // namespace remote_touch
