// A scorecard: the results of each method in each scene, at each noise level, with intervals, and which
// methods are significantly best or worst.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/result_file.h"
#include "analysis/sweeps/sweep_result.h"
#include "runners/evaluation/scorecard/ranking.h"

namespace remote_touch {

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
// scene, method, and level or measure; overview and behind, see card_summaries.h; thresholds, see
// card_summaries.h; and the curves of every scene's panel.
Figure scorecard_figure(const Scorecard& scorecard);

}  // namespace remote_touch
