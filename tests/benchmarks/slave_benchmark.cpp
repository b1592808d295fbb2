// A tick of the slave robot: a ball, and tools of up to 100 points, clear of the true surface of a scene
// and pressed onto it. Before it is timed, the force is compared with that of the
// drive, which balances it at rest.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "core/kernels/isa.h"
#include "core/teleoperation/tool_slave.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/tool_files/tool_loading.h"
#include "tests/benchmarks/checked_benchmark.h"

namespace remote_touch::benchmarks {
namespace {

constexpr double kTick_s = 0.001;
constexpr int kSettling = 3000;  // ticks, during which the surface stands still

struct Touched {
  std::string name;
  std::shared_ptr<const Scenario> scenario;

  SlaveScene scene() const {
    return {[s = scenario.get()](const Vec3& p, double t) { return s->signed_distance(p, t); },
            [s = scenario.get()](const Vec3& p, double t) { return s->true_normal(p, t); }};
  }
};

Touched touched(const std::string& name, const std::string& shape) {
  const Experiment e = Experiment::from_json(
      R"({"scenario": {"name": "moving-shape", "shape": ")" + shape +
          R"("}, "renderer": {"name": "proxy"}, "trajectory": {"name": "waypoints"}, "duration_s": 1})",
      name);
  return {name, std::shared_ptr<const Scenario>(e.build_scenario(kernels_for(Isa::x86_64)))};
}

struct Ball {
  Slave slave;
  void move(double y, double time_s) { slave.move(Vec3(0, y, 0), time_s); }
  const Slave::State& state() const { return slave.state(); }
};
struct Tool {
  ToolSlave slave;
  void move(double y, double time_s) { slave.move({Vec3(0, y, 0)}, time_s); }
  const Slave::State& state() const { return slave.state(); }
};

// make: returns the robot. Commands its height over the origin.
template <class Make>
void add_ticks(const std::string& name, const Make& make, double height_m) {
  const auto settled = [=] {
    auto robot = make();
    for (int i = 0; i < kSettling; ++i) robot.move(i < 100 ? 0.1 : height_m, i * kTick_s);
    return robot;
  };
  const auto is_right = [=] {
    const auto robot = settled();
    const double w = 2 * std::numbers::pi * SlaveSettings{}.natural_frequency_hz;
    const double drive_N = SlaveSettings{}.mass_kg * w * w * (robot.state().position_W.y() - height_m);
    return std::abs(drive_N - robot.state().force_N.y()) < 0.01 + 0.01 * drive_N;
  };
  add(name, is_right, [=](benchmark::State& state) {
    auto robot = settled();
    int tick = kSettling;
    for (auto _ : state) robot.move(height_m, kTick_s * tick++);
    state.counters["force_N"] = robot.state().force_N.y();
  });
}

void add_scene(const Touched& touched) {
  for (const double height_m : {0.1, -0.01}) {
    const std::string where = touched.name + (height_m > 0 ? "/clear" : "/pressed");
    add_ticks(
        "slave/ball/" + where, [=] { return Ball{Slave({}, kTick_s, touched.scene())}; }, height_m);
    for (const char* mesh : {"slab-10", "husky"}) {
      const auto made = load_tool({.mesh = mesh});
      const SlaveTool tool = make_slave_tool(made->mesh, made->inertia_m2);
      add_ticks(
          "slave/" + std::string(mesh) + "-" + std::to_string(tool.points_T.size()) + "/" + where,
          [=] { return Tool{ToolSlave({}, tool, kTick_s, touched.scene())}; }, height_m);
    }
  }
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch::benchmarks;
  add_scene(touched("plane", "flat"));
  add_scene(touched("sphere", "sphere"));
  return run_benchmarks(argc, argv);
}
