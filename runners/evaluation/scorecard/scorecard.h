// A scorecard: the results of each method in each scene, at each noise level, with intervals, and which
// methods are significantly best or worst.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/result_file.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"

namespace remote_touch {

// Methods ranked by a measure, and whether the first and the last differ significantly from all others.

// One method's values of a measure. values[i][k] belongs to noise level i and replicate k, which has the same
// noise for every method; NaN if there is none.
using PairedValues = std::vector<std::vector<double>>;

// The runs of one method that are not independent of each other.
struct SharedRuns {
  // True for each noise level whose replicates are all one and the same run, as without noise. They then
  // count once. An empty list means that no level repeats.
  std::vector<bool> repeats = {};
  // True if a random number is drawn for each replicate, as the error of the registration is, and not for
  // each level and replicate: the runs of a replicate are then one cluster.
  bool by_replicate = false;
};
PairedValues distinct(const PairedValues& values, const SharedRuns& shared);
// Returns the values that are not NaN as independent clusters. A cluster has one value, or all values of a
// replicate if shared.by_replicate.
std::vector<std::vector<double>> clusters_of(const PairedValues& values, const SharedRuns& shared);
// Fraction of the values that are 1.
Estimate fraction_of(const std::vector<std::vector<double>>& clusters);
// Mean of the values, see estimated_mean(); of the clusters' means if runs are shared by replicate.
Estimate mean_of(const PairedValues& values, const SharedRuns& shared);

// Minimum number of pairs for a verdict, and of values of a measure for a rank by it.
inline constexpr std::int64_t kMinPairs = 12;
// A difference is more than chance if the p value, corrected for all comparisons of the card, is at most
// this.
inline constexpr double kSignificance = 0.05;

// Comparison of one method with another, over the pairs in which both have a number.
struct MethodComparison {
  double p = std::numeric_limits<double>::quiet_NaN();  // two-sided; NaN: fewer than kMinPairs
  bool has_better_mean = false;                         // true: the first is better in the mean of the pairs
  bool is_skewed = false;                               // few large differences decide: no verdict

  bool shows_better() const { return has_better_mean && !is_skewed && p <= kSignificance; }
};

struct Ranking {
  std::vector<std::size_t> order;  // methods, the best first by their own means; unranked ones last
  std::size_t ranked = 0;          // number of methods with kMinPairs values, or any value of an event
  std::vector<Estimate> mean;      // mean of each method
  // [a][b]: of method a with b. Empty for a measure that is only reported.
  std::vector<std::vector<MethodComparison>> against = {};
  // has_best: the first is better than all other ranked methods. has_worst: all of them are better than the
  // last. Each difference must be more than chance.
  bool has_best = false, has_worst = false;
  // The first, and the methods that it is not shown to be better than.
  std::vector<std::size_t> top_group = {};
};

// event: true if all values are 0 or 1. Two methods are then compared by estimated_event_difference(), else
// by estimated_difference(). A pair counts if both methods have a number: use NaN if a run did not do what is
// measured. A level at which both methods repeat one run is one pair. near_zero compares magnitudes. shared:
// one entry for each method; empty if no method shares runs.
Ranking ranking(const std::vector<PairedValues>& methods, Better better, bool event,
                const std::vector<SharedRuns>& shared = {});

// Corrects the p values of all these rankings together by Holm's method, and decides anew. The probability
// that any "better" among them is due to chance is then at most kSignificance. Returns the number of tests.
std::int64_t correct_together(const std::vector<Ranking*>& rankings);

// The scenes of a scorecard, scored by rules.

// A bound on a measure of a run; success means that all its bounds hold.
struct Bound {
  std::string measure;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();

  bool holds(double value) const { return value >= min && value <= max; }  // never for NaN
};

// Returns for each run whether all bounds hold; false for runs that failed. Throws std::out_of_range for a
// measure that the sweep does not have. pre: no run is pending.
std::vector<bool> successes(const SweepResult& result, const std::vector<Bound>& bounds);

// Returns the run that is a typical failure of a cell: the median of its unsuccessful runs, ordered by the
// first bound that they break and then by the value of its measure, with runs that ended in an error last. -1
// if no run is unsuccessful.
long typical_failure(const SweepResult& result, const std::vector<Bound>& bounds, std::size_t cell);

// A fraction of runs with its interval, see estimated_fraction(); runs that are one and the same (SharedRuns)
// count once. Without runs the fraction is NaN and the interval is [0, 1].
struct Proportion {
  int events = 0, runs = 0;
  double fraction = 0, low = 0, high = 1;
};

struct JudgedMeasure {
  std::string name, units;
  Better better = Better::neither;
  // The ranking is over all levels with noise. A judged measure uses the successful runs only, and two
  // methods are compared in the pairs in which both succeeded. A measure that is only reported
  // (Better::neither) uses all runs.
  Ranking ranking = {};
  // Mean of each method at each noise level, see estimated_mean().
  std::vector<std::vector<Estimate>> at_level = {};
};

// Number of successes of a method by one rule. Runs without noise are not mixed with the others: most of them
// repeat one run, which shows nothing about chance.
struct Successes {
  std::vector<Proportion> at_level;
  Proportion noisy;                      // over all levels with noise, a scene's own included
  std::optional<Proportion> noise_free;  // absent in a scene with its own noise
};

// The runs of a scene in which a measure is below its published threshold, see force_measures.h. Only
// successful runs in which the measure is a number count.
struct SceneThreshold {
  std::string measure;
  std::vector<Successes> below;  // one entry per method: its events are the runs below the threshold
};

struct SceneScore {
  std::string name, title, meaning;    // meaning: the condition for success, in words
  std::vector<double> noise_m;         // one per level; a single NaN: the scene's own
  std::vector<Successes> success;      // one entry per method
  std::vector<Successes> old_success;  // successes by the previous rule; empty without one
  Ranking ranking;                     // ranking by success, over all levels with noise
  std::vector<JudgedMeasure> measures;
  std::string truth = {};  // the true surface of a recorded scene, in words; empty for a simulated scene
  // One entry for each measure of the scene that has a threshold of perception.
  std::vector<SceneThreshold> thresholds = {};
};

struct Scorecard {
  std::vector<std::string> methods, method_titles;
  std::vector<SceneScore> scenes;
  // The number of comparisons that are corrected together, and of the pairs that one of them needs at least
  // to be significant; see correct().
  std::int64_t tests = 0, least_pairs = kMinPairs;
};

struct SceneRules {
  std::string name, title, meaning;
  std::vector<Bound> success;
  std::vector<std::pair<std::string, Better>> measures;
  std::vector<Bound> old_success = {};  // the previous rule; empty without one
  // True for a method whose runs draw random numbers that are the same at all levels of a replicate, see
  // SharedRuns::by_replicate. Empty: no method does.
  std::vector<bool> by_replicate = {};
};

// Scores the finished sweeps of all methods in a scene; their one axis is the noise. own_noise: the scene has
// its own noise, which is its only level. Comparisons are not yet corrected for the others of a card. Throws
// std::out_of_range for an unknown measure.
SceneScore score(const SceneRules& rules, const std::vector<SweepResult>& sweeps, bool own_noise);

// Corrects all comparisons of the card together, see correct_together().
void correct(Scorecard& card);

inline constexpr const char* kScorecardFigure = "scorecard";  // name of scorecard_figure()

// Returns the figure of the result file. Its tables are success, measures and standings, with a row for each
// scene, method, and level or measure; overview, behind and thresholds, see evaluation.h; and the curves of
// every scene's panel.
Figure scorecard_figure(const Scorecard& scorecard);

}  // namespace remote_touch
