#include "tests/benchmarks/tool_landing.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "core/dissertation/tool/motion/tool_renderer.h"
#include "core/kernels/isa.h"
#include "core/search/neighbour_search.h"
#include "tests/benchmarks/checked_benchmark.h"

namespace remote_touch::benchmarks {
namespace {

constexpr double kRise_m = 4e-3;
constexpr int kTicksUp = 20, kTicks = 2 * kTicksUp;  // the surface is up for as long as it is down

Frame frame_at(const ToolScene& scene, double height_m) {
  PointCloud cloud = scene.cloud;
  for (double& y : cloud.y) y += height_m;
  return {0, 0, 0, make_search(cloud)};
}

class Landing {
 public:
  Landing(const ToolScene& scene, const ToolParameters& parameters, const Kernels& kernels)
      : device_(device_at(scene, 0)),
        renderer_(parameters, scene.tool, kernels),
        down_(frame_at(scene, 0)),
        up_(frame_at(scene, kRise_m)) {
    for (Frame* frame : {&down_, &up_}) renderer_.prepare(*frame);  // the camera's thread does so
    ToolPose above = scene.in_contact;
    above.p_W.y() += 0.02;
    send(down_);
    step(above);
    for (int i = 0; i < kTicksUp; ++i) step(device_);
  }
  // tick is 0 .. kTicks - 1, in turn. Tick 0 receives the frame that lands in the tool.
  RenderOutput tick(int tick) {
    if (tick == 0) send(up_);
    if (tick == kTicksUp) send(down_);
    return step(device_);
  }

 private:
  void send(Frame& frame) {
    frame.index = sent_++;
    frame.captured_s = frame.arrives_s = frame.index / 30.0;
    renderer_.on_frame(frame);
  }
  RenderOutput step(const ToolPose& device) { return renderer_.step({device.p_W, device.q_WT}, 0); }

  const ToolPose device_;
  ToolRenderer renderer_;
  Frame down_, up_;
  int sent_ = 0;
};

// The result is the same on every level, and the tool comes up with the surface.
bool lands_same(const ToolScene& scene, const ToolParameters& parameters, const Kernels& kernels) {
  Landing landing(scene, parameters, kernels), slowest(scene, parameters, kernels_for(Isa::x86_64));
  double lowest_m = std::numeric_limits<double>::infinity(), highest_m = -lowest_m;
  for (int tick = 0; tick < 2 * kTicks; ++tick) {
    const RenderOutput a = landing.tick(tick % kTicks), b = slowest.tick(tick % kTicks);
    if (a.proxy_W != b.proxy_W || a.force_N != b.force_N || a.contact_count != b.contact_count) return false;
    lowest_m = std::min(lowest_m, a.proxy_W.y()), highest_m = std::max(highest_m, a.proxy_W.y());
  }
  return highest_m - lowest_m > 0.9 * kRise_m;
}

void time_landing(benchmark::State& state, const ToolScene& scene, const ToolParameters& parameters,
                  const Kernels& kernels) {
  Landing landing(scene, parameters, kernels);
  LeastTimes least(kTicks);
  for (auto _ : state)
    for (int tick = 0; tick < kTicks; ++tick) least.time(tick, [&] { return landing.tick(tick); });
  state.counters["landing_ns"] = least.ns.front();
  state.counters["after_ns"] = *std::max_element(least.ns.begin() + 1, least.ns.begin() + kTicksUp);
}

}  // namespace

void add_landing(const ToolScene& scene, const ToolParameters& parameters, const char* rule) {
  for (const Kernels* kernels : supported_kernels())
    add(
        "tool_landing/" + scene.name + "_" + rule + "/" + kernels->isa,
        [=, &scene] { return lands_same(scene, parameters, *kernels); },
        [=, &scene](benchmark::State& state) { time_landing(state, scene, parameters, *kernels); });
}

}  // namespace remote_touch::benchmarks
