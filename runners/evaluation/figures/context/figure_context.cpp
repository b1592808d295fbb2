#include "runners/evaluation/figures/context/figure_context.h"

#include "core/parameters/input_error.h"
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
  note(sweep.to_json());
  inputs_.add(sweep.inputs());
  SweepResult result = run_sweep(sweep, {&kernels_, stop_, {}, runs_});
  const auto failed = result.runs_in(RunState::failed);
  if (!failed.empty()) throw InputError(sweep.title(), "a run failed: " + result.error[failed.front()]);
  notes_.add(result);
  return result;
}

}  // namespace remote_touch
