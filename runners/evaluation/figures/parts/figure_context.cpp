#include "runners/evaluation/figures/parts/figure_context.h"

#include "core/parameters/parameter.h"
#include "runners/sweep/sweep_run.h"

namespace remote_touch {

Trace FigureContext::run(const Experiment& experiment) {
  note(experiment.to_json());
  inputs_.add(experiment.inputs());
  return simulated(experiment);
}

std::vector<Trace> FigureContext::run(const std::vector<Experiment>& experiments) {
  for (const Experiment& experiment : experiments) {
    note(experiment.to_json());
    inputs_.add(experiment.inputs());
  }
  return collect(experiments.size(), [&](std::size_t i) { return simulated(experiments[i]); });
}

std::string FigureContext::configurations() const {
  std::string list;
  for (const std::string& configuration : configurations_)
    list += (list.empty() ? "[" : ", ") + configuration;
  return list.empty() ? "[]" : list + "]";
}

Trace FigureContext::simulated(const Experiment& experiment) {
  SimulationOptions options;
  options.kernels = &kernels_;
  options.stop = stop_;
  RunReport report;
  options.report = &report;
  Trace trace = simulate(experiment, options);
  notes_.add(report.notes);
  return trace;
}

Sweep FigureContext::map(const std::string& name, const std::vector<std::string>& overrides) {
  const Sweep whole = Sweep::load(name, overrides);
  Sweep made = coarse_ > 1 ? whole.thinned(coarse_) : whole;
  runs_of_maps_ += whole.plan().run_count(), made_runs_of_maps_ += made.plan().run_count();
  return made;
}

SweepResult FigureContext::sweep(const Sweep& sweep) {
  SweepResult result = run_sweep(sweep, {&kernels_, stop_, {}, runs_});
  note(sweep.to_json());
  inputs_.add(sweep.inputs());
  const auto failed = result.runs_in(RunState::failed);
  if (!failed.empty()) throw InputError(sweep.title(), "a run failed: " + result.error[failed.front()]);
  notes_.add(result);
  return result;
}

std::vector<NamedRun> named_runs(FigureContext& context, const std::vector<NamedExperiment>& experiments) {
  std::vector<Experiment> loaded;
  for (const NamedExperiment& one : experiments)
    loaded.push_back(Experiment::load(one.experiment, one.overrides));
  std::vector<Trace> traces = context.run(loaded);
  std::vector<NamedRun> runs;
  for (std::size_t i = 0; i < loaded.size(); ++i)
    runs.push_back({experiments[i].name, experiments[i].label, std::move(loaded[i]), std::move(traces[i])});
  return runs;
}

std::vector<std::size_t> runs_at(const SweepResult& sweep,
                                 const std::vector<std::optional<std::size_t>>& places) {
  std::vector<std::size_t> runs;
  for (std::size_t run = 0; run < sweep.run_count(); ++run) {
    const std::vector<std::size_t> at = sweep.axis_indices(sweep.cell_of(run));
    bool has_places = true;
    for (std::size_t axis = 0; axis < places.size(); ++axis)
      has_places = has_places && (!places[axis] || *places[axis] == at[axis]);
    if (has_places) runs.push_back(run);
  }
  return runs;
}

std::vector<double> measured(const SweepResult& sweep, const std::string& measure,
                             const std::vector<std::size_t>& runs) {
  std::vector<double> values;
  for (const std::size_t run : runs) values.push_back(sweep.measure(measure)[run]);
  return values;
}

}  // namespace remote_touch
