// Times of the pop-through map of Fig 4.13. Samples of its lifts are first compared with lifts that make and
// search every point. Then the map is timed, and the time is estimated with all noise made, and with the
// plain method. Prints one JSON object per line. Exit: 0; 1 if an answer differs; 2 for bad usage.
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "analysis/measures/measures.h"
#include "analysis/storage/digest.h"
#include "core/kernels/isa.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep_run.h"
#include "tests/benchmarks/full_lift.h"
#include "tests/benchmarks/naive_lift.h"
#include "tests/benchmarks/naive_proxy.h"

namespace remote_touch::benchmarks {
namespace {

bool mismatch = false;

void report(const char* check, bool is_right) {
  mismatch |= !is_right;
  std::printf("{\"check\": \"%s\", \"right\": %s}\n", check, is_right ? "true" : "false");
  std::fflush(stdout);
}

struct Seconds {
  double wall = std::numeric_limits<double>::infinity(), cpu = wall;
  void min(const Seconds& other) { wall = std::min(wall, other.wall), cpu = std::min(cpu, other.cpu); }
};

// cpu is the time of all threads together.
Seconds seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu_start = std::clock();
  work();
  const auto cpu = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), cpu};
}

// --- lifts of the map ---

struct Cell {
  Experiment experiment;
  naive::Lift lift;  // the same lift, for the plain method and at most 30 steps
};

class Map {
 public:
  explicit Map(const std::vector<std::string>& overrides)
      : sweep_(Sweep::load("fig4.13", overrides)), plan_(sweep_.plan()) {}
  const Sweep& sweep() const { return sweep_; }
  std::size_t lift_count() const { return plan_.run_count(); }
  std::size_t length(std::size_t axis) const { return values(axis).size(); }
  Cell cell(std::size_t noise, std::size_t acceleration) const {
    Cell cell{sweep_.experiment(plan_.cell_at({noise, acceleration}), 0), {}};
    cell.lift.scene.noise_sigma_m = values(0)[noise];
    cell.lift.scene.lift.acceleration_m_per_s2 = values(1)[acceleration];
    return cell;
  }

 private:
  const std::vector<double>& values(std::size_t axis) const {
    return std::get<std::vector<double>>(plan_.axes[axis].values);
  }
  const Sweep sweep_;
  const SweepResult plan_;
};

// One lift of each of rows x 4 equal parts of the map: the middle of each part, or spread so that the edges
// of the map are met.
enum class Spread { middles, edges };

std::vector<Cell> sample(const Map& map, std::size_t rows, Spread spread) {
  const auto place = [&](std::size_t i, std::size_t parts, std::size_t axis) {
    const std::size_t length = map.length(axis);
    return spread == Spread::middles ? (2 * i + 1) * length / (2 * parts) : i * (length - 1) / (parts - 1);
  };
  std::vector<Cell> cells;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      cells.push_back(map.cell(place(row, rows, 0), place(column, 4, 1)));
  return cells;
}

// --- answers ---

MakeFrame all_noise_of(const Cell& cell, const Kernels& kernels) {
  return all_noise(cell.lift.scene, cell.experiment.settings().key, kernels);
}

// Compares the lazy noise with its reference, the whole cloud, and with the search that makes all noise,
// which time() measures.
bool equals_full(const Cell& cell, const Kernels& kernels) {
  const auto full = [&](const MakeFrame& make_frame) {
    return digest(simulate_with(cell.experiment, kernels, make_frame).columns());
  };
  const std::string lazy = digest(simulate(cell.experiment).columns());
  return lazy == full(whole_cloud) && lazy == full(all_noise_of(cell, kernels));
}

bool follows(const std::vector<Vec3>& plain_W, const Trace& trace, std::size_t steps) {
  if (plain_W.size() != trace.length()) return false;
  for (std::size_t i = 0; i < steps; ++i)
    if (!((plain_W[i] - trace.proxy_position_m[i]).norm() < 1e-7)) return false;
  return true;
}

// The plain method receives the noise of the map. The last bits of noisy lifts grow from step to step once
// the HIP presses, so noisy lifts are compared only up to the end of the first pressed frame.
bool equals_plain(const Cell& cell, const Kernels& kernels) {
  const auto scenario = cell.experiment.build_scenario(kernels);
  const auto given = [&](int frame, double, std::vector<Vec3>& points) {
    points = naive::points_of(scenario->cloud(frame));
  };
  const std::vector<Vec3> plain_W = naive::proxies(cell.lift, given);
  const int pressed = (cell.lift.press_frame + 1) * cell.lift.steps_per_frame;
  const bool noisy = cell.lift.scene.noise_sigma_m > 0;
  return follows(plain_W, simulate(cell.experiment), noisy ? pressed : plain_W.size());
}

// Zero noise is also zero with the standard library's generator. The proxy is lifted at a = 3 m/s^2, and pops
// through at a = 6 m/s^2.
bool outcomes_are_known(const Map& map) {
  bool right = true;
  for (const bool pops : {false, true}) {
    const Cell cell = map.cell(0, pops ? 60 : 30);
    const std::vector<Vec3> plain_W = naive::proxies(cell.lift, naive::standard_noise(cell.lift.scene, 1));
    right &= cell.lift.scene.lift.acceleration_m_per_s2 == (pops ? 6 : 3);
    right &= naive::popped_through(cell.lift, plain_W) == pops;
    right &= (popped_through(simulate(cell.experiment)) > 0) == pops;
  }
  return right;
}

