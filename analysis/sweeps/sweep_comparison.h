// Comparison of two finished sweeps of the same definition.
//
// Noise is keyed by seed, cell and replicate, so a run has the same noise in both sweeps: the two are a pair.
// If nothing changed, pairs are equal to the last bit. If something changed, runs near a limit are chaotic: a
// change of the last bit flips some of them, equally often in either direction. Therefore there are two
// verdicts: an exact one, and one by paired tests, which distinguishes such flips from a systematic change.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/columns.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"

namespace remote_touch {

// A measure of one run, in the baseline and in the candidate.
struct ValueComparison {
  std::string name, units;
  Better better = Better::neither;
  Tolerance tolerance;
  double baseline = 0, candidate = 0;
  Judgement judgement = Judgement::equal;
};

// Comparison of a measure over the runs that are done in both sweeps.
struct MeasureComparison {
  std::string name, units;
  Better better = Better::neither;
  Tolerance tolerance;
  // True if all finite values of the baseline are 0 or 1, and those of the candidate too if the baseline has
  // no 1. The fraction of ones is then a probability.
  bool event = false;
  std::int64_t compared = 0, outside = 0;
  std::int64_t got_better = 0, got_worse = 0;     // runs outside that got better or worse
  double max_deviation = 0, rms_deviation = 0;    // |candidate - baseline| where both are finite
  std::optional<std::size_t> first_outside = {};  // a run
  // The judgement run by run. Better or worse: all runs outside went that way, or the paired tests show that
  // this way prevails; see also SweepPairing. Changed: no run outside went either way. Undecided: all other
  // cases. A run outside with another outcome (see is_outcome()) or with a NaN goes neither way. A few other
  // runs beside many such runs therefore decide nothing.
  Judgement run_by_run = Judgement::equal;
};

// The first run, in the order of the arrays, that is done in one sweep only or has a measure outside the
// tolerance.
struct FirstDifference {
  std::size_t run = 0, cell = 0;
  std::vector<std::size_t> axis_indices;  // index of the cell on each axis
  int replicate = 0;
  std::string measure;  // the first measure outside; empty: the run is done in one sweep only
  double baseline = 0, candidate = 0;
};

// A measure in a region, over the runs done in both. up and down: pairs in which the candidate's number is
// larger, or smaller, by more than the tolerance. For an event: it happened in the candidate only, or in the
// baseline only.
struct RegionComparison {
  std::size_t region = 0, measure = 0;
  std::int64_t runs = 0;
  std::int64_t clusters = 0;  // independent ones: runs that share random numbers count as one
  std::int64_t pairs = 0;     // finite in both
  std::int64_t outside = 0;   // runs outside the tolerance
  std::int64_t unpaired = 0;  // runs outside: not finite in one or both, or an event neither 0 nor 1
  std::int64_t up = 0, down = 0;
  std::int64_t got_better = 0, got_worse = 0;  // pairs that got better or worse; 0 without a direction
  // Number of clusters that have a pair and draw random numbers. The tests compare these clusters, because
  // the runs of a cluster share random numbers, see CellStreams.
  std::int64_t tested = 0;
  std::int64_t fixed_not_better = 0;  // runs without random numbers that differ and got no better
  // (up - down) / pairs, as the mean over clusters, with the test of estimated_event_difference(). The
  // interval also includes the runs without random numbers, which are exact; p is that of the other runs. If
  // none of them differs, there is nothing to test, and no p.
  Estimate difference = {};

  // Events only: counts in both sweeps, and the fractions of pairs, see estimated_fraction(). Those of runs
  // without random numbers are exact and have no interval.
  int baseline_events = 0, candidate_events = 0;
  Estimate baseline_fraction = {}, candidate_fraction = {};
  // Other measures only: the mean difference in the same way, with the test of estimated_difference(), in
  // which pairs within the tolerance count as equal; and the baseline's standard deviation. Both are in the
  // measure's unit.
  Estimate mean = {};
  double baseline_spread = 0;

