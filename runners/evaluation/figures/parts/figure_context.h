// FigureContext runs the experiments of a figure.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/result_file.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/work_pool.h"

namespace remote_touch {

// r_c of every figure of chapters 4 and 5: Table 4.2.
inline constexpr double kContactRadius_m = 0.005;

// Runs the experiments of a figure. Independent runs are made in parallel; results do not depend on the
// number of threads.
class FigureContext {
 public:
  // coarse: uses every coarse-th value of the axes of maps, for a preview; 1: all.
  FigureContext(const Kernels& kernels, const std::atomic<bool>* stop, int coarse = 1,
                SideBySide runs = side_by_side)
      : kernels_(kernels), stop_(stop), coarse_(coarse), runs_(std::move(runs)) {}

  Trace run(const Experiment& experiment);
  Trace run(const std::string& experiment, const std::vector<std::string>& overrides = {}) {
    return run(Experiment::load(experiment, overrides));
  }
  // Records an experiment whose frames are used without a run.
  void uses(const Experiment& experiment) {
    note(experiment.to_json());
    inputs_.add(experiment.inputs());
  }
  const Kernels& kernels() const { return kernels_; }
  // Returns work(i) for each i below count, in parallel. For work that is not a run; uses() records what it
  // reads.
  template <class Work>
  auto collect(std::size_t count, Work&& work) const {
    std::vector<decltype(work(std::size_t{}))> results(count);
    runs_(count, [&](std::size_t i) { results[i] = work(i); });
    return results;
  }
  std::vector<Trace> run(const std::vector<Experiment>& experiments);  // parallel runs
  // Returns of(trace) for each run, in parallel. The first failure is thrown after all runs have ended.
  template <class Of>
  auto measure(const std::vector<Experiment>& experiments, Of&& of) {
    if (!experiments.empty()) note(experiments.front().to_json());
    for (const Experiment& experiment : experiments) inputs_.add(experiment.inputs());
    return collect(experiments.size(), [&](std::size_t i) { return of(simulated(experiments[i])); });
  }
  // Returns a stored sweep of thousands of runs, thinned by `coarse`, for the calls of sweep() and measure()
  // below.
  Sweep map(const std::string& name, const std::vector<std::string>& overrides = {});
  // Number of runs of the full maps, and number of runs that are made, over all calls of map().
  std::size_t runs_of_maps() const { return runs_of_maps_; }
  std::size_t made_runs_of_maps() const { return made_runs_of_maps_; }
  // Makes every run of a sweep; throws InputError if one failed.
  SweepResult sweep(const Sweep& sweep);
  // Returns of(trace) for each run of a sweep's plan, in its order.
  template <class Of>
  auto measure(const Sweep& sweep, Of&& of) {
    const SweepResult plan = sweep.plan();
    note(sweep.to_json());
    inputs_.add(sweep.inputs());
    return collect(plan.run_count(), [&](std::size_t run) {
      return of(simulated(sweep.experiment(plan.cell_of(run), plan.replicate_of(run))));
    });
  }
  // Returns the resolved configuration of every run(), uses() and sweep, and of the first experiment of every
  // measure() of experiments, as a JSON list.
  std::string configurations() const;
  // Returns the hashes of the recordings that all of them read, see provenance.h.
  std::string inputs() const { return inputs_.text(); }
  void require_unchanged_inputs() const { inputs_.require_unchanged(); }
  // Returns the counts of the notes on all runs, one line for each kind.
  std::vector<std::string> note_lines() const { return notes_.lines(); }

 private:
  // Several threads call it at the same time: of the members it changes only notes_, which has a lock.
  Trace simulated(const Experiment& experiment);
  void note(const std::string& configuration) { configurations_.push_back(configuration); }

  std::vector<std::string> configurations_;
  InputHashes inputs_;
  NoteCounts notes_;
  const Kernels& kernels_;
  const std::atomic<bool>* stop_;
  int coarse_;
  SideBySide runs_;
  std::size_t runs_of_maps_ = 0, made_runs_of_maps_ = 0;
};

// A run of a figure that has several: its name in tables, and a label for readers.
struct NamedExperiment {
  std::string name, label, experiment;
  std::vector<std::string> overrides = {};
};
struct NamedRun {
  std::string name, label;
  Experiment experiment;
  Trace trace;
};
std::vector<NamedRun> named_runs(FigureContext& context, const std::vector<NamedExperiment>& experiments);

// Returns the runs of a sweep with these places on its axes, in order; an axis without a place may have any.
std::vector<std::size_t> runs_at(const SweepResult& sweep,
                                 const std::vector<std::optional<std::size_t>>& places);
// Returns a measure of these runs.
std::vector<double> measured(const SweepResult& sweep, const std::string& measure,
                             const std::vector<std::size_t>& runs);

// The values of a numeric axis of a sweep, and the one that a cell has.
inline const std::vector<double>& axis_values(const SweepResult& sweep, std::size_t axis) {
  return std::get<std::vector<double>>(sweep.axes.at(axis).values);
}
inline double axis_value(const SweepResult& sweep, std::size_t axis, std::size_t cell) {
  return axis_values(sweep, axis).at(sweep.axis_indices(cell).at(axis));
}

// May throw InputError: the figure is then reported as not run.
using MakeFigure = Figure(FigureContext& context);

}  // namespace remote_touch
