// The report of a scorecard: its evaluation from finished runs, and its summaries.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/trace/force_measures.h"
#include "core/kernels/kernels.h"
#include "runners/evaluation/scorecard/benchmark.h"
#include "runners/evaluation/scorecard/scorecard.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

// The stored numbers of a scorecard: counts of successes and means of judged measures, each with its
// interval. A later card is compared with them.

// The scene, method and noise level that a number of a card belongs to. noise_m: NaN for a scene's own noise.
struct CardCell {
  std::string scene, method;
  double noise_m = 0;
};

struct CardNumbers {
  struct Count {
    CardCell cell;
    Proportion successes;
  };
  struct Mean {
    CardCell cell;
    std::string measure, units;
    Estimate value;  // NaN if no run succeeded; the interval is NaN also for one run
  };
  std::vector<Count> counts;
  std::vector<Mean> means;
};

enum class KeptMeasures { judged, all };
CardNumbers numbers_of(const Scorecard& card, KeptMeasures kept);

// Returns the values of the named column. Throws std::out_of_range if the table has no such column, or if it
// has another type than List or another length than the first column.
template <class List>
const List& values_of(const Table& table, const std::string& name) {
  for (const Column& column : table.columns) {
    if (column.name != name) continue;
    const auto* values = std::get_if<List>(&column.values);
    if (values && values->size() == table.columns.front().length()) return *values;
    break;
  }
  throw std::out_of_range("table " + table.name + " has no usable column " + name);
}

// A row of a table. Throws as values_of().
struct TableRow {
  const Table* table;
  std::size_t row;

  std::string text(const char* name) const { return values_of<std::vector<std::string>>(*table, name)[row]; }
  double number(const char* name) const { return values_of<std::vector<double>>(*table, name)[row]; }
  std::int32_t count(const char* name) const {
    return values_of<std::vector<std::int32_t>>(*table, name)[row];
  }
};
// Returns the rows of a table by a column of texts. Throws as values_of().
std::vector<TableRow> rows_by(const Table& table, const char* text_column);

// Adds to the table a column of numbers without unit, counts or texts: value(row) of each row.
template <class Row, class Value>
void add_column(Table& table, const std::vector<Row>& rows, std::string name, std::string meaning,
                Value value) {
  std::vector<std::decay_t<std::invoke_result_t<Value, const Row&>>> values;
  for (const Row& row : rows) values.push_back(std::invoke(value, row));
  table.add(std::move(name), "1", std::move(meaning), std::move(values));
}

// Conversion to two tables and back. numbers_in throws std::out_of_range if a table lacks one of the columns,
// or has one of another type or length.
Table counts_table(const CardNumbers& numbers);
Table means_table(const CardNumbers& numbers);
CardNumbers numbers_in(const Table& counts, const Table& means);

// Returns a sentence for each number of the new card that does not agree with the stored one:
// - another number of successes, or of runs,
// - a mean that differs by more than a thousandth,
// - a mean that is missing, and a number that is not stored at all.
// Stored numbers that the new card lacks are not compared. Both cards use the same seeds, so equal programs
// have equal numbers and no difference is due to chance.
std::vector<std::string> differences(const CardNumbers& stored, const CardNumbers& now);

enum class Mark { none, best, worst };
Mark mark_of(const Ranking& ranking, std::size_t method);

// A scene counts as held if more than this fraction of its runs with noise are successes.
inline constexpr double kHeldFraction = 0.9;

// Results of one method over all scenes.
struct MethodSummary {
  int held = 0, best = 0, worst = 0;  // numbers of scenes
  // Mean over the scenes of the fraction of successes, with the interval of estimated_fraction(), as if the
  // scenes were drawn from all possible scenes: for runs with noise, for runs without noise, and for runs
  // with noise by the previous rule. The clusters are the scenes.
  Estimate success, noise_free, old_success;
};
std::vector<MethodSummary> overview(const Scorecard& card);

// Returns which of a card's methods is the one of this project, whose weaknesses behind_table() lists:
// tracked-sheet, or slave-region on a card of teleoperation; tracked-sheet if the card has neither.
std::string own_method(const std::vector<std::string>& methods);

