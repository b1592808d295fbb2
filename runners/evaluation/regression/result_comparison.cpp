#include "runners/evaluation/regression/result_comparison.h"

#include <algorithm>
#include <cmath>

#include "analysis/storage/result_file.h"
#include "analysis/storage/trace_comparison.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_answer.h"

namespace remote_touch {

namespace {

ResultComparison begin(const std::string& kind, const TextAttributes& baseline,
                       const TextAttributes& candidate) {
  ResultComparison result{"baseline", "candidate", kind};
  const auto configuration = [](const TextAttributes& of) {
    const std::string text = attribute(of, "config");
    return text.empty() ? std::string("null") : text;
  };
  result.configuration = configuration_differences(configuration(baseline), configuration(candidate));
  for (const char* name : {"command", "version", "git_commit", "git_dirty", "source_digest", "compiler",
                           "flags", "isa", "program", "program_sha256", "plugins"})
    if (attribute(baseline, name) != attribute(candidate, name))
      result.provenance.push_back(std::string(name) + " " + attribute(baseline, name) + " against " +
                                  attribute(candidate, name));
  for (const ChangedInput& input :
       changed_inputs(attribute(baseline, "input_digests"), attribute(candidate, "input_digests")))
    result.provenance.push_back("input " + input.path + " " + input.before + " against " + input.now);
  return result;
}

void conclude(ResultComparison& result, Outcome outcome, std::string verdict) {
  result.outcome = outcome;
  result.verdict = std::move(verdict);
}

// "max_sink, max_float and 3 more"; `most` names are listed.
std::string first_of(std::vector<std::string> names, std::size_t most) {
  const std::size_t more = names.size() - std::min(names.size(), most);
  names.resize(names.size() - more);
  return joined(names, ", ") + (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

// Returns the measures of two traces that differ, or of two sweeps, that are judged so.
std::vector<std::string> judged_as(Judgement judgement, const ResultComparison& comparison) {
  std::vector<std::string> names;
  for (const ValueComparison& measure : comparison.measures)
    if (measure.judgement == judgement) names.push_back(measure.name);
  if (comparison.sweep && comparison.sweep->problems.empty())
    for (std::size_t i = 0; i < comparison.sweep->measures.size(); ++i)
      if (judgement_of(*comparison.sweep, i, comparison.paired) == judgement)
        names.push_back(comparison.sweep->measures[i].name);
  return names;
}

// "; worse: force_noise; better: max_sink, max_float"; empty where every measure is equal or within a margin.
std::string judgements_text(const ResultComparison& result) {
  std::string text;
  for (const Judgement judgement :
       {Judgement::worse, Judgement::better, Judgement::changed, Judgement::undecided})
    if (const auto names = judged_as(judgement, result); !names.empty())
      text += std::string("; ") + name_of(judgement) + ": " + first_of(names, 4);
  return text;
}

Outcome difference_of(const ResultComparison& result, bool some_failed) {
  return some_failed || !judged_as(Judgement::worse, result).empty() ? Outcome::regressed : Outcome::changed;
}

void judge_columns(ResultComparison& result) {
  const std::vector<ColumnComparison>& columns = result.columns->columns;
  std::vector<std::string> failed;
  std::size_t rows = 0;
  bool exact = true;
  for (const ColumnComparison& column : columns) {
    if (!column.is_same()) failed.push_back(column.name);
    rows = std::max(rows, column.rows);
    exact &= !column.first_difference;
  }
  if (rows == 0) return conclude(result, Outcome::not_comparable, "nothing was compared");
  if (failed.empty())
    return conclude(result, Outcome::same,
                    std::to_string(columns.size()) + " columns, " +
                        (exact ? "every number is the same" : "every number is within its tolerance"));
  std::string text = first_of(failed, 1) + " of " + std::to_string(columns.size()) + " columns";
  if (const auto& first = result.columns->divergence)
    text += ", from tick " + std::to_string(first->tick) + " on (" + name_of(first->cause) + ")";
  if (const ColumnComparison& first = columns.front(); first.baseline_rows != first.candidate_rows)
    text += "; the baseline has " + std::to_string(first.baseline_rows) + " rows, the candidate " +
            std::to_string(first.candidate_rows) +
            (result.columns->divergence ? "" : ", and the common rows are the same");
  if (!result.no_measures.empty()) text += "; no measures: " + result.no_measures;
  if (!result.not_judged.empty()) text += "; " + result.not_judged;
  conclude(result, difference_of(result, false), text + judgements_text(result));
}

// Throws InputError for a tolerance that is of no column or measure: a misspelt one would leave its column
// exact without a message.
void check_names(const Tolerances& tolerances, const std::vector<std::string>& names,
                 const Directions& measures = {}) {
  for (const auto& [name, tolerance] : tolerances) {
    if (name == "*" || measures.contains(name) || std::find(names.begin(), names.end(), name) != names.end())
      continue;
    throw InputError("tolerance of " + name, "there is no such column: expected " + joined(names, ", ") +
                                                 (measures.empty() ? "" : ", or a measure"));
  }
}

std::string exact_text(const SweepComparison& sweep) {
  if (sweep.is_equal())
    return std::to_string(sweep.done_in_both) + " runs, every measure is the same or within its tolerance";
  std::int64_t outside = 0;
  for (const MeasureComparison& measure : sweep.measures) outside = std::max(outside, measure.outside);
  return "up to " + std::to_string(outside) + " of " + std::to_string(sweep.done_in_both) +
         " runs differ in a measure, " +
         std::to_string(sweep.baseline_only.size() + sweep.candidate_only.size()) +
         " are finished in only one of the two sweeps" +
         (sweep.newly_failed == 0
              ? ""
              : ", of which " + std::to_string(sweep.newly_failed) + " failed in the candidate");
}

void judge_sweep(ResultComparison& result, const PairedRule& rule) {
  const SweepComparison& sweep = *result.sweep;
  const std::string text = exact_text(sweep), measures = judgements_text(result);
  const std::string margins = formatted("the margins (%.3g of the runs for events, %.3g for other measures)",
                                        rule.margin, rule.shift_margin);
  if (result.paired ? sweep.paired == PairedVerdict::equal : sweep.is_equal())
    return conclude(result, Outcome::same, text);
  if (result.paired && sweep.paired == PairedVerdict::within_margin)
    return conclude(result, Outcome::same, text + "; over all runs, all changes are within " + margins);
  if (result.paired && sweep.paired == PairedVerdict::undecided)
    return conclude(result, Outcome::not_comparable,
                    text + "; too few runs to be sure of " + margins + measures);
  const bool some_failed =
      sweep.newly_failed > 0 && (!result.paired || sweep.paired == PairedVerdict::runs_missing);
  conclude(result, difference_of(result, some_failed), text + measures);
}

StoredHashes hashes_of(const Hdf5Reader& result, const std::string& kind) {
  if (kind == "hashes") return read_hashes(result);
  return {hashes_of_trace(StoredTrace(result), 1), result.attributes()};
}

ResultComparison compare_by_kind(const Hdf5Reader& first_file, const Hdf5Reader& second_file,
                                 const ComparisonRules& rules) {
  const std::string ours = kind_of(first_file), theirs = kind_of(second_file);
  const auto is_trace_or_hashes = [](const std::string& kind) { return kind == "trace" || kind == "hashes"; };
  const bool hashed = ours == "hashes" || theirs == "hashes";
  if (ours != theirs && !(hashed && is_trace_or_hashes(ours) && is_trace_or_hashes(theirs)))
    throw InputError(second_file.file(), "is a " + theirs + ": expected a " + ours + ", as the baseline is");
  if (hashed) {
    if (!rules.tolerances.empty())
      throw InputError("tolerance of " + rules.tolerances.begin()->first,
                       "hashes are equal or not: expected with traces, sweeps and figures");
    return compare_hashes(hashes_of(first_file, ours), hashes_of(second_file, theirs));
  }
  if (ours == "figure")
    return compare_figure(
        StoredFigure(first_file), StoredFigure(second_file), rules,
        attribute(first_file.attributes(), "config") == attribute(second_file.attributes(), "config"));
  if (ours == "trace") {
    const StoredTrace first(first_file), second(second_file);
    return compare_trace(first, first.attributes(), second, second.attributes(), rules);
  }
  const StoredSweep first = read_stored_sweep(first_file), second = read_stored_sweep(second_file);
  return compare_sweep(first.result, first.attributes, second.result, second.attributes, rules);
}

}  // namespace

const char* name_of(Outcome outcome) {
  constexpr const char* kNames[] = {"same", "regressed", "not_comparable", "", "changed"};
  return kNames[static_cast<int>(outcome)];
}

std::string kind_of(const Hdf5Reader& result) {
  const std::string schema = attribute(result.attributes(), "schema");
  for (const char* kind : {"trace", "sweep", "figure", "hashes"})
    if (schema.starts_with(std::string("remote-touch-") + kind + "/")) return kind;
  const std::string tally = tally_refusal(result.attributes());
  throw InputError(result.file(), (!tally.empty()   ? tally
                                   : schema.empty() ? "has no attribute schema"
                                                    : "is of schema " + schema) +
                                      ": expected a trace, a sweep, a figure or hashes of this program");
}

ResultComparison compare_figure(const ColumnSource& baseline, const ColumnSource& candidate,
                                const ComparisonRules& rules, bool one_origin) {
  check_names(rules.tolerances, baseline.column_names());
  // A figure's configuration is a list of all that it ran, which is too long for a list of its differences.
  ResultComparison result = begin("figure", {}, {});
  const std::vector<std::string> differences(one_origin ? 0 : 1, "the configurations differ");
  result.columns = compare_by_name(baseline, candidate, rules.tolerances, differences);
  judge_columns(result);
  return result;
}

ResultComparison compare_hashes(const StoredHashes& baseline, const StoredHashes& candidate) {
  ResultComparison result = begin("hashes", baseline.attributes, candidate.attributes);
  const HashComparison hashes = compare_hashes(baseline.hashes, candidate.hashes);
  result.hashes = hashes;
  const std::string counted = std::to_string(hashes.compared) + " hashes compared";
  if (hashes.compared == 0)
    conclude(result, Outcome::not_comparable, "nothing was compared: no tick is in both");
  else if (hashes.is_same())
    conclude(result, Outcome::same, counted + ", all the same");
  else if (hashes.different)
    conclude(result, Outcome::changed,
             counted + "; the first divergent tick is after " +
                 (hashes.same ? "tick " + std::to_string(*hashes.same) : "none") + " and not after tick " +
                 std::to_string(*hashes.different));
  else
    conclude(result, Outcome::changed, counted + ", all the same, but one run is longer");
  return result;
}

namespace {

// --- the measures of two traces that differ ---

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
void unjudge(ResultComparison& result, const std::string& why, Shows&& shows) {
  bool any = false;
  for (ValueComparison& measure : result.measures)
    if (!shows(measure.name) && measure.judgement != Judgement::equal)
      any |= measure.judgement != Judgement::changed, measure.judgement = Judgement::changed;
  if (any && result.not_judged.empty()) result.not_judged = why;
}

// The mean time between two ticks, s; none if the trace does not state it.
std::optional<double> tick_s(const ColumnSource& trace, std::size_t& ticks) {
  if (!trace.has("time")) return std::nullopt;
  const Column time = trace.column("time");
  const auto* time_s = std::get_if<std::vector<double>>(&time.values);
  if (!time_s || time_s->size() < 2) return std::nullopt;
  ticks = time_s->size();
  return (time_s->back() - time_s->front()) / static_cast<double>(ticks - 1);
}

// "the baseline has a tick every 1 ms, the candidate every 2 ms": runs of as many ticks, but of another
// duration, whose measures say nothing about each other. Empty if the ticks are equally far apart, if the
// runs have other numbers of ticks, or if one does not state its times.
std::string tick_difference(const ColumnSource& baseline, const ColumnSource& candidate) {
  std::size_t before = 0, now = 0;
  const auto a = tick_s(baseline, before), b = tick_s(candidate, now);
  constexpr double kRounding = 1e-9;  // relative; a time is a tick's number over the rate, exact to 1e-16
  if (!a || !b || before != now || !(std::abs(*a - *b) > kRounding * std::abs(*a))) return {};  // NaN, too
  return formatted("the baseline has a tick every %.6g ms, the candidate every %.6g ms", 1e3 * *a, 1e3 * *b);
}

// Compares the measures of the catalog in use that both traces have, in its order. A stored trace has no
// measures of settled contact, which need more than its columns. There are no measures if one of the traces
// lacks a column, or if they differ in length. Measures are only judged as changed
// - if the experiments differ and one of the runs drew random numbers: one run of each shows no direction,
// - if the outcomes of the runs differ, see is_outcome(), except the outcomes,
// - if a run has no contact and the measure needs one, see needs_contact().
// The attributes of each trace hold its configuration, which determines how far its proxy may lie behind the
// surface. If this program cannot read it, the measures that depend on this are NaN. Holds one trace at a
// time.
void compare_measures(const ColumnSource& baseline, const TextAttributes& baseline_attributes,
                      const ColumnSource& candidate, const TextAttributes& candidate_attributes,
                      const Tolerances& tolerances, ResultComparison& result) {
  result.no_measures = tick_difference(baseline, candidate);
  if (!result.no_measures.empty()) return;
  const auto before = measured(baseline, baseline_attributes);
  const auto now = before ? measured(candidate, candidate_attributes) : std::nullopt;
  if (!now || now->ticks != before->ticks || now->ticks == 0) {
    result.no_measures = "a column is missing, or the runs are not of one length";
    return;
  }
  for (std::size_t i = 0; i < measures().size(); ++i) {
    const Measure& measure = measures()[i];
    const std::optional<double>&b = before->values[i], &c = now->values[i];
    if (!b || !c) continue;
    const Tolerance tolerance = tolerance_of(tolerances, measure.name);
    const bool is_unknown = needs_held_depth(measure.name) && (before->lacks_outcome || now->lacks_outcome);
    result.measures.push_back(
        {measure.name, measure.unit, measure.better, tolerance, *b, *c,
         is_unknown ? Judgement::changed : judge_value(*b, *c, measure.better, tolerance)});
  }
  const bool is_known = !before->lacks_outcome && !now->lacks_outcome;
  if (is_known && !result.configuration.empty() && (before->is_random || now->is_random))
    unjudge(result, "one run of each shows no direction, because they drew random numbers",
            [](const std::string&) { return false; });
  for (const ValueComparison& measure : result.measures)
    if (is_outcome(measure.name) && measure.judgement != Judgement::equal) {
      if (result.not_judged.empty())
        result.not_judged = text_of_outcome(measure) + ": the other measures are not judged";
      unjudge(result, "", is_outcome);
      break;
    }
  if (!before->has_contact || !now->has_contact)
    unjudge(result, "a run without contact: measures that need one are not judged",
            [](const std::string& name) { return !needs_contact(name); });
}

}  // namespace

ResultComparison compare_trace(const ColumnSource& baseline, const TextAttributes& baseline_attributes,
                               const ColumnSource& candidate, const TextAttributes& candidate_attributes,
                               const ComparisonRules& rules) {
  std::vector<std::string> names = baseline.column_names();
  std::erase(names, std::string(kRunningHash));  // follows from the others
  check_names(rules.tolerances, names, directions());
  ResultComparison result = begin("trace", baseline_attributes, candidate_attributes);
  result.columns = compare_traces(baseline, candidate, rules.tolerances, result.configuration);
  if (!result.columns->is_same())
    compare_measures(baseline, baseline_attributes, candidate, candidate_attributes, rules.tolerances,
                     result);
  judge_columns(result);
  return result;
}

namespace {

// Returns the streams of runs that draw where one of the two sweeps draws.
CellStreams streams_of_both(const SweepResult& baseline, const TextAttributes& baseline_attributes,
                            const SweepResult& candidate, const TextAttributes& candidate_attributes) {
  CellStreams both = streams_of(baseline, attribute(baseline_attributes, "config"));
  const CellStreams other = streams_of(candidate, attribute(candidate_attributes, "config"));
  if (other.draws.size() != both.draws.size()) return both;  // they are not comparable
  const bool is_same = both.noise_cell == other.noise_cell && both.seed == other.seed;
  for (std::size_t cell = 0; cell < both.draws.size(); ++cell) {
    both.draws[cell].of_cell |= other.draws[cell].of_cell;
    both.draws[cell].of_replicate |= other.draws[cell].of_replicate || (!is_same && both.draws[cell].of_cell);
  }
  return both;
}

}  // namespace

ResultComparison compare_sweep(const SweepResult& baseline, const TextAttributes& baseline_attributes,
                               const SweepResult& candidate, const TextAttributes& candidate_attributes,
                               const ComparisonRules& rules) {
  ResultComparison result = begin("sweep", baseline_attributes, candidate_attributes);
  result.paired = rules.paired;
  result.sweep = compare(baseline, candidate, rules.tolerances, rules.rule, directions(),
                         {streams_of_both(baseline, baseline_attributes, candidate, candidate_attributes),
                          !result.configuration.empty()});
  for (const std::string& difference : result.configuration) {
    if (difference.starts_with("experiment.seed "))
      result.sweep->problems.push_back(difference + ": the runs had different noise and cannot be paired");
    if (difference.starts_with("experiment.duration_s "))
      result.sweep->problems.push_back(difference + ": measures of another duration cannot be compared");
  }
  const std::vector<std::string> known = names_of(baseline.measures);
  for (const Column& measure : candidate.measures)
    if (!result.configuration.empty() && std::find(known.begin(), known.end(), measure.name) == known.end())
      result.sweep->problems.push_back("measure " + measure.name + ": the baseline has none");
  if (!result.sweep->problems.empty())
    conclude(result, Outcome::not_comparable, result.sweep->problems.front());
  else
    judge_sweep(result, rules.rule);
  return result;
}

ResultComparison compare_results(const Hdf5Reader& baseline, const Hdf5Reader& candidate,
                                 const ComparisonRules& rules) {
  ResultComparison result = compare_by_kind(baseline, candidate, rules);
  result.baseline = baseline.file(), result.candidate = candidate.file();
  return result;
}

}  // namespace remote_touch
