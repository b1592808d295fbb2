// Forbidden regions, chapter 5: one proxy step in each state, gathering, and whole ticks.
#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/dissertation/proxy/proxy_step.h"
#include "core/kernels/isa.h"
#include "core/search/neighbourhood.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/fixture_scene.h"
#include "tests/benchmarks/proxy_benchmark.h"

namespace remote_touch::benchmarks {
namespace {

// The mean stiffness is a quotient of sums of some thousand N/m, each term on a grid of 2e-7.
bool same(const naive::RegionStep& a, const naive::RegionStep& b) {
  return a.step.state == b.step.state &&
         std::abs(a.step.nearest_distance_m - b.step.nearest_distance_m) < 1e-15 &&
         (a.step.normal - b.step.normal).norm() < 1e-12 && (a.step.step - b.step.step).norm() < 1e-12 &&
         std::abs(a.stiffness - b.stiffness) < 1e-9 * b.stiffness;
}

// Steps as the renderer does: the list of points is kept while the proxy stays near.
class Stepper {
 public:
  Stepper(std::shared_ptr<const NeighbourSearch> search, const Kernels& kernels)
      : kernels_(kernels), near_(kSettings.r3_m, kernels) {
    near_.set_points(std::move(search));
  }
  naive::RegionStep operator()(const Vec3& proxy_W, const Vec3& hip_W) {
    const GatheredPoints& list = near_.around(proxy_W);
    listed_ = list.size();
    const ProxyRegions regions{kSettings.r1_m, kSettings.r2_m, kSettings.r3_m, near_.sum_grid(),
                               kSettings.stiffness_N_per_m};
    const ContactQuery query = kernels_.proxy.contact_query(list.view(), proxy_W.data(), regions);
    naive::Step out{classify(query.nearest, kSettings), query.nearest, unit_normal(query, Vec3::Zero())};
    const Vec3 u = hip_W - proxy_W;
    if (out.state == ContactState::contact)
      out.step = contact_step(out.normal, u, kSettings);
    else if (out.state == ContactState::entrenched)
      out.step = entrenched_step(list.view(), kernels_, proxy_W, out.normal, u, kSettings);
    else
      out.step = free_step(near_, proxy_W, u, kSettings);
    return {out, query.weight_sum > 0 ? query.stiffness_sum / query.weight_sum : kSettings.stiffness_N_per_m};
  }
  std::size_t listed() const { return listed_; }

 private:
  const Kernels& kernels_;
  Neighbourhood near_;
  std::size_t listed_ = 0;
};

bool steps_agree(const FixtureScene& scene, const FixtureSteps& steps, const Kernels& kernels) {
  Stepper step(scene.search, kernels);
  for (std::size_t i = 0; i < steps.expected.size(); ++i) {
    const naive::RegionStep& expected = steps.expected[i];
    const std::size_t at = i * kFixtureCheckEvery;
    if (expected.step.state != steps.state) return false;
    if (!same(step(steps.proxies[at], steps.hips[at]), expected)) return false;
  }
  return true;
}

void time_steps(benchmark::State& state, const FixtureScene& scene, const FixtureSteps& steps,
                const Kernels& kernels) {
  Stepper step(scene.search, kernels);
  naive::RegionStep last;
  std::size_t i = 0;
  double listed = 0;
  for (auto _ : state) {
    // The term 0.0 * last makes each step wait for the one before, as in step_benchmark.cpp.
    last = step(steps.proxies[i] + 0.0 * last.step.step, steps.hips[i]);
    if (++i == steps.proxies.size()) i = 0;
  }
  benchmark::DoNotOptimize(last);
  for (std::size_t k = 0; k < steps.proxies.size(); ++k)
    step(steps.proxies[k], steps.hips[k]), listed += static_cast<double>(step.listed());
  state.counters["listed"] = listed / static_cast<double>(steps.proxies.size());
}

bool ticks_agree(const FixtureScene& scene, const Kernels& kernels) {
  ProxyRenderer renderer(kSettings, kTickRate_hz, kernels);
  renderer.on_frame({0, 0, 0, scene.search});
  for (std::size_t i = 0; i < scene.expected_ticks.size(); ++i) {
    const double time_s = i / kTickRate_hz;
    const Vec3 hip_W = i == 0 ? fixture_hip_above() : fixture_hip_at(time_s);
    if ((renderer.step({hip_W}, time_s).proxy_W - scene.expected_ticks[i]).norm() > 1e-9) return false;
  }
  return true;
}

void time_ticks(benchmark::State& state, const FixtureScene& scene, const Kernels& kernels) {
  constexpr int kTicksOneWay = 250;
  ProxyRenderer renderer(kSettings, kTickRate_hz, kernels);
  renderer.on_frame({0, 0, 0, scene.search});
  renderer.step({fixture_hip_above()}, 0);
  for (int i = 0; i < 10; ++i) renderer.step({fixture_hip_at(0)}, 0);  // down to the surface
  int tick = 0, displacement = 1;
  double steps = 0;
  for (auto _ : state) {
    steps += renderer.step({fixture_hip_at(tick / kTickRate_hz)}, 0).steps;
    tick += displacement;
    if (tick == 0 || tick == kTicksOneWay) displacement = -displacement;
  }
  state.counters["steps"] = benchmark::Counter(steps, benchmark::Counter::kAvgIterations);
}

}  // namespace

void add_fixtures(const FixtureScene& scene) {
  add_query("fixture_gather", scene.search, scene);
  for (const Kernels* kernels : supported_kernels()) {
    const std::string of = "/" + scene.name + "/" + kernels->isa;
    for (const FixtureSteps& steps : scene.steps)
      add(
          "fixture_" + steps.name + of,
          [&scene, &steps, kernels] { return steps_agree(scene, steps, *kernels); },
          [&scene, &steps, kernels](benchmark::State& state) { time_steps(state, scene, steps, *kernels); });
    add(
        "fixture_tick" + of, [&scene, kernels] { return ticks_agree(scene, *kernels); },
        [&scene, kernels](benchmark::State& state) { time_ticks(state, scene, *kernels); });
  }
}

}  // namespace remote_touch::benchmarks
