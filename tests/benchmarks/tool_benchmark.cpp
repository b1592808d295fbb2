// Six degrees of freedom: the collision list, and whole ticks by two contact rules while the tool slides.
// Before they are timed, lists are compared with a plain loop over all points, and ticks, bit for bit, with
// those of the slowest instruction set level.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/kernels/kernels.h"
#include "core/points/neighbour_search.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/tool_scene.h"
#include "tests/support/cloud_form.h"

namespace remote_touch::benchmarks {
namespace {

// --- collision list ---

void add_list(const ToolScene& scene, const std::string& where, const ToolPose& pose) {
  for (const Kernels* kernels : supported_kernels()) {
    const auto finder = std::make_shared<TouchFinder>(scene.tool, *kernels);
    finder->on_frame(in_form<TiledCloud>(scene.cloud));
    add(
        "tool_list/" + scene.name + "_" + where + "/" + kernels->isa,
        [=, &scene] {
          for (int i = 0; i < 64; ++i)
            if (!list_right(*finder, scene, shaken(pose, i))) return false;
          return true;
        },
        [=](benchmark::State& state) {
          int i = 0;
          for (auto _ : state) {
            finder->in_tool(shaken(pose, i++));
            benchmark::ClobberMemory();
          }
        });
  }
  add("tool_list_naive/" + scene.name + "_" + where, [=, &scene](benchmark::State& state) {
    int i = 0;
    for (auto _ : state) {
      const auto found = naive_list(*scene.tool, scene.cloud, shaken(pose, i++));
      benchmark::DoNotOptimize(found.data());
    }
  });
}

// --- whole ticks ---

class Ride {
 public:
  Ride(const ToolScene& scene, const ToolParameters& parameters, const Kernels& kernels)
      : scene_(scene), renderer_(parameters, scene.tool, kernels) {
    ToolPose above = scene.in_contact;
    above.p_W.y() += 0.02;
    renderer_.on_frame({0, 0, 0, make_search(scene.cloud)});
    step(above);
    for (int i = 0; i < 20; ++i) step(device_at(scene, 0));
  }
  RenderOutput step(int tick) { return step(device_at(scene_, tick)); }

 private:
  RenderOutput step(const ToolPose& device) { return renderer_.step({device.p_W, device.q_WT}, 0); }

  const ToolScene& scene_;
  ToolRenderer renderer_;
};

bool rides_same(const ToolScene& scene, const ToolParameters& parameters, const Kernels& kernels) {
  Ride ride(scene, parameters, kernels), slowest(scene, parameters, kernels_for(Isa::x86_64));
  int touching = 0;
  for (int tick = 0; tick < kSlideTicks; ++tick) {
    const RenderOutput a = ride.step(tick), b = slowest.step(tick);
    if (a.proxy_W != b.proxy_W || a.force_N != b.force_N || a.nearest_distance_m != b.nearest_distance_m ||
        a.tool->orientation_W.coeffs() != b.tool->orientation_W.coeffs() ||
        a.contact_count != b.contact_count)
      return false;
    touching += a.force_N.norm() > 1 ? 1 : 0;
  }
  return touching == kSlideTicks;
}

// Least times above the mean are also due to the work, not to the machine.
void time_ride(benchmark::State& state, const ToolScene& scene, const ToolParameters& parameters,
               const Kernels& kernels) {
  Ride ride(scene, parameters, kernels);
  for (int tick = 0; tick < kSlideTicks; ++tick) ride.step(tick);  // first slide; all later ones are alike
  LeastTimes least(kSlideTicks);
  int tick = 0;
  for (auto _ : state) {
    least.time(tick, [&] { return ride.step(tick); });
    tick = (tick + 1) % kSlideTicks;
  }
  least.count_slowest(state);
}

void add_ride(const ToolScene& scene, const std::string& rule, ContactRule contact_rule) {
  ToolParameters parameters;
  parameters.contact_rule = contact_rule;
  for (const Kernels* kernels : supported_kernels())
    add(
        "tool_tick/" + scene.name + "_" + rule + "/" + kernels->isa,
        [=, &scene] { return rides_same(scene, parameters, *kernels); },
        [=, &scene](benchmark::State& state) { time_ride(state, scene, parameters, *kernels); });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const auto husky = generated_tool("husky"), outer = generated_tool("husky", true);
  const auto clouds = [](const std::shared_ptr<const VoxelTool>& tool) -> std::vector<ToolScene> {
    return {tool_scene("2500", tool, 50, 2e-3), tool_scene("40000", tool, 200, 1e-3),
            tool_scene("111556", tool, 334, 3e-4)};
  };
  const std::vector<ToolScene> scenes = clouds(husky), outer_scenes = clouds(outer);
  const ToolScene slab = tool_scene("111556_slab", generated_tool("slab-20"), 334, 3e-4);
  add_list(scenes.front(), "contact", scenes.front().in_contact);
  add_list(scenes.front(), "separated", scenes.front().separated);
  for (const ToolScene& scene : scenes) add_ride(scene, "look-ahead", ContactRule::look_ahead);
  add_ride(slab, "look-ahead", ContactRule::look_ahead);
  for (const ToolScene& scene : outer_scenes) add_ride(scene, "continuous", ContactRule::continuous);
  return run_benchmarks(argc, argv);
}