bool all_equal(const std::vector<Cell>& cells, bool (*equals)(const Cell&, const Kernels&)) {
  const Kernels& kernels = kernels_for(best_isa());
  return std::all_of(cells.begin(), cells.end(), [&](const Cell& cell) { return equals(cell, kernels); });
}

void check(const Map& at_30, const Map& at_1000) {
  report("24 lifts, 30 steps: the bits of every point made and searched",
         all_equal(sample(at_30, 6, Spread::edges), equals_full));
  report("24 lifts, 1000 steps: the bits of every point made and searched",
         all_equal(sample(at_1000, 6, Spread::edges), equals_full));
  report("12 lifts, 30 steps: the proxies of the plain method",
         all_equal(sample(at_30, 3, Spread::edges), equals_plain));
  report("no noise: a = 3 m/s^2 lifts and a = 6 m/s^2 pops through, also plainly", outcomes_are_known(at_30));
}

// --- times: the least of the repetitions ---

void print(const char* name, int steps, int threads, std::size_t lifts, const Seconds& map) {
  std::printf("{\"time\": \"%s\", \"steps\": %d, \"threads\": %d, \"lifts\": %zu, ", name, steps, threads,
              lifts);
  std::printf("\"map_s\": %.4g, \"map_cpu_s\": %.4g, \"isa\": \"%s\"}\n", map.wall, map.cpu,
              kernels_for(best_isa()).isa);
}

// Times of a few lifts on one thread. The time of the map is their mean times its number of lifts.
struct SampledTime {
  const char* name;
  std::function<void(const Cell&)> lift;
  std::vector<Seconds> min = {};

  void measure(const std::vector<Cell>& cells) {
    min.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) min[i].min(seconds([&] { lift(cells[i]); }));
  }
  void print(std::size_t map_lifts) const {
    Seconds map{0, 0};
    const double fraction = static_cast<double>(map_lifts) / static_cast<double>(min.size());
    for (const Seconds& each : min) map.wall += fraction * each.wall, map.cpu += fraction * each.cpu;
    benchmarks::print(name, 30, 1, min.size(), map);
  }
};

// Time of the whole map. If cpu is less than threads times wall, the threads had to wait for a processor.
struct MapTime {
  const Map& map;
  int steps, threads;
  Seconds min = {};
  std::string measures = {};  // their digest

  void measure() {
    omp_set_num_threads(threads);
    min.min(seconds([&] { measures = digest(run_sweep(map.sweep(), {}).measures); }));
  }
  void print() const { benchmarks::print("map", steps, threads, map.lift_count(), min); }
};

// CPU time of a lift with one noise, in a sweep on one thread with the accelerations and measures of the map,
// at 30 steps per tick.
struct LiftTime {
  explicit LiftTime(int noise_mm_)
      : noise_mm(noise_mm_),
        sweep(Sweep::load("fig4.13", {bound("from", noise_mm), bound("to", noise_mm), "axes.0.count=1"})) {}

  void measure() {
    omp_set_num_threads(1);
    min.min(seconds([&] { lifts = run_sweep(sweep, {}).run_count(); }));
  }
  void print() const {
    std::printf("{\"lift\": %d, \"lifts\": %zu, \"lift_cpu_s\": %.4g, \"isa\": \"%s\"}\n", noise_mm, lifts,
                min.cpu / static_cast<double>(lifts), kernels_for(best_isa()).isa);
  }

  int noise_mm;
  Sweep sweep;
  std::size_t lifts = 0;
  Seconds min = {};

 private:
  static std::string bound(const char* end, int noise_mm) {
    return std::string("axes.0.") + end + "=" + std::to_string(1e-3 * noise_mm);
  }
};

void time(const Map& at_30, const Map& at_1000, int repetitions) {
  const Kernels& kernels = kernels_for(best_isa());
  const std::vector<Cell> cells = sample(at_30, 3, Spread::middles);
  SampledTime sampled[] = {
      {"plain", [](const Cell& c) { naive::proxies(c.lift, naive::standard_noise(c.lift.scene, 1)); }},
      {"all noise", [&](const Cell& c) { simulate_with(c.experiment, kernels, all_noise_of(c, kernels)); }},
      {"sample", [](const Cell& c) { simulate(c.experiment); }}};
  MapTime maps[] = {{at_30, 30, 1}, {at_30, 30, 2}, {at_1000, 1000, 1}, {at_1000, 1000, 2}};
  LiftTime lifts[] = {LiftTime(0), LiftTime(1), LiftTime(3), LiftTime(15)};
  for (int i = 0; i < repetitions; ++i) {
    for (SampledTime& each : sampled) each.measure(cells);
    for (MapTime& each : maps) each.measure();
    for (LiftTime& each : lifts) each.measure();
  }
  report("the map on one thread and on two", maps[0].measures == maps[1].measures);
  for (const SampledTime& each : sampled) each.print(at_30.lift_count());
  for (const MapTime& each : maps) each.print();
  for (const LiftTime& each : lifts) each.print();
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch::benchmarks;
  const int repetitions = argc < 2 ? 1 : std::atoi(argv[1]);
  if (argc > 2 || repetitions < 1) {
    std::fputs("usage: map_benchmark [repetitions]\n", stderr);
    return 2;
  }
  const Map at_30({"haptic_rate_hz=900", "renderer.steps_per_tick=1"}), at_1000({});
  check(at_30, at_1000);
  time(at_30, at_1000, repetitions);
  return mismatch ? 1 : 0;
}
