#include "runners/evaluation/regression/result_comparison.h"

#include <algorithm>
#include <cstdio>

#include "analysis/comparison/compared_columns.h"
#include "analysis/figures/result_file.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/tally/tally_file.h"
#include "analysis/trace/column.h"
#include "analysis/trace/hash64.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/evaluation/regression/measure_comparison.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/changed_settings.h"
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

// "proxy_position and 3 more of 16 columns"
std::string count_text(const std::vector<std::string>& names, std::size_t of, const char* things) {
  std::string text = names.front();
  if (names.size() > 1) text += " and " + std::to_string(names.size() - 1) + " more";
  return text + " of " + std::to_string(of) + " " + things;
}

// "; worse: force_noise; better: max_sink, max_float"; empty where every measure is equal or within a margin.
std::string judgements_text(const ResultComparison& result) {
  constexpr std::size_t kNamed = 4;  // names that are listed for each judgement
  std::string text;
  for (const Judgement requested :
       {Judgement::worse, Judgement::better, Judgement::changed, Judgement::undecided}) {
    std::string names;
    std::size_t count = 0;
    for (const MeasureJudgement& measure : judged_measures(result))
      if (measure.judgement == requested && ++count <= kNamed)
        names += (names.empty() ? "" : ", ") + measure.name;
    if (count > kNamed) names += " and " + std::to_string(count - kNamed) + " more";
    if (count > 0) text += std::string("; ") + name_of(requested) + ": " + names;
  }
  return text;
}

bool got_worse(const ResultComparison& result) {
  for (const MeasureJudgement& measure : judged_measures(result))
    if (measure.judgement == Judgement::worse) return true;
  return false;
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
  std::string text = count_text(failed, columns.size(), "columns");
  if (const auto& first = result.columns->divergence)
    text += ", from tick " + std::to_string(first->tick) + " on (" + name_of(first->cause) + ")";
  if (const ColumnComparison& first = columns.front(); first.baseline_rows != first.candidate_rows)
    text += "; the baseline has " + std::to_string(first.baseline_rows) + " rows, the candidate " +
            std::to_string(first.candidate_rows) +
            (result.columns->divergence ? "" : ", and the common rows are the same");
  if (!result.no_measures.empty()) text += "; no measures: " + result.no_measures;
  if (!result.not_judged.empty()) text += "; " + result.not_judged;
  conclude(result, got_worse(result) ? Outcome::regressed : Outcome::changed, text + judgements_text(result));
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
  if (sweep.exact == ExactVerdict::equal)
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
  char margins[160];
  std::snprintf(margins, sizeof margins, "the margins (%.3g of the runs for events, %.3g for other measures)",
                rule.margin, rule.shift_margin);
  if (result.paired ? sweep.paired == PairedVerdict::equal : sweep.exact == ExactVerdict::equal)
    return conclude(result, Outcome::same, text);
  if (result.paired && sweep.paired == PairedVerdict::within_margin)
    return conclude(result, Outcome::same, text + "; over all runs, all changes are within " + margins);
  if (result.paired && sweep.paired == PairedVerdict::undecided)
    return conclude(result, Outcome::not_comparable,
                    text + "; too few runs to be sure of " + margins + measures);
  const bool some_failed =
      sweep.newly_failed > 0 && (!result.paired || sweep.paired == PairedVerdict::runs_missing);
  conclude(result, got_worse(result) || some_failed ? Outcome::regressed : Outcome::changed, text + measures);
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

std::vector<MeasureJudgement> judged_measures(const ResultComparison& comparison) {
  std::vector<MeasureJudgement> all;
  for (const ValueComparison& measure : comparison.measures) all.push_back({measure.name, measure.judgement});
  if (comparison.sweep && comparison.sweep->problems.empty())
    for (std::size_t i = 0; i < comparison.sweep->measures.size(); ++i)
      all.push_back(
          {comparison.sweep->measures[i].name, judgement_of(*comparison.sweep, i, comparison.paired)});
  return all;
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

ResultComparison compare_trace(const ColumnSource& baseline, const TextAttributes& baseline_attributes,
                               const ColumnSource& candidate, const TextAttributes& candidate_attributes,
                               const ComparisonRules& rules) {
  std::vector<std::string> names = baseline.column_names();
  std::erase(names, std::string(kRunningHash));  // follows from the others
  check_names(rules.tolerances, names, directions());
  ResultComparison result = begin("trace", baseline_attributes, candidate_attributes);
  result.columns = compare_traces(baseline, candidate, rules.tolerances, result.configuration);
  if (!result.columns->is_same()) {
    result.no_measures = tick_difference(baseline, candidate);
    auto measures = result.no_measures.empty()
                        ? compare_measures(baseline, baseline_attributes, candidate, candidate_attributes,
                                           rules.tolerances, result.configuration)
                        : std::nullopt;
    if (measures)
      result.measures = std::move(measures->all), result.not_judged = std::move(measures->not_judged);
    else if (result.no_measures.empty())
      result.no_measures = "a column is missing, or the runs are not of one length";
  }
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
