// Depth frames on every OpenCL device of this machine, beside the same frames on the CPU, both with all
// threads. They are timed from a depth image in double to columns in double, and from a sensor's frame to the
// renderer's, with upload and download. The bits are compared first. The times on pocl, the processor's own
// device, show the cost of OpenCL and not the speed of a GPU.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/kernels/isa.h"
#include "runners/experiment/catalog/frame_stream.h"
#include "runners/experiment/opencl/depth_device.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/support/depth_scenes.h"

namespace remote_touch::benchmarks {
namespace {

const RigidTransform kIdentity = RigidTransform::Identity();

bool same_columns(const PointCloud& a, const PointCloud& b) {
  const auto same = [](const std::vector<double>& one, const std::vector<double>& other) {
    return one.size() == other.size() &&
           std::memcmp(one.data(), other.data(), one.size() * sizeof(double)) == 0;
  };
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z) && same(a.nx, b.nx) && same(a.ny, b.ny) &&
         same(a.nz, b.nz);
}

template <class Work>
void measure(benchmark::State& state, const Work& work) {
  double min_ms = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    const std::clock_t begin = std::clock();
    work();
    benchmark::ClobberMemory();
    min_ms = std::min(min_ms, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  // This is the processor time of all threads of the process. Other programs disturb it less than wall-clock
  // time.
  state.counters["min_cpu_ms"] = min_ms;
}

void add_processor(const std::string& name, const scenes::DepthScene& scene, const std::string& device) {
  DepthDeviceSettings settings;
  settings.device = device;
  const std::shared_ptr<DepthProcessor> processor = make_depth_processor(
      settings, kernels_for(best_isa()), [](const std::string& line) { std::puts(line.c_str()); });
  const auto cloud = std::make_shared<PointCloud>();
  add(
      name + "/" + device,
      [=, &scene] {
        processor->process(scene.depth, scene.camera, kIdentity, *cloud);
        const auto expected = make_depth_processor({}, kernels_for(best_isa()), nullptr)
                                  ->process(scene.depth, scene.camera, kIdentity);
        return same_columns(*cloud, expected);
      },
      [=, &scene](benchmark::State& state) {
        measure(state, [&] { processor->process(scene.depth, scene.camera, kIdentity, *cloud); });
      });
}

// A frame of a sensor on its way to the renderer in a live run: 16-bit depths, colours, two rules by hue, and
// the search structure. The CPU also makes the cloud of the image, which a device makes for itself.
struct LiveFrames {
  SensorView view;
  SensorFrame sensed;
};

LiveFrames live_frames(const scenes::DepthScene& scene) {
  LiveFrames made;
  made.view.camera = scene.camera, made.view.has_colour = true;
  std::uint32_t colour = 1;
  for (const double z_m : scene.depth.z_m) {
    made.sensed.depth.push_back(static_cast<std::uint16_t>(z_m / made.view.metres_per_unit));
    made.sensed.colour.push_back((colour = colour * 1664525u + 1013904223u) >> 8);
  }
  return made;
}

FrameProcessing processing_on(const std::string& device) {
  DepthDeviceSettings settings;
  settings.device = device;
  HueRange::Settings red, yellow;
  yellow.from_deg = 35, yellow.to_deg = 80, yellow.values.stiffness_N_per_m = 300;
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  rules.push_back(std::make_unique<HueRange>(red)), rules.push_back(std::make_unique<HueRange>(yellow));
  return {make_depth_processor(settings, kernels_for(best_isa()), nullptr),
          FixtureAssignment(std::move(rules))};
}

void add_live(const std::string& name, const LiveFrames& frames, const std::string& device) {
  const auto processing = std::make_shared<const FrameProcessing>(processing_on(device));
  const auto filled = [&frames](const FrameProcessing& by) {
    Frame frame;
    by.fill(frame, frames.sensed, frames.view, kIdentity, 0);
    return frame;
  };
  add(
      name + "/" + device,
      [=] {
        const auto hash = [&](const FrameProcessing& by) {
          return frame_hash(dynamic_cast<const CloudSearch&>(*filled(by).points).cloud(), 0);
        };
        return hash(*processing) == hash(processing_on("cpu"));
      },
      [=](benchmark::State& state) {
        measure(state, [&] { benchmark::DoNotOptimize(filled(*processing)); });
      });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  std::string why_none;
  const auto devices = try_depth_devices(kernels_for(best_isa()), why_none);
  if (!why_none.empty()) std::printf("no OpenCL device: %s\n", why_none.c_str());
  std::vector<scenes::DepthScene> made;
  for (const auto& [width, height] : {std::pair{640, 480}, {1280, 720}}) {
    made.push_back(scenes::waves(scenes::kinect(width, height), 0.8, 0.015, 0.12));
    scenes::add_noise(made.back().depth, 0.0015, 1);
  }
  std::vector<LiveFrames> sensed;
  for (const scenes::DepthScene& scene : made) sensed.push_back(live_frames(scene));
  for (std::size_t i = 0; i < made.size(); ++i) {
    const scenes::DepthScene& scene = made[i];
    const std::string size = std::to_string(scene.camera.width) + "x" + std::to_string(scene.camera.height);
    const std::string name = "depth_frame/" + size, live = "live_frame/" + size;
    add_processor(name, scene, "cpu"), add_live(live, sensed[i], "cpu");
    for (const FoundDepthDevice& device : devices)
      if (device.is_usable())
        add_processor(name, scene, device.address), add_live(live, sensed[i], device.address);
  }
  return run_benchmarks(argc, argv);
}
