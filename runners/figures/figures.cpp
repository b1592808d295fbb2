#include "runners/figures/figures.h"

#include <exception>

namespace remote_touch {

namespace {

constexpr FigureEntry kFigures[] = {
    {"4.11", "a flat grid touched from above: proxy height, and the ripple of the contact point",
     figure_4_11},
    {"4.12", "a noisy cloud lifted with acceleration: proxy height at each update", figure_4_12},
    {"4.14", "the contact point over a triangle wave of growing amplitude", figure_4_14},
    {"eq4.15", "force between updates of a moving cloud: the sign in equation (4.15)", figure_eq4_15},
    {"4.16", "ramp and box seen by a simulated depth camera: proxy path and force", figure_4_16},
    {"4.16-recorded", "the same experiment on recorded depth images and clouds", figure_4_16_recorded},
};

}  // namespace

std::span<const FigureEntry> figures() {
  return kFigures;
}

Trace Laboratory::run(const Experiment& experiment) const {
  configurations_.push_back(experiment.to_json());
  SimulationOptions options;
  options.kernels = &kernels_;
  options.stop = stop_;
  options.progress = progress_;
  return simulate(experiment, options);
}

std::string Laboratory::configurations() const {
  std::string list;
  for (const std::string& configuration : configurations_)
    list += (list.empty() ? "[" : ", ") + configuration;
  return list.empty() ? "[]" : list + "]";
}

std::vector<double> Laboratory::measure(const std::vector<Experiment>& experiments,
                                        const std::function<double(const Trace&)>& of) const {
  const int count = static_cast<int>(experiments.size());
  std::vector<double> values(experiments.size());
  std::vector<std::exception_ptr> failures(experiments.size());
  if (!experiments.empty()) configurations_.push_back(experiments.front().to_json());
  int done = 0;
  // Run i writes slot i; an exception must not leave the loop, it would end the program.
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < count; ++i) {
    const auto slot = static_cast<std::size_t>(i);
    try {
      SimulationOptions options;
      options.kernels = &kernels_;
      options.stop = stop_;
      values[slot] = of(simulate(experiments[slot], options));
    } catch (...) {
      failures[slot] = std::current_exception();
    }
#pragma omp critical(laboratory_progress)
    progress_(static_cast<double>(++done) / count);
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  return values;
}

}  // namespace remote_touch
