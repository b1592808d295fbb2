#include "runners/interfaces/cli/sweep_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "analysis/sweeps/sweep_file.h"
#include "core/parameters/input_error.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/sweep/cell_text.h"
#include "runners/sweep/sweep_notes.h"

namespace remote_touch {

namespace {

// "mean 0.25  0 .. 1 1, of 4 of 5 runs". Runs whose value is not finite are left out, because an unknown
// outcome is neither 0 nor 1. The text then states the number of runs in the mean.
std::string summary_of(const std::vector<double>& values, const std::vector<std::size_t>& done,
                       const std::string& units) {
  double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;
  std::size_t count = 0;
  for (const std::size_t run : done) {
    if (!std::isfinite(values[run])) continue;
    low = std::min(low, values[run]), high = std::max(high, values[run]), sum += values[run];
    ++count;
  }
  if (count == 0) return "no value in any run";
  char text[160];
  std::snprintf(text, sizeof text, "mean %-10.6g %.6g .. %.6g %s", sum / static_cast<double>(count), low,
                high, units.c_str());
  if (count == done.size()) return text;
  return text + (", of " + std::to_string(count)) + " of " + std::to_string(done.size()) + " runs";
}

// Prints which runs failed and why, each with the options by which `replay` selects it; at most 20 runs.
void print_failures(const SweepResult& result, const std::vector<std::size_t>& failed) {
  constexpr std::size_t kMax = 20;
  for (std::size_t i = 0; i < std::min(kMax, failed.size()); ++i) {
    const std::size_t run = failed[i];
    std::printf("  failed: --cell %s --replicate %d: %s\n", cell_text(result, result.cell_of(run)).c_str(),
                result.replicate_of(run), result.error[run].c_str());
  }
  if (failed.size() > kMax)
    std::printf("  and %zu more, in the dataset /sweep/error\n", failed.size() - kMax);
}

}  // namespace

std::string extent_text(const SweepResult& result) {
  std::string text;
  for (const Column& axis : result.axes) text += (text.empty() ? "" : " x ") + std::to_string(axis.length());
  return text;
}

int print_summary(const std::string& file, const SweepResult& result) {
  const auto failed = result.runs_in(RunState::failed);
  const std::vector<std::size_t> done = result.runs_in(RunState::done);
  std::printf("%s: %s cells, %zu runs done, %zu failed", printable(file).c_str(), extent_text(result).c_str(),
              done.size(), failed.size());
  if (!result.round.empty())
    std::printf(" in %d rounds", 1 + *std::max_element(result.round.begin(), result.round.end()));
  if (const auto elsewhere = result.runs_in(RunState::elsewhere).size(); elsewhere > 0)
    std::printf(", %zu in other shards", elsewhere);
  std::printf(", digest %s\n", digest(result).c_str());
  if (!done.empty())
    for (const Column& measure : result.measures)
      std::printf("  %-20s %s\n", measure.name.c_str(),
                  summary_of(result.measure(measure.name), done, measure.units).c_str());
  for (const std::string& line : note_lines(result)) std::printf("  note: %s\n", line.c_str());
  if (failed.empty()) return kDone;
  print_failures(result, failed);
  return kCheckFailed;
}

}  // namespace remote_touch
