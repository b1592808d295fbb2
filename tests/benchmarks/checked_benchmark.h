// Benchmarks whose answers are compared with a reference before they are timed.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

namespace remote_touch::benchmarks {

// time() runs only if is_right(); otherwise the benchmark is skipped with an error. Both are called after the
// call of add().
void add(const std::string& name, const std::function<bool()>& is_right,
         const std::function<void(benchmark::State&)>& time);

// Whether any answer differed so far.
bool mismatch_seen();

// Of this thread, for what is short against the time for which others may have the machine.
double cpu_ns();

}  // namespace remote_touch::benchmarks
