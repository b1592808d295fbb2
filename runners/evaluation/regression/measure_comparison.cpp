#include "runners/evaluation/regression/measure_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "analysis/measures/no_value.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"

namespace remote_touch {

namespace {

struct Measured {
  std::size_t ticks = 0;
  std::vector<std::optional<double>> values = {};  // none for a measure that does not apply
  bool lacks_outcome = false;                      // an outcome depends on a held depth that is not known
  bool is_random = true;                           // the run drew random numbers, or this is not known
  bool has_contact = false;                        // there was one in some tick
};

// Returns the experiment of a trace. Returns none if the trace stores no configuration, or if this program
// cannot read it or does not have its parts.
std::optional<Experiment> stored_experiment(const TextAttributes& trace) {
  const std::string configuration = attribute(trace, "config");
  if (configuration.empty()) return std::nullopt;
  try {
    return Experiment::from_json(configuration, "configuration");
  } catch (const InputError&) {
    return std::nullopt;
  }
}

// Returns held_depth_m() of the experiment; 0 if the trace stores none. Returns none if it is not known.
std::optional<double> held_depth_of(const TextAttributes& trace,
                                    const std::optional<Experiment>& experiment) {
  if (attribute(trace, "config").empty()) return 0;
  if (!experiment) return std::nullopt;
  try {
    return held_depth_m(experiment->rendered_contact());
  } catch (const InputError&) {
    return std::nullopt;
  }
}

// True for measures that depend on Trace::held_depth_m.
bool needs_held_depth(const std::string& measure) {
  return measure.starts_with("popped_through") || measure == "tool_popped_through" ||
         measure == "wrong_side_fraction" || measure.starts_with("first_pop_through_");
}

std::optional<Measured> measured(const ColumnSource& source, const TextAttributes& attributes) {
  auto trace = trace_of([&](const std::string& name) {
    return source.has(name) ? std::optional(source.column(name)) : std::nullopt;
  });
  if (!trace) return std::nullopt;
  const std::optional<Experiment> experiment = stored_experiment(attributes);
  const std::optional<double> held_depth_m = held_depth_of(attributes, experiment);
  trace->held_depth_m = held_depth_m.value_or(0);
  Measured result{trace->length()};
  result.is_random = !experiment || !random_streams(*experiment).is_fixed();
  for (const Measure& measure : measures()) {
    if (!applies(measure, *trace)) {
      result.values.emplace_back();
      continue;
    }
    const bool is_known = held_depth_m || !needs_held_depth(measure.name);
    const double value = measure.compute(*trace);
    result.lacks_outcome |= !is_known && is_outcome(measure.name) && !std::isnan(value);
    result.values.emplace_back(is_known ? value : kNoValue);
    result.has_contact |= measure.name == "first_contact_time" && !std::isnan(value);
  }
  return result;
}

}  // namespace

namespace {

std::string text_of_outcome(const ValueComparison& measure) {
  if (!std::isfinite(measure.baseline) && !std::isfinite(measure.candidate))
    return measure.name + " is unknown in both runs";
  if (!std::isfinite(measure.baseline) || !std::isfinite(measure.candidate))
    return measure.name + " is unknown in one run";
  if (measure.name == "popped_through") return "one run popped through";
  if (measure.name == "tool_popped_through") return "the tool of one run popped through";
  return measure.name + " differs";
}

// Judges the measures that do not show a direction as changed, unless they are equal.
template <class Shows>
void unjudge(ComparedMeasures& measures, const std::string& why, Shows&& shows) {
  bool any = false;
  for (ValueComparison& measure : measures.all)
    if (!shows(measure.name) && measure.judgement != Judgement::equal)
      any |= measure.judgement != Judgement::changed, measure.judgement = Judgement::changed;
  if (any && measures.not_judged.empty()) measures.not_judged = why;
}

}  // namespace

std::optional<ComparedMeasures> compare_measures(const ColumnSource& baseline,
                                                 const TextAttributes& baseline_attributes,
                                                 const ColumnSource& candidate,
                                                 const TextAttributes& candidate_attributes,
                                                 const Tolerances& tolerances,
                                                 const std::vector<std::string>& configuration) {
  const auto before = measured(baseline, baseline_attributes);
  const auto now = before ? measured(candidate, candidate_attributes) : std::nullopt;
  if (!now || now->ticks != before->ticks || now->ticks == 0) return std::nullopt;
  ComparedMeasures result;
  for (std::size_t i = 0; i < measures().size(); ++i) {
    const Measure& measure = measures()[i];
    const std::optional<double>&b = before->values[i], &c = now->values[i];
    if (!b || !c) continue;
    const Tolerance tolerance = tolerance_of(tolerances, measure.name);
    const bool is_unknown = needs_held_depth(measure.name) && (before->lacks_outcome || now->lacks_outcome);
    result.all.push_back({measure.name, measure.unit, measure.better, tolerance, *b, *c,
                          is_unknown ? Judgement::changed : judge_value(*b, *c, measure.better, tolerance)});
  }
  const bool is_known = !before->lacks_outcome && !now->lacks_outcome;
  if (is_known && !configuration.empty() && (before->is_random || now->is_random))
    unjudge(result, "one run of each shows no direction, because they drew random numbers",
            [](const std::string&) { return false; });
  for (const ValueComparison& measure : result.all)
    if (is_outcome(measure.name) && measure.judgement != Judgement::equal) {
      if (result.not_judged.empty())
        result.not_judged = text_of_outcome(measure) + ": the other measures are not judged";
      unjudge(result, "", is_outcome);
      break;
    }
  if (!before->has_contact || !now->has_contact)
    unjudge(result, "a run without contact: measures that need one are not judged",
            [](const std::string& name) { return !needs_contact(name); });
  return result;
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

}  // namespace remote_touch
