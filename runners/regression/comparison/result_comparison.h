// Comparison of two results: traces, sweeps, figures, or the running hashes of traces.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/comparison/sweep_comparison.h"
#include "analysis/comparison/tick_hashes.h"
#include "analysis/comparison/trace_comparison.h"
#include "analysis/storage/hdf5_reader.h"

namespace remote_touch {

// The exit codes of compare.
enum class Outcome { same = 0, regressed = 1, not_comparable = 2 };

struct ComparisonRules {
  Tolerances tolerances = {};  // of columns, or of a sweep's measures
  bool paired = false;         // judge sweeps by the paired tests (sweep_comparison.h), not run by run
  PairedRule rule = {};
};

struct ResultComparison {
  std::string baseline, candidate;              // names for people
  std::string kind;                             // trace, sweep, figure, hashes
  std::vector<std::string> configuration = {};  // where the experiments differ
  std::vector<std::string> provenance = {};     // where the builds differ: told, not judged
  std::optional<TraceComparison> columns = {};  // of traces and figures
  std::optional<SweepComparison> sweep = {};
  bool paired = false;  // how the sweep was judged
  std::optional<HashComparison> hashes = {};
  Outcome outcome = Outcome::not_comparable;
  std::string verdict = {};  // one line
};

// "trace", "sweep", "figure" or "hashes", as the schema says; another version is for its reader to refuse.
// Throws InputError for any other file.
std::string kind_of(const Hdf5Reader& result);

// Throws InputError for files that cannot be read or are of different kinds (but hashes go with traces), and
// for tolerances of columns that there are not; hashes have none.
ResultComparison compare_results(const std::filesystem::path& baseline,
                                 const std::filesystem::path& candidate, const ComparisonRules& rules);

// Of a trace and columns at hand. attributes: configuration and provenance of both.
ResultComparison compare_trace(const ColumnSource& baseline, const TextAttributes& baseline_attributes,
                               const ColumnSource& candidate, const TextAttributes& candidate_attributes,
                               const ComparisonRules& rules);

// Tables of figures, columns named table/column.
ResultComparison compare_figure(const ColumnSource& baseline, const ColumnSource& candidate,
                                const ComparisonRules& rules);

ResultComparison compare_hashes(const StoredHashes& baseline, const StoredHashes& candidate);

ResultComparison compare_sweep(const SweepResult& baseline, const TextAttributes& baseline_attributes,
                               const SweepResult& candidate, const TextAttributes& candidate_attributes,
                               const ComparisonRules& rules);

}  // namespace remote_touch
