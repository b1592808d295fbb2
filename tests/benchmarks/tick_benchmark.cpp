// Whole ticks of the renderer.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/kernels/isa.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/proxy_benchmark.h"

namespace remote_touch::benchmarks {
namespace {

bool ticks_agree(const Slide& slide, const Kernels& kernels) {
  ProxyRenderer renderer(kSettings, kTickRate_hz, kernels);
  renderer.on_frame({0, 0, 0, slide.search});
  for (std::size_t i = 0; i < kCheckedTicks; ++i) {
    const double time_s = i / kTickRate_hz;
    const Vec3 hip_W = i == 0 ? slide.above : hip_at(slide, time_s);
    if ((renderer.step({hip_W}, time_s).proxy_W - slide.expected_ticks[i]).norm() > 1e-9) return false;
  }
  return true;
}

ProxyParameters stepping(double gamma, int steps_per_tick) {
  ProxyParameters p = kSettings;
  p.gamma = gamma, p.steps_per_tick = steps_per_tick;
  return p;
}

// Returns the position where the proxy rests after a slide of 20 mm.
Vec3 rest_of(const Slide& slide, const ProxyParameters& parameters, const Kernels& kernels) {
  constexpr int kSlideTicks = 200, kRestTicks = 40;
  ProxyRenderer renderer(parameters, kTickRate_hz, kernels);
  renderer.on_frame({0, 0, 0, slide.search});
  renderer.step({slide.above}, 0);
  RenderOutput out;
  for (int tick = 0; tick < kSlideTicks + kRestTicks; ++tick)
    out = renderer.step({hip_at(slide, std::min(tick, kSlideTicks) / kTickRate_hz)}, 0);
  return out.proxy_W;
}

// The rest position may depend on the way to it, by as much as the contact region is thick.
bool rests_agree(const Slide& slide, const ProxyParameters& parameters, const Kernels& kernels) {
  const Vec3 limit_W = rest_of(slide, stepping(kSettings.gamma, 1000), kernels);
  return (rest_of(slide, parameters, kernels) - limit_W).norm() < parameters.r2_m - parameters.r1_m;
}

void time_ticks(benchmark::State& state, const Slide& slide, const ProxyParameters& parameters,
                const Kernels& kernels) {
  constexpr int kTicksOneWay = 500;
  ProxyRenderer renderer(parameters, kTickRate_hz, kernels);
  renderer.on_frame({0, 0, 0, slide.search});
  renderer.step({slide.above}, 0);
  for (int i = 0; i < 10; ++i) renderer.step({slide.start}, 0);  // down to the surface
  int tick = 0, displacement = 1;
  double steps = 0, in_contact = 0;
  for (auto _ : state) {
    const RenderOutput out = renderer.step({hip_at(slide, tick / kTickRate_hz)}, 0);
    steps += out.steps;
    in_contact += out.state == ContactState::contact ? 1 : 0;
    tick += displacement;
    if (tick == 0 || tick == kTicksOneWay) displacement = -displacement;
  }
  using Counter = benchmark::Counter;
  state.counters["steps"] = Counter(steps, Counter::kAvgIterations);
  state.counters["in_contact"] = Counter(in_contact, Counter::kAvgIterations);
  state.counters["s_per_step"] = Counter(steps, Counter::kIsRate | Counter::kInvert);
}

}  // namespace

void add_ticks(const Slide& slide) {
  for (const Kernels* kernels : supported_kernels()) {
    add(
        "tick/" + slide.name + "/" + kernels->isa, [&slide, kernels] { return ticks_agree(slide, *kernels); },
        [&slide, kernels](benchmark::State& state) { time_ticks(state, slide, kSettings, *kernels); });
    for (const ProxyParameters& fewer : {stepping(0.3, 10), stepping(0.5, 8)})
      add(
          "tick_of_" + std::to_string(fewer.steps_per_tick) + "_steps/" + slide.name + "/" + kernels->isa,
          [&slide, fewer, kernels] { return rests_agree(slide, fewer, *kernels); },
          [&slide, fewer, kernels](benchmark::State& state) { time_ticks(state, slide, fewer, *kernels); });
  }
}

}  // namespace remote_touch::benchmarks
