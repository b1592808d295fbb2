// A depth frame of 640 x 480 pixels, all valid, is turned into a cloud with normals: windows of 9 x 9 pixels,
// from a depth image in double to columns in double. Before it is timed, every answer is compared with the
// plain double reference, and that of the region with the whole frame's.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <memory>
#include <string>

#include "core/kernels/isa.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/core/dissertation/depth/reference_depth_pipeline.h"
#include "tests/support/depth_scenes.h"

namespace remote_touch::benchmarks {
namespace {

const RigidTransform kIdentity = RigidTransform::Identity();
constexpr PixelRectangle kRegion{295, 215, 50, 50};  // 2500 points

struct Expected {
  scenes::DepthScene scene;
  ReferenceDepth filtered, measured;  // results with the filter and without it
};

Expected expected() {
  Expected made{scenes::waves(scenes::kinect(), 0.8, 0.015, 0.12), {}, {}};
  scenes::add_noise(made.scene.depth, 0.0015, 1);
  DepthPipelineSettings settings;
  made.filtered = reference_depth_pipeline(settings, made.scene.depth, made.scene.camera, kIdentity);
  settings.filter = false;
  made.measured = reference_depth_pipeline(settings, made.scene.depth, made.scene.camera, kIdentity);
  return made;
}

// The tolerances are 2 micrometres and 0.05 degrees. A normal is not compared if two eigenvalues are almost
// the same.
bool near(const PointCloud& cloud, const PixelRectangle& at, const ReferenceDepth& of) {
  const PointCloud& reference = of.cloud;
  constexpr double kClearGap = 2e-3;
  for (int v = 0; v < at.height; ++v)
    for (int u = 0; u < at.width; ++u) {
      const auto i = static_cast<std::size_t>(v * at.width + u);
      const auto j = static_cast<std::size_t>((at.top + v) * reference.image->camera.width + at.left + u);
      const Vec3 n = cloud.normal(i), m = reference.normal(j);
      const bool same_normal = n.cross(m).norm() < 0.05 * 3.14159 / 180 && n.dot(m) > 0;
      if (of.gap[j] > kClearGap && !same_normal) return false;
      if (!((cloud.point(i) - reference.point(j)).norm() < 2e-6)) return false;
    }
  return true;
}

void add_depth(const Expected& of, const std::string& name, bool filter, const PixelRectangle& at,
               int threads, const Kernels& kernels) {
  DepthPipelineSettings settings;
  settings.filter = filter;
  const auto pipeline = std::make_shared<DepthPipeline>(settings, kernels);
  const auto cloud = std::make_shared<PointCloud>();
  const auto process = [=, &of] {
    omp_set_num_threads(threads);
    pipeline->process(of.scene.depth, of.scene.camera, kIdentity, at, *cloud);
  };
  add(
      name + "/" + std::to_string(threads) + "/" + kernels.isa,
      [=, &of] {
        process();
        return near(*cloud, at, filter ? of.filtered : of.measured);
      },
      [=](benchmark::State& state) {
        for (auto _ : state) {
          process();
          benchmark::ClobberMemory();
        }
      });
}

void add_reference(const Expected& of) {
  add("depth_plain", [&](benchmark::State& state) {
    for (auto _ : state) {
      const ReferenceDepth made = reference_depth_pipeline({}, of.scene.depth, of.scene.camera, kIdentity);
      benchmark::DoNotOptimize(made.cloud.x.data());
    }
  });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const Expected of = expected();
  const PixelRectangle whole{0, 0, of.scene.camera.width, of.scene.camera.height};
  for (const Kernels* kernels : supported_kernels()) {
    for (const int threads : {1, 2}) {
      add_depth(of, "depth_frame", true, whole, threads, *kernels);
      add_depth(of, "depth_normals", false, whole, threads, *kernels);
    }
    add_depth(of, "depth_region", true, kRegion, 1, *kernels);
  }
  add_reference(of);
  return run_benchmarks(argc, argv);
}
