// Six degrees of freedom: the collision list, a step (one detection, one program, one motion) and whole ticks
// while the tool slides. Before they are timed, lists are compared with a plain loop over all points. Steps
// and ticks are compared, bit for bit, with those of the slowest instruction set level.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/tool/contact/contact_list.h"
#include "core/dissertation/tool/motion/look_ahead_motion.h"
#include "core/dissertation/tool/motion/tool_renderer.h"
#include "core/kernels/isa.h"
#include "core/search/neighbour_search.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/tool_landing.h"
#include "tests/benchmarks/tool_scene.h"
#include "tests/support/formatted.h"

namespace remote_touch::benchmarks {
namespace {

ToolParameters settings(ContactRule rule) {
  ToolParameters p;
  p.contact_rule = rule;
  return p;
}
const char* name_of(ContactRule rule) {
  switch (rule) {
    case ContactRule::voxels:
      return "voxels";
    case ContactRule::continuous:
      return "continuous";
    case ContactRule::look_ahead:
      break;
  }
  return "look-ahead";
}

// --- collision list ---

void add_list(const ToolScene& scene, const std::string& where, const ToolPose& pose) {
  for (const Kernels* kernels : supported_kernels()) {
    const auto finder = std::make_shared<TouchFinder>(scene.tool, *kernels);
    finder->on_frame(formatted<TiledCloud>(scene.cloud));
    add(
        "tool_list/" + scene.name + "_" + where + "/" + kernels->isa,
        [=, &scene] {
          for (int i = 0; i < 64; ++i)
            if (!list_right(*finder, scene, shaken(pose, i))) return false;
          return true;
        },
        [=](benchmark::State& state) {
          std::size_t found = 0;
          int i = 0;
          for (auto _ : state) {
            found = finder->in_tool(shaken(pose, i++)).size();
            benchmark::ClobberMemory();
          }
          state.counters["found"] = static_cast<double>(found);
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

// --- one step ---

struct Stepper {
  ContactList contacts;
  LookAheadProgram look_ahead;
  MotionProgram program;
  ContactRule rule;
  double reach_m;

  Stepper(const ToolScene& scene, ContactRule rule_, const Kernels& kernels)
      : contacts(scene.tool, settings(rule_), kernels),
        look_ahead(settings(rule_), *scene.tool, scene.tool->reach_m),
        program(settings(rule_), *scene.tool),
        rule(rule_),
        reach_m(scene.tool->reach_m) {
    contacts.on_frame(formatted<TiledCloud>(scene.cloud, used_merged_disk_m(settings(rule_))));
  }

  // Moves the tool by up to a millimetre down and along, as far as the points allow.
  ToolPose step(const ToolPose& pose, std::size_t& listed) {
    Vector6 desired;
    desired << 3e-4, -8e-4, 0, 0, 0, 0;
    return moved(pose, capped(motion(pose, desired, listed), reach_m, 1e-3));
  }

 private:
  Vector6 motion(const ToolPose& pose, const Vector6& desired, std::size_t& listed) {
    if (rule == ContactRule::look_ahead) {
      const LookAheadProgram::Detection detection = look_ahead.detect(pose, desired, contacts, 0);
      listed = detection.near.contacts.size();
      return detection.a_g;
    }
    const auto found = contacts.in_voxels(pose).contacts;
    listed = found.size();
    return rotated(pose.q_WT, program.solve(rotated(pose.q_WT.conjugate(), desired), found).a_g);
  }
};

void add_step(const ToolScene& scene, ContactRule rule) {
  for (const Kernels* kernels : supported_kernels()) {
    const auto stepper = std::make_shared<Stepper>(scene, rule, *kernels);
    add(
        "tool_step/" + scene.name + "_" + name_of(rule) + "/" + kernels->isa,
        [=, &scene] {
          Stepper slowest(scene, rule, kernels_for(Isa::x86_64));  // new, like stepper, with no earlier pose
          for (int i = 0; i < 64; ++i) {
            const ToolPose pose = shaken(scene.in_contact, i);
            std::size_t listed = 0, expected = 0;
            const bool same = stepper->step(pose, listed) == slowest.step(pose, expected);
            if (!same || listed != expected || listed == 0) return false;
          }
          return true;
        },
        [=, &scene](benchmark::State& state) {
          std::size_t listed = 0;
          int i = 0;
          for (auto _ : state) {
            const ToolPose pose = stepper->step(shaken(scene.in_contact, i++), listed);
            benchmark::DoNotOptimize(&pose);
          }
          state.counters["listed"] = static_cast<double>(listed);
        });
  }
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
  double detections = 0, steps = 0;
  int tick = 0;
  for (auto _ : state) {
    const RenderOutput out = least.time(tick, [&] { return ride.step(tick); });
    detections += out.tool->detections, steps += out.steps;
    tick = (tick + 1) % kSlideTicks;
  }
  using Counter = benchmark::Counter;
  state.counters["detections"] = Counter(detections, Counter::kAvgIterations);
  state.counters["steps"] = Counter(steps, Counter::kAvgIterations);
  least.count_slowest(state);
}

void add_ride(const ToolScene& scene, ContactRule rule) {
  const ToolParameters parameters = settings(rule);
  for (const Kernels* kernels : supported_kernels())
    add(
        "tool_tick/" + scene.name + "_" + name_of(rule) + "/" + kernels->isa,
        [=, &scene] { return rides_same(scene, parameters, *kernels); },
        [=, &scene](benchmark::State& state) { time_ride(state, scene, parameters, *kernels); });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const auto husky = generated_tool("husky");
  const std::vector<ToolScene> scenes = {tool_scene("1089", husky, 33, 3e-3),
                                         tool_scene("2500", husky, 50, 2e-3),
                                         tool_scene("40000", husky, 200, 1e-3),
                                         tool_scene("40000_dense", husky, 200, 5e-4),
                                         tool_scene("111556_dense", husky, 334, 3e-4),
                                         tool_scene("40000_slab", generated_tool("slab-20"), 200, 5e-4),
                                         tool_scene("111556_slab", generated_tool("slab-20"), 334, 3e-4)};
  for (const ToolScene& scene : scenes) {
    add_list(scene, "contact", scene.in_contact);
    add_list(scene, "separated", scene.separated);
    for (const ContactRule rule : {ContactRule::look_ahead, ContactRule::voxels}) {
      add_step(scene, rule);
      add_ride(scene, rule);
    }
    add_landing(scene, settings(ContactRule::look_ahead), name_of(ContactRule::look_ahead));
  }
  const auto outer = generated_tool("husky", true);
  const std::vector<ToolScene> outer_scenes = {tool_scene("2500", outer, 50, 2e-3),
                                               tool_scene("40000", outer, 200, 1e-3),
                                               tool_scene("111556_dense", outer, 334, 3e-4)};
  for (const ToolScene& scene : outer_scenes) {
    add_ride(scene, ContactRule::continuous);
    add_landing(scene, settings(ContactRule::continuous), name_of(ContactRule::continuous));
  }
  return run_benchmarks(argc, argv);
}
