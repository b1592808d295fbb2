// Measures the cost of the C interface of plug-ins: the proxy of chapter 4 built in, and the same code behind
// the interface, in pairs. The answers are first compared bit by bit. Prints the ratio of the times of a
// tick.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "runners/interfaces/plugins/plugin_library.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/support/scenes.h"

namespace {

using namespace remote_touch;

constexpr int kTicks = 500, kPairs = 400;

// A press, then a slide.
DeviceState hand(int tick) {
  return {Vec3(-0.03 + 1e-4 * tick, std::max(-0.005, 0.02 - 0.0005 * tick), 0)};
}

std::vector<RenderOutput> slide(Renderer& renderer, double start_s) {
  std::vector<RenderOutput> out;
  out.reserve(kTicks);
  for (int tick = 0; tick < kTicks; ++tick) out.push_back(renderer.step(hand(tick), start_s + 0.001 * tick));
  return out;
}

double slide_ns(Renderer& renderer, double start_s) {
  const double before = benchmarks::cpu_ns();
  slide(renderer, start_s);
  return (benchmarks::cpu_ns() - before) / kTicks;
}

bool same(const std::vector<RenderOutput>& a, const std::vector<RenderOutput>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const RenderOutput& x, const RenderOutput& y) {
    return x.force_N == y.force_N && x.proxy_W == y.proxy_W && x.steps == y.steps;
  });
}

}  // namespace

int main() {
  const auto plugged = load_plugin(PLUGIN_RENDERERS).front().make()->build(1000, scenes::kernels());
  ProxyRenderer built_in = scenes::renderer();
  for (Renderer* each : {static_cast<Renderer*>(&built_in), plugged.get()})
    each->on_frame(scenes::frame(scenes::flat_grid(100)));
  if (!same(slide(built_in, 0), slide(*plugged, 0))) {
    std::puts("the answers differ");
    return 1;
  }
  std::vector<double> ratios, ticks_ns;
  for (int pair = 0; pair < kPairs; ++pair) {
    const double start_s = 1.0 + pair;
    const bool first = pair % 2 == 0;  // neither is first in every pair
    const double a = first ? slide_ns(built_in, start_s) : 0;
    const double b = slide_ns(*plugged, start_s);
    const double own = first ? a : slide_ns(built_in, start_s);
    ratios.push_back(b / own), ticks_ns.push_back(own);
  }
  std::sort(ratios.begin(), ratios.end()), std::sort(ticks_ns.begin(), ticks_ns.end());
  const auto half = static_cast<std::size_t>(kPairs / 2), spread = static_cast<std::size_t>(kPairs / 20);
  std::printf(
      "plug-in / built in: %.4f (95 %% interval of the median %.4f to %.4f), tick %.0f ns, %d pairs\n",
      ratios[half], ratios[half - spread], ratios[half + spread], ticks_ns[half], kPairs);
  return 0;
}
