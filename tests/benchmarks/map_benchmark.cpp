// Sweep throughput: the pop-through map of Fig 4.13, at 30 steps per frame, on one thread and on two. Samples
// of its lifts are first compared with the plain method, which is also timed.
#include <benchmark/benchmark.h>
#include <omp.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "analysis/storage/digest.h"
#include "analysis/trace/measures.h"
#include "core/dissertation/proxy/proxy_motion.h"
#include "core/kernels/kernels.h"
#include "core/points/vector.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep_run.h"
#include "scenarios/simulated/grid_scenes.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/naive_proxy.h"

// A lift of Fig 4.12 written plainly from its equations, over all points, with the standard library's noise.
namespace remote_touch::naive {
namespace {

struct Lift {
  MovingLift::Settings scene;
  ProxyParameters proxy;
  int steps_per_frame = 30;
  int press_frame = 15;   // frame with which the HIP begins to press
  double depth_m = 0.03;  // depth of the pressing HIP below the plane
};

// Replaces the content of points by the points of a frame, whose plane lies at that height.
using MakePoints = std::function<void(int frame, double height_m, std::vector<Vec3>& points)>;

// (4.20), for every frame
std::vector<double> heights(const MovingLift::Settings& scene) {
  const LiftMotion::Settings& lift = scene.lift;
  double velocity = lift.start_velocity_m_per_s, height = -lift.start_depth_m;
  std::vector<double> out{height};
  const auto frames = [&](double time_s) {
    return static_cast<int>(std::lround(time_s * scene.frame_rate_hz));
  };
  for (int j = 0; j < frames(lift.rise_s) + frames(lift.acceleration_s); ++j) {
    if (j >= frames(lift.rise_s)) velocity += lift.acceleration_m_per_s2 / scene.frame_rate_hz;
    out.push_back(height += velocity / scene.frame_rate_hz);
  }
  return out;
}

// Every point of the scene's grid with three normal deviates of its own, drawn anew for each frame.
MakePoints standard_noise(const MovingLift::Settings& scene, std::uint64_t seed) {
  return [scene, random = std::mt19937_64(seed), normal = std::normal_distribution<double>()](
             int, double height_m, std::vector<Vec3>& points) mutable {
    points.clear();
    for (int row = 0; row < scene.grid.rows; ++row)
      for (int column = 0; column < scene.grid.columns; ++column) {
        const double x = scene.grid.x(column) + scene.noise_sigma_m * normal(random);
        const double y = height_m + scene.noise_sigma_m * normal(random);
        const double z = scene.grid.z(row) + scene.noise_sigma_m * normal(random);
        points.emplace_back(x, y, z);
      }
  };
}

// Returns the proxy after every step. A tick has one step, with frame correction (4.3) and velocity estimate
// (4.13).
std::vector<Vec3> proxies(const Lift& lift, const MakePoints& make_points) {
  const std::vector<double> height_m = heights(lift.scene);
  const double interval_s = 1 / lift.scene.frame_rate_hz;
  Vec3 proxy_W = Vec3::Zero(), normal_W = Vec3::Zero();
  double velocity = 0;
  std::vector<Vec3> points, out;
  for (int frame = 0; frame < static_cast<int>(height_m.size()); ++frame) {
    const double height = height_m[static_cast<std::size_t>(frame)];
    make_points(frame, height, points);
    const Vec3 hip_W(0, frame < lift.press_frame ? 0 : height - lift.depth_m, 0);
    const Vec3 along = normal_W;
    proxy_W += velocity * interval_s * along;  // (4.3)
    for (int k = 0; k < lift.steps_per_frame; ++k) {
      const Step step = proxy_step(points, proxy_W, hip_W, normal_W, lift.proxy);
      normal_W = step.normal;
      if (k == 0 && frame > 0)
        velocity = std::max(0.0, velocity + along.dot(step.step) / interval_s);  // (4.13)
      proxy_W += step.step;
      out.push_back(proxy_W);
    }
  }
  return out;
}

// True if the last proxy lies below the plane of the last frame.
bool popped_through(const Lift& lift, const std::vector<Vec3>& proxies) {
  return proxies.back().y() < heights(lift.scene).back();
}

}  // namespace
}  // namespace remote_touch::naive

namespace remote_touch::benchmarks {
namespace {

struct Cell {
  Experiment experiment;
  naive::Lift lift;  // the same lift, for the plain method and at most 30 steps
};

class Map {
 public:
  const Sweep& sweep() const { return sweep_; }
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
  const Sweep sweep_ = Sweep::load("fig4.13", {"haptic_rate_hz=900", "renderer.steps_per_tick=1"});
  const SweepResult plan_ = sweep_.plan();
};

// One lift of each of 3 x 4 equal parts of the map: the middle of each part, or spread so that the edges of
// the map are met.
enum class Spread { middles, edges };

std::vector<Cell> sample(const Map& map, Spread spread) {
  const auto place = [&](std::size_t i, std::size_t parts, std::size_t axis) {
    const std::size_t length = map.length(axis);
    return spread == Spread::middles ? (2 * i + 1) * length / (2 * parts) : i * (length - 1) / (parts - 1);
  };
  std::vector<Cell> cells;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      cells.push_back(map.cell(place(row, 3, 0), place(column, 4, 1)));
  return cells;
}

// --- answers ---

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
  const std::size_t steps = noisy ? static_cast<std::size_t>(pressed) : plain_W.size();
  const Trace trace = simulate(cell.experiment);
  if (plain_W.size() != trace.length()) return false;
  for (std::size_t i = 0; i < steps; ++i)
    if (!((plain_W[i] - trace.proxy_position_m[i]).norm() < 1e-7)) return false;
  return true;
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

std::string measures_of(const Map& map, int threads) {
  omp_set_num_threads(threads);
  return digest(run_sweep(map.sweep(), {}).measures);
}

bool map_right(const Map& map, int threads) {
  if (threads > 1) return measures_of(map, threads) == measures_of(map, 1);
  for (const Cell& cell : sample(map, Spread::edges))
    if (!equals_plain(cell, kernels_for(best_isa()))) return false;
  return outcomes_are_known(map);
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const Map map;
  for (const int threads : {1, 2})
    add(
        "map/" + std::to_string(threads) + "/" + kernels_for(best_isa()).isa,
        [&map, threads] { return map_right(map, threads); },
        [&map, threads](benchmark::State& state) {
          for (auto _ : state) measures_of(map, threads);
        });
  const std::vector<Cell> cells = sample(map, Spread::middles);
  add("map_plain_12_lifts", [&cells](benchmark::State& state) {
    for (auto _ : state)
      for (const Cell& cell : cells) naive::proxies(cell.lift, naive::standard_noise(cell.lift.scene, 1));
  });
  return run_benchmarks(argc, argv);
}