// Something in which a method is behind another one.
struct Weakness {
  std::string scene, what, units;  // "success", "success without noise", or a measure
  std::string other;               // the best of the methods that are ahead
  int ahead = 0;                   // number of methods that are ahead
  double own_mean = 0, other_mean = 0;
  double p = 0;  // corrected for all comparisons of the card; NaN: not tested, as without noise
  bool is_significant = false;  // true if the difference is more than chance
};
// Returns first everything in which other methods are better by more than chance. Then follow the scenes in
// which others succeed more often with noise, but not by more than chance, and those in which others succeed
// more often without noise. Both parts are in the order of the scenes. Empty for a method that the card does
// not have.
std::vector<Weakness> weaknesses(const Scorecard& card, const std::string& method);

// Tables of a result: "overview", with a row for each method, and "behind", with a row for each weakness of
// own_method().
Table overview_table(const Scorecard& card);
Table behind_table(const Scorecard& card);

// Number of runs of one method whose measure is below its threshold, over all scenes that report the measure.
// Only successful runs in which the measure is a number count: a run that lost the surface has no force to
// compare. Runs that are one and the same count once, as in Proportion.
struct ThresholdCounts {
  int scenes = 0;           // scenes with at least one such run with noise
  int below = 0, runs = 0;  // runs with noise, a scene's own included
  int noise_free_below = 0, noise_free_runs = 0;
};

struct ThresholdSummary {
  PerceptionThreshold threshold;
  std::vector<ThresholdCounts> methods;  // one for each method of the card
};

// Returns the thresholds that any scene of the card has, in the order of perception_thresholds().
std::vector<ThresholdSummary> threshold_summary(const Scorecard& card);

// Table "thresholds" of a result, with a row for each threshold and method.
Table thresholds_table(const Scorecard& card);

// Makes the report of a scorecard from its finished runs.

// The cost of renderers: wall-clock time of ticks and frames on this machine. It varies from run to run, so
// it is stored apart from all results.
struct Cost {
  std::string scene, method;
  double tick_s = 0;   // mean of a tick
  double frame_s = 0;  // mean of on_frame(); NaN without frames
};
inline constexpr std::size_t kCostLevel = 3;  // measured at this index in scorecard_noise_m(): 0.6 r_c

// The costs are stored in a JSON file beside the results, so that scorecard.json of a finished scorecard does
// not change. origin: build, instruction set and processor; costs of another origin are not read, nor
// are those of runs that ended with an error. read_costs() returns none for a file that does not exist or
// cannot be used.
void write_costs(const std::filesystem::path& file, const std::vector<Cost>& costs,
                 const TextAttributes& origin);
std::vector<Cost> read_costs(const std::filesystem::path& file, const TextAttributes& origin);

// A typical failure of each method in each scene, run again as a full trace.
struct FailureTrace {
  std::size_t level = 0;  // lowest noise level with a failure
  int replicate = 0;
  std::string file;     // relative to the scorecard's folder; empty: the run ended with an error, no trace
  std::string command;  // command that makes the trace, to be run in that folder
  std::string error = {};
  std::string page = {};  // page that shows the trace, relative to the folder; empty: not requested
};

// The results of a scorecard's runs: its numbers, failures, costs and the audit of passivity.
struct ScorecardReport {
  Scorecard card;
  int replicates = 0;
  std::string origin;  // program and version
  // Scenes that could not be run here, and why.
  std::vector<std::pair<std::string, std::string>> skipped;
  std::vector<std::vector<std::optional<FailureTrace>>> failures;  // one for each scene and method
  std::vector<Cost> costs;
  // The passivity scenes with every force law, if they were run; its methods are the laws.
  std::optional<Scorecard> audit;
  std::string cpu = {};  // processor on which the costs were measured
};

// Returns a sentence: the best and the worst method by successes, or that none differs from another.
std::string verdict(const Scorecard& card, const SceneScore& scene);

