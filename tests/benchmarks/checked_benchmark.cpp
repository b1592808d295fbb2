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

bool mismatch_seen() {
  return mismatch;
}

double cpu_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

}  // namespace remote_touch::benchmarks
