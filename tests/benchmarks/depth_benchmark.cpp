// A depth frame of 640 x 480 pixels, all valid, is turned into a cloud with normals: windows of 9 x 9 pixels,
// from a depth image in double to columns in double. Before it is timed, every answer is compared with the
// plain double reference.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <memory>
#include <string>

#include "core/kernels/kernels.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/core/dissertation/depth/reference_depth_pipeline.h"
#include "tests/support/depth_scenes.h"

namespace remote_touch::benchmarks {
namespace {

const RigidTransform kIdentity = RigidTransform::Identity();

struct Expected {
  scenes::DepthScene scene = scenes::waves(scenes::kinect(), 0.8, 0.015, 0.12);
  ReferenceDepth depth = {};
};

Expected expected() {
  Expected made;
  scenes::add_noise(made.scene.depth, 0.0015, 1);
  made.depth = reference_depth_pipeline({}, made.scene.depth, made.scene.camera, kIdentity);
  return made;
}

// The tolerances are 2 micrometres and 0.05 degrees. A normal is not compared if two eigenvalues are almost
// the same.
bool near(const PointCloud& cloud, const ReferenceDepth& of) {
  constexpr double kClearGap = 2e-3;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 n = cloud.normal(i), m = of.cloud.normal(i);
    const bool same_normal = n.cross(m).norm() < 0.05 * 3.14159 / 180 && n.dot(m) > 0;
    if (of.gap[i] > kClearGap && !same_normal) return false;
    if (!((cloud.point(i) - of.cloud.point(i)).norm() < 2e-6)) return false;
  }
  return cloud.size() == of.cloud.size();
}

void add_depth(const Expected& of, int threads, const Kernels& kernels) {
  const auto pipeline = std::make_shared<DepthPipeline>(DepthPipelineSettings{}, kernels);
  const auto cloud = std::make_shared<PointCloud>();
  const auto process = [=, &of] {
    omp_set_num_threads(threads);
    pipeline->process(of.scene.depth, of.scene.camera, kIdentity, *cloud);
  };
  add(
      "depth_frame/" + std::to_string(threads) + "/" + kernels.isa,
      [=, &of] {
        process();
        return near(*cloud, of.depth);
      },
      [=](benchmark::State& state) {
        for (auto _ : state) {
          process();
          benchmark::ClobberMemory();
        }
      });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const Expected of = expected();
  for (const Kernels* kernels : supported_kernels())
    for (const int threads : {1, 2}) add_depth(of, threads, *kernels);
  add("depth_plain", [&](benchmark::State& state) {
    for (auto _ : state)
      benchmark::DoNotOptimize(
          reference_depth_pipeline({}, of.scene.depth, of.scene.camera, kIdentity).cloud.x.data());
  });
  return run_benchmarks(argc, argv);
}