// Medians over the scenes in which both the method and the reference were measured; NaN where there are none.
struct CostSummary {
  double tick_ratio, frame_ratio;  // fractions of the reference's time
  double tick_s, frame_s;
};
// The chapter 4 proxy, or the first method. pre: there is a method.
std::string cost_reference(const Scorecard& card);
std::vector<CostSummary> cost_summary(const Scorecard& card, const std::vector<Cost>& costs);

// The energy that a hand got from a force law at one noise level.
struct EnergySummary {
  Estimate per_cycle_J;
  double per_update_J;  // mean from one frame update to the next
};
// Returns the energies by law and level in a scene of the audit. None if the scene does not measure energy.
std::optional<std::vector<std::vector<EnergySummary>>> energies(const SceneScore& scene);

// The scores of all scenes, with comparisons corrected for each other. pre: do_sweeps() has finished.
Scorecard scores_of(const BenchmarkPlan& plan);

// Reads all runs, scores them, traces typical failures and measures the costs that no earlier call measured.
// progress: number of scenes done, and of all. Throws Interrupted. pre: do_sweeps() has finished.
ScorecardReport evaluate(const BenchmarkPlan& plan, const Kernels& kernels, const std::atomic<bool>* stop,
                         const std::function<void(std::size_t, std::size_t)>& progress);

// The folder of a scorecard: its runs, traces of failures, and results.

inline constexpr const char* kScorecardFile = "scorecard.h5";

// Makes the folder with its subfolders. Throws InputError.
void make_scorecard_folder(const std::string& folder);

// Throws InputError unless the plan has every method and scene of the scorecard in that file, because results
// are replaced. Does nothing if the file does not exist.
void require_all_of(const std::filesystem::path& file, const BenchmarkPlan& plan);

// Returns the command that makes a scorecard of these.
std::string scorecard_command(const std::vector<std::string>& methods, const std::vector<std::string>& scenes,
                              int seeds);

// Writes the HDF5 file and the JSON file of the scorecard. Returns the digest.
std::string write_scorecard(const std::filesystem::path& folder, const BenchmarkPlan& plan,
                            const ScorecardReport& report, const std::string& command);

// A scorecard's numbers in a small sealed file of data/, with which a later card is compared.

inline constexpr const char* kStoredCardFigure = "stored-scorecard";

struct StoredCard {
  std::string configuration;  // methods and scenes as JSON, see configuration()
  int replicates = 0;
  std::vector<std::string> methods, scenes;  // names in it
  CardNumbers numbers;
};

// Returns the digest. provenance: config must be the card's configuration().
std::string write_stored_card(const std::filesystem::path& file, const Scorecard& card,
                              const TextAttributes& provenance);
// Throws InputError if the file is not a stored card.
StoredCard read_stored_card(const std::filesystem::path& file);

// Returns the results of the stored card as Markdown: first those in which the project's own method is not
// the best, then all methods, with the runs below each threshold of perception. Throws InputError
// if the file is not a stored card.
std::string stored_summary(const std::filesystem::path& file);

// Returns a sentence for each method and scene of the plan that is not in the stored card, or is defined in
// another way there, and for each number that does not agree, see differences() of numbers. plan: without
// scenes that were skipped.
std::vector<std::string> differences(const StoredCard& stored, const BenchmarkPlan& plan,
                                     const Scorecard& now);

// Returns the configuration() of the parts that a plan runs: without scenes whose recording is not on this
// machine.
std::string configuration_of(const BenchmarkPlan& plan);

// scorecard.json: the data from which scripts/plot makes the page of a scorecard. It contains all decisions
// (which method is marked, which words a verdict has); a page only formats them.

inline constexpr const char* kScorecardSchema = "remote-touch-scorecard/5";

// SI units, null for a number that is missing. The lists "methods" and "laws" have the same order everywhere.
std::string to_json(const ScorecardReport& report);

// Returns the tables of a stored card as JSON, for its page: a list of rows for each table, and what the
// numbers depend on. SI units, null for a number that is missing. Throws InputError if the file is not a
// stored card.
inline constexpr const char* kStoredCardSchema = "remote-touch-stored-scorecard/1";
std::string stored_json(const std::filesystem::path& file);

}  // namespace remote_touch
