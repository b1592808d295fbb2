// Comparison of two results, traces, sweeps, figures or the running hashes of traces, and its report.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/trace_comparison.h"
#include "analysis/sweeps/sweep_comparison.h"

namespace remote_touch {

// The exit codes of compare. Regressed: a measure got worse, or a run of a sweep that was done in the
// baseline failed. Changed: anything else differs, also if it is better. Figures and hashes have no measures,
// so they can only be changed.
enum class Outcome { same = 0, regressed = 1, not_comparable = 2, changed = 4 };
const char* name_of(Outcome outcome);  // "same", "regressed", ...

struct ComparisonRules {
  Tolerances tolerances = {};  // tolerances of columns, or of a sweep's measures
  bool paired = false;         // judge sweeps by the paired tests (sweep_comparison.h), not run by run
  PairedRule rule = {};
};

struct ResultComparison {
  std::string baseline, candidate;              // names, for display
  std::string kind;                             // trace, sweep, figure, hashes
  std::vector<std::string> configuration = {};  // differences of the experiments
  std::vector<std::string> provenance = {};     // differences of the builds: reported, not judged
  std::optional<TraceComparison> columns = {};  // set for traces and figures
  std::vector<ValueComparison> measures = {};   // set for traces that differ
  std::string no_measures = {};                 // why there are none although the traces differ
  std::string not_judged = {};                  // why only some of them, or none, are judged
  std::optional<SweepComparison> sweep = {};
  bool paired = false;  // the sweep was judged by the paired tests
  std::optional<HashComparison> hashes = {};
  Outcome outcome = Outcome::not_comparable;
  std::string verdict = {};  // one line
};

// "trace", "sweep", "figure" or "hashes", from the schema; the reader refuses another version. Throws
// InputError for any other file.
std::string kind_of(const Hdf5Reader& result);

// Throws InputError for files that cannot be read or are of different kinds (but hashes may be compared with
// a trace), and for tolerances of unknown columns or of hashes.
ResultComparison compare_results(const Hdf5Reader& baseline, const Hdf5Reader& candidate,
                                 const ComparisonRules& rules);
inline ResultComparison compare_results(const std::filesystem::path& baseline,
                                        const std::filesystem::path& candidate,
                                        const ComparisonRules& rules) {
  return compare_results(Hdf5Reader(baseline), Hdf5Reader(candidate), rules);
}

// Compares traces from any source; a tolerance may also be one of a measure. The attributes hold
// configuration and provenance of each.
ResultComparison compare_trace(const ColumnSource& baseline, const TextAttributes& baseline_attributes,
                               const ColumnSource& candidate, const TextAttributes& candidate_attributes,
                               const ComparisonRules& rules);

// Tables of figures, columns named table/column. one_origin: true if both have the same configuration.
ResultComparison compare_figure(const ColumnSource& baseline, const ColumnSource& candidate,
                                const ComparisonRules& rules, bool one_origin);

ResultComparison compare_hashes(const StoredHashes& baseline, const StoredHashes& candidate);

ResultComparison compare_sweep(const SweepResult& baseline, const TextAttributes& baseline_attributes,
                               const SweepResult& candidate, const TextAttributes& candidate_attributes,
                               const ComparisonRules& rules);

// Returns the report of a comparison. As text: the verdict, the first difference, what happens in only one of
// two runs, then tables. As JSON: {"outcome", "verdict", "kind", "columns": [...], "divergence": {...}, ...}.
// Its test cases: one for each column or measure, and one for the whole. A measure that got worse is a
// failure. Any other difference is "skipped", so that nobody mistakes it for a failure or for a pass, and its
// text describes it. A comparison that was not possible or not decided is an error.
Report report_of(const ResultComparison& comparison);

// The fewest digits that state the number exactly: "0.033", not "0.033000000000000002".
std::string shortest_text(double number);

}  // namespace remote_touch
