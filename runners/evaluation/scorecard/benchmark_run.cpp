#include "runners/evaluation/scorecard/benchmark_run.h"

#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/sweep/sweep_session.h"

namespace remote_touch {

namespace {

// Returns the command that makes the file again, in any folder.
std::string command_of(const Benchmark& benchmark, const BenchmarkScene& scene, const Method& method) {
  return program_text() + " scorecard " + method.name + " --scene " + scene.name + " --seeds " +
         std::to_string(benchmark.replicates);
}

}  // namespace

std::vector<BenchmarkSweep> sweeps_of(const Benchmark& benchmark, const BenchmarkScene& scene) {
  std::vector<BenchmarkSweep> sweeps;
  for (const Method& method : benchmark.methods) {
    Sweep sweep = scene.sweep(method, benchmark.replicates);
    const std::string name = scene.name + "." + method.name;
    TextAttributes attributes =
        provenance(sweep.to_json(), command_of(benchmark, scene, method), "", input_hashes(sweep.inputs()));
    sweeps.push_back(
        {name, std::move(sweep), std::move(attributes), benchmark.folder / "runs" / (name + ".h5")});
  }
  return sweeps;
}

void require_same_benchmark(const std::vector<BenchmarkSweep>& sweeps) {
  for (const BenchmarkSweep& one : sweeps) plan_in_file(one.sweep, {}, one.attributes, one.file);
}

void do_sweeps(const std::vector<BenchmarkSweep>& sweeps, const Kernels& kernels,
               const std::atomic<bool>* stop, const BenchmarkProgress& progress) {
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    progress(i, sweeps.size(), 0);
    SweepSession session(sweeps[i].sweep, {}, sweeps[i].attributes, sweeps[i].file);
    session.run(kernels, stop, [&](std::size_t done, std::size_t total, std::size_t) {
      progress(i, sweeps.size(), static_cast<double>(done) / static_cast<double>(total));
    });
  }
}

}  // namespace remote_touch
