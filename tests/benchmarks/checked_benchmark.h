// Benchmarks whose answers are compared with a reference before they are timed.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace remote_touch::benchmarks {

// time() runs only if is_right() is true; otherwise the benchmark is skipped with an error. Both are called
// after add() has returned.
void add(const std::string& name, const std::function<bool()>& is_right,
         const std::function<void(benchmark::State&)>& time);

// A benchmark without a reference.
void add(const std::string& name, const std::function<void(benchmark::State&)>& time);

// Runs the benchmarks that the arguments select. Returns the exit code of the program: 1 if an answer
// differed from its reference, 2 for an argument that is not known.
int run_benchmarks(int argc, char** argv);

// Processor time of this thread. It measures work that is short compared with the time for which other
// programs may occupy the machine.
double cpu_ns();

// The least time of each part of some work, ns. Every repetition of the work is the same, so the least of
// many times is that of the work alone.
class LeastTimes {
 public:
  explicit LeastTimes(int parts)
      : ns(static_cast<std::size_t>(parts), std::numeric_limits<double>::infinity()) {}

  template <class Work>
  auto time(int part, const Work& work) {
    const Stopwatch stopwatch{ns[static_cast<std::size_t>(part)], cpu_ns()};
    return work();
  }
  // Sets the counter p99_9_ns, of the parts that were timed.
  void count_slowest(benchmark::State& state) const;

  std::vector<double> ns;

 private:
  struct Stopwatch {
    double& least_ns;
    const double start_ns;
    ~Stopwatch() { least_ns = std::min(least_ns, cpu_ns() - start_ns); }
  };
};

}  // namespace remote_touch::benchmarks