  // Tests of the clusters: (got_worse - got_better) / pairs; and how much worse they got, not for an event.
  Estimate worse_share = {}, worse_by = {};
  // The smaller p of difference and mean, adjusted for all tests of the sweep; skewed ones do not count. NaN:
  // there is no test.
  double adjusted_p = std::numeric_limits<double>::quiet_NaN();
  // The result of the paired tests, see PairedVerdict.
  Judgement judgement = Judgement::undecided;
};

struct PairedRule {
  double margin = 0.02;  // limit for the difference of two fractions of an event
  // Limit for other measures: for the fraction of runs that got larger less the fraction that got smaller,
  // and for the mean difference in units of the baseline's standard deviation.
  double shift_margin = 0.1;
  double alpha = 0.01;  // probability of a false "better", "worse" or "changed" anywhere
};

// The verdict is the first of these that holds, in this order; equal and within_margin are a pass.
//
// A measure in a region is changed if one direction prevails (adjusted p < alpha, whatever the margins) or a
// number became NaN. Runs that differ in an outcome, see is_outcome(), are neither better nor worse by other
// measures. A changed measure is worse if worse_share or worse_by has p < alpha, by itself, for worse.
// Otherwise it is better if one of them has p < alpha for better, no number became NaN, and all runs without
// random numbers that differ got better. The tests compare clusters, see RegionComparison::tested. Where no
// run draws random numbers there is no test: outside of the margins a measure is better or worse if all runs
// that differ are, else changed.
//
// The verdict within_margin must be demonstrated: over the whole, every measure that differs anywhere must
// have its intervals within the margins. An event at the default margin needs 280 runs with one flip, and
// more runs with more flips. 4 runs of which one differs are undecided; 5396 runs with 30 flips, evenly both
// ways, determine the difference to +-0.2 %. No correction for the number of measures is needed, because all
// of them must pass. Parts have fewer runs, so an undecided part does not prevent a pass, but a changed part
// does. This finds a local change that the flips of the whole would hide. The interval of a part shows which
// differences a pass does not exclude there. Measures that are not events are judged by the fraction of runs
// that got larger less the fraction that got smaller (about 400 runs if all differ, both ways alike), and by
// the mean difference in units of the standard deviation of the baseline's runs, so that a few runs that got
// much worse prevent a pass. Differences within a tolerance do not count. A systematic change, however small,
// is "changed", and so is a number that became NaN. In a refined sweep only the first round is judged,
// because the later rounds depend on the results.
enum class PairedVerdict {
  not_comparable,
  runs_missing,   // some runs of the first round are done in one sweep only
  equal,          // see is_equal()
  changed,        // some measure in some region: better, worse, or without a direction
  undecided,      // some measure over the whole
  within_margin,  // over the whole every measure is equal or within_margin
};

struct SweepComparison {
  // Reasons why the two are not comparable, one line each. If there are any, only the notes and the lists of
  // runs are set.
  std::vector<std::string> problems;
  std::vector<std::string> notes;  // differences without effect on the verdicts, one line each
  std::size_t done_in_both = 0;
  std::vector<std::size_t> baseline_only, candidate_only;  // runs done there only, increasing
  std::size_t newly_failed = 0;                            // failed in the candidate, among baseline_only
  std::vector<MeasureComparison> measures;                 // measures of the baseline
  std::optional<FirstDifference> first;
  std::vector<Region> regions;
  std::vector<RegionComparison> by_region;  // region after region, each with all measures
  std::int64_t tests = 0;                   // number of tests that are adjusted together
  // The fewest clusters of a region with which an adjusted p can be below alpha. 0: some region has as many,
  // or there is no test.
  std::int64_t needed_clusters = 0;
  PairedVerdict paired = PairedVerdict::not_comparable;

  // The same runs are done in both, and every pair of every measure is within the tolerance.
  bool is_equal() const { return problems.empty() && !first; }
  const RegionComparison& at(std::size_t region, std::size_t measure) const {
    return by_region[region * measures.size() + measure];
  }
};

// Knowledge about the random numbers of two sweeps.
struct SweepPairing {
  std::optional<CellStreams> streams = {};  // of both sweeps together; none: every run draws its own
  // The experiments differ. Then a few noisy runs that all went one way are chance: only the paired tests
  // show a direction.
  bool needs_tests = false;
};

// Two sweeps are comparable if they have the same axes (name, parameter, unit, and values to the bit), the
// same number of replicates, and all measures of the baseline in the same order and units (the candidate may
// have others), and if at least one run is done in both. Values within their tolerance count as equal in
// every test. Rounds of refinement and error texts are not compared. pre: the same noise in both (one seed);
// arrays are over all runs, as read_sweep returns them; tolerances, margin and alpha are not negative.
SweepComparison compare(const SweepResult& baseline, const SweepResult& candidate,
                        const Tolerances& tolerances = {}, const PairedRule& rule = {},
                        const Directions& directions = {}, const SweepPairing& pairing = {});

// The judgement of a measure, run by run or by pairs. The judgement by pairs combines the regions: worse if
// any region is worse, else changed if any is changed, else better if any is better, else that of the whole.
Judgement judgement_of(const SweepComparison& sweep, std::size_t measure, bool paired);

}  // namespace remote_touch
