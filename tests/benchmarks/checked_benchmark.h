// Benchmarks whose answers are compared with a reference before they are timed.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

namespace remote_touch::benchmarks {

// time() runs only if is_right() is true; otherwise the benchmark is skipped with an error. Both are called
// after add() has returned.
void add(const std::string& name, const std::function<bool()>& is_right,
         const std::function<void(benchmark::State&)>& time);

// True if any answer has differed from its reference so far.
bool mismatch_seen();

// Processor time of this thread. It measures work that is short compared with the time for which other
// programs may occupy the machine.
double cpu_ns();

}  // namespace remote_touch::benchmarks
