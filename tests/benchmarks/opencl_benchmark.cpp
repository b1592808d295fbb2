// Depth frames on every OpenCL device of this machine beside the same on the CPU, both with all threads, from
// a depth image in double to columns in double: with upload and download. The bits are compared first. On the
// processor's own device, pocl, this is the price of OpenCL and no measure of a GPU.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>
#include <memory>
#include <string>

#include "core/kernels/isa.h"
#include "runners/opencl/depth_device.h"
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
        double min_ms = std::numeric_limits<double>::infinity();
        for (auto _ : state) {
          const std::clock_t begin = std::clock();
          processor->process(scene.depth, scene.camera, kIdentity, *cloud);
          benchmark::ClobberMemory();
          min_ms = std::min(min_ms, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
        }
        // Of all threads of the process, and less disturbed by other programs than the time that passes.
        state.counters["min_cpu_ms"] = min_ms;
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
  for (const scenes::DepthScene& scene : made) {
    const std::string name =
        "depth_frame/" + std::to_string(scene.camera.width) + "x" + std::to_string(scene.camera.height);
    add_processor(name, scene, "cpu");
    for (const FoundDepthDevice& device : devices)
      if (device.is_usable()) add_processor(name, scene, device.address);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return mismatch_seen() ? 1 : 0;
}
