#include "tests/benchmarks/checked_benchmark.h"

#include <time.h>

#include <memory>

namespace remote_touch::benchmarks {
namespace {

bool mismatch = false;

}  // namespace

// The check is done once per process: repetitions and calibration run the same code on the same data.
void add(const std::string& name, const std::function<bool()>& is_right,
         const std::function<void(benchmark::State&)>& time) {
  const auto checked = std::make_shared<bool>(false);
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    if (!*checked && !is_right()) {
      mismatch = true;
      state.SkipWithError("the answers differ from the reference");
      return;
    }
    *checked = true;
    time(state);
  });
}

void add(const std::string& name, const std::function<void(benchmark::State&)>& time) {
  add(
      name, [] { return true; }, time);
}

int run_benchmarks(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return mismatch ? 1 : 0;
}

void LeastTimes::count_slowest(benchmark::State& state) const {
  std::vector<double> timed = ns;
  std::erase(timed, std::numeric_limits<double>::infinity());
  std::sort(timed.begin(), timed.end());
  state.counters["p99_9_ns"] = timed[static_cast<std::size_t>(0.999 * (timed.size() - 1) + 0.5)];
}

double cpu_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

}  // namespace remote_touch::benchmarks
