#include "runners/figures/figures.h"

#include <exception>

#include "core/parameters/input_error.h"
#include "runners/sweep/sweep_run.h"

namespace remote_touch {

namespace {

constexpr FigureEntry kFigures[] = {
    {"4.11", "a flat grid touched from above: proxy height, and the ripple of the contact point",
     figure_4_11},
    {"4.12", "a noisy cloud lifted with acceleration: proxy height at each update", figure_4_12},
    {"4.13", "5396 lifts, noise against acceleration: which popped through", figure_4_13},
    {"4.13-replicated", "the same with 20 lifts a cell: probability of pop-through", figure_4_13_replicated},
    {"4.13-tracked", "the pop-through map under a tracked sheet, beside the paper's", figure_4_13_tracked},
    {"bounds", "the bounds (4.14) to (4.25), their parts measured, and how far they hold", figure_bounds},
    {"4.14", "the contact point over a triangle wave of growing amplitude", figure_4_14},
    {"eq4.15", "force between updates of a moving cloud: the sign in equation (4.15)", figure_eq4_15},
    {"4.16", "ramp and box seen by a simulated depth camera: proxy path and force", figure_4_16},
    {"4.16-recorded", "the same experiment on recorded depth images and clouds", figure_4_16_recorded},
    {"5.5", "the region around a single point, entered and left", figure_5_5},
    {"5.6", "the step between two fixture radii, and a stiffness that varies across a plane", figure_5_6},
    {"5.8", "a fixture that grows on a beating organ, seen by a simulated depth camera", figure_5_8},
    {"5.8-recorded", "the same fixture on recorded depth images, camera at rest and moving",
     figure_5_8_recorded},
    {"6.2", "a recorded hand as points with normals, and what the filter does to a step", figure_6_2},
    {"6.3", "a tool turned in a narrow box of points: displacement, rotation, counts of contacts",
     figure_6_3},
    {"6.4", "a bunny, a hand and a drill slide over recorded objects", figure_6_4},
    {"7.1-recorded", "an organ model and a dragon found by hue in recorded images", figure_7_1_recorded},
    {"7.4", "a tool of spheres is pushed towards two valves with forbidden regions", figure_7_4},
    {"7.5", "guidance leads the hand from one valve to the other, with five and with six motors", figure_7_5},
    {"7.5-recorded", "the same task on a recorded desk: from an organ model to a dragon",
     figure_7_5_recorded},
    {"latency", "how far a fixture is violated when frames come late, irregularly or not at all",
     figure_latency},
    {"turbidity", "two valves in turbid water found by hue: precision and recall", figure_turbidity},
};

}  // namespace

std::span<const FigureEntry> figures() {
  return kFigures;
}

Trace FigureContext::run(const Experiment& experiment) const {
  note(experiment.to_json());
  inputs_.add(experiment.inputs());
  return simulated(experiment, progress_);
}

std::vector<Trace> FigureContext::run(const std::vector<Experiment>& experiments) const {
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

Trace FigureContext::simulated(const Experiment& experiment, std::function<void(double)> progress) const {
  SimulationOptions options;
  options.kernels = &kernels_;
  options.stop = stop_;
  options.progress = std::move(progress);
  return simulate(experiment, options);
}

void FigureContext::for_each(std::size_t count, const std::function<void(std::size_t)>& work) const {
  std::vector<std::exception_ptr> failures(count);
  std::size_t done = 0;
  // Run i writes slot i; an exception must not leave the loop, it would end the program.
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < count; ++i) {
    try {
      work(i);
    } catch (...) {
      failures[i] = std::current_exception();
    }
#pragma omp critical(context_progress)
    progress_(static_cast<double>(++done) / static_cast<double>(count));
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

Sweep FigureContext::map(const std::string& name, const std::vector<std::string>& overrides) const {
  const Sweep whole = Sweep::load(name, overrides);
  if (coarse_ <= 1) return whole;
  has_coarse_map_ = true;
  return whole.thinned(coarse_);
}

SweepResult FigureContext::sweep(const Sweep& sweep) const {
  note(sweep.to_json());
  inputs_.add(sweep.inputs());
  const double runs = static_cast<double>(sweep.plan().runs_in(RunState::pending).size());
  double done = 0;
  SweepResult result = run_sweep(sweep, {&kernels_, stop_, [&](std::size_t) { progress_(++done / runs); }});
  const auto failed = result.runs_in(RunState::failed);
  if (!failed.empty()) throw InputError(sweep.title(), "a run failed: " + result.error[failed.front()]);
  return result;
}

}  // namespace remote_touch
