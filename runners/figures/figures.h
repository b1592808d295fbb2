// The figures that can be reproduced: each runs experiments and hands their traces to analyses.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "analysis/figure.h"
#include "analysis/trace.h"
#include "runners/experiment.h"
#include "runners/simulation.h"

namespace remote_touch {

// How a figure gets its traces. Independent runs go side by side; results do not depend on how many.
class Laboratory {
 public:
  Laboratory(const Kernels& kernels, const std::atomic<bool>* stop, std::function<void(double)> progress)
      : kernels_(kernels), stop_(stop), progress_(std::move(progress)) {}

  Trace run(const Experiment& experiment) const;
  // One number from each run. Every experiment is resolved before the first runs; the first failure is thrown
  // after all have ended.
  std::vector<double> measure(const std::vector<Experiment>& experiments,
                              const std::function<double(const Trace&)>& of) const;
  // The resolved configuration of every run() and of the first experiment of every measure(), as a JSON list.
  std::string configurations() const;

 private:
  mutable std::vector<std::string> configurations_;
  const Kernels& kernels_;
  const std::atomic<bool>* stop_;
  std::function<void(double)> progress_;
};

// A new figure is one file and one line in figures.cpp. May throw InputError: the figure is then reported as
// not run.
struct FigureEntry {
  const char* name;
  const char* summary;
  Figure (*make)(const Laboratory& laboratory);
};
std::span<const FigureEntry> figures();

Figure figure_4_11(const Laboratory& laboratory);
Figure figure_4_12(const Laboratory& laboratory);
Figure figure_4_14(const Laboratory& laboratory);
Figure figure_4_16(const Laboratory& laboratory);
Figure figure_4_16_recorded(const Laboratory& laboratory);
Figure figure_eq4_15(const Laboratory& laboratory);

}  // namespace remote_touch
