// Shared by the tests of tallies: a small sweep whose runs have awkward values, notes and errors.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_tally.h"

namespace remote_touch {

// 2 x 3 cells, two measures and an event. There are no runs yet.
inline SweepTally example_plan(int replicates, bool keeps_events = true) {
  SweepTally tally;
  tally.axes = {{"rule", "1", "renderer.rule", std::vector<std::int32_t>{0, 1}, 1, {"fixed", "variable"}},
                {"sigma_m", "m", "scenario.sigma_m", std::vector<double>{0, 0.1, 1.0 / 3}}};
  tally.replicates = replicates;
  tally.measures = {{"jump", "N", "largest jump of the force", std::vector<double>()},
                    {"popped_through", "1", "1 when the surface passed", std::vector<double>()},
                    {"time", "s", "time of the first contact, NaN without", std::vector<double>()}};
  tally.note_kinds = {"other", "no contact", "frames unused"};
  tally.keeps_events = keeps_events;
  return tally;
}

struct ExampleRun {
  std::vector<double> values = {};
  std::uint32_t notes = 0;
  std::string error = {};  // empty if the run is done
};

// The run of that number: always the same, whatever was asked before.
inline ExampleRun example_run(std::uint64_t number) {
  std::mt19937_64 random(number);
  std::normal_distribution<double> normal;
  if (number % 11 == 7) return {{}, 0, "no B\xc3\xb6gen in run " + std::to_string(number)};
  ExampleRun run;
  run.values = {std::exp(0.3 * normal(random)), normal(random) > 0.5 ? 1.0 : 0.0, 0.1 * normal(random)};
  if (number % 13 == 5) run.values[2] = std::nan("");
  if (number % 17 == 3) run.values[0] = number % 2 == 0 ? INFINITY : 1e300;
  run.notes = number % 5 == 1 ? static_cast<std::uint32_t>(random() % 8) : 0;
  return run;
}

inline void add_example_runs(SweepTally& tally, const std::vector<std::uint64_t>& numbers) {
  const TallyLayout layout = tally.layout();
  for (const std::uint64_t number : numbers)
    if (const ExampleRun run = example_run(number); run.error.empty())
      tally.add_done(layout, number, run.values, run.notes);
    else
      tally.add_failed(layout, number, run.error);
}

inline std::vector<std::uint64_t> numbers_below(std::uint64_t end) {
  std::vector<std::uint64_t> numbers(end);
  for (std::uint64_t i = 0; i < end; ++i) numbers[i] = i;
  return numbers;
}

inline SweepTally example_tally(int replicates, bool keeps_events = true) {
  SweepTally tally = example_plan(replicates, keeps_events);
  add_example_runs(tally, numbers_below(tally.run_count()));
  return tally;
}

// Compares everything that a tally holds, and also the bits of the axes.
inline bool same_tally(const SweepTally& a, const SweepTally& b) {
  return a.cells == b.cells && a.tallies == b.tallies && a.held == b.held && a.replicates == b.replicates &&
         a.note_kinds == b.note_kinds && a.keeps_events == b.keeps_events &&
         names_of(a.axes) == names_of(b.axes) && names_of(a.measures) == names_of(b.measures);
}

}  // namespace remote_touch
