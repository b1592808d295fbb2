// Scorecards: methods compared on many scenes.
#include <pybind11/stl.h>

#include <filesystem>

#include "runners/evaluation/scorecard/benchmark_run.h"
#include "runners/evaluation/scorecard/card_folder.h"
#include "runners/evaluation/scorecard/evaluation.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/long_work.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

using Texts = std::vector<std::string>;

struct FailedRuns {
  std::size_t count = 0;
  std::string first;  // "SCENE.METHOD: the error"
};

FailedRuns failed_runs(const std::vector<BenchmarkSweep>& sweeps) {
  FailedRuns failed;
  for (const BenchmarkSweep& each : sweeps) {
    const SweepResult result = read_sweep(each.file).result;
    const std::vector<std::size_t> runs = result.runs_in(RunState::failed);
    if (failed.count == 0 && !runs.empty()) failed.first = each.name + ": " + result.error[runs.front()];
    failed.count += runs.size();
  }
  return failed;
}

// Writes scorecard.h5 and scorecard.json into the folder.
FailedRuns make_scorecard(const Texts& methods, const Texts& scenes, int seeds,
                          const std::filesystem::path& folder, const LongWork& work) {
  const BenchmarkPlan plan = plan_of(chosen_benchmark(methods, scenes, seeds, folder.string()));
  const std::vector<BenchmarkSweep> sweeps = plan.sweeps();
  const FileTurn turn(FileTurn::For::a_sweep);
  require_same_benchmark(sweeps);
  require_all_of(folder / kScorecardFile, plan);
  make_scorecard_folder(folder.string());
  do_sweeps(sweeps, work.kernels, &work.stop, [&](std::size_t done, std::size_t all, double fraction) {
    work.progress((static_cast<double>(done) + fraction) / static_cast<double>(all + 1));
  });
  const ScorecardReport report = evaluate(plan, work.kernels, &work.stop, [](std::size_t, std::size_t) {});
  write_scorecard(folder, plan, report, scorecard_command(methods, scenes, seeds));
  return failed_runs(sweeps);
}

py::tuple scorecard(const Texts& methods, const Texts& scenes, int seeds, int threads,
                    const std::string& folder, const py::object& report) {
  FailedRuns failed;
  do_long_work(report, threads,
               [&](const LongWork& work) { failed = make_scorecard(methods, scenes, seeds, folder, work); });
  return py::make_tuple(failed.count, failed.first);
}

}  // namespace

void bind_scorecards(py::module_& module) {
  module.def("scorecard", &scorecard, py::arg("methods"), py::arg("scenes"), py::arg("seeds"),
             py::arg("threads"), py::arg("folder"), py::arg("report"),
             "Makes a scorecard in a folder; how many runs failed, and how the first one did.");
}

}  // namespace remote_touch
