// Normals compared with those of PCL and OpenCV: one scene with known normals and 1.5 mm of noise. The others
// receive the points as measured; ours is the filter and the normals. Before a method is timed, its normals
// are compared with the true ones; it also reports their rms angle.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"
#include "core/kernels/kernels.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/peers/peer_depth.h"
#include "tests/support/depth_scenes.h"

namespace remote_touch::benchmarks {
namespace {

const RigidTransform kIdentity = RigidTransform::Identity();
constexpr int kRim = 12;  // width of the image's border, whose pixels are not judged
// Normals that follow the surface at all. Directions at random are 57 degrees apart on average.
constexpr double kMostError_deg = 30, kLeastFraction = 0.5;

using NormalAt = std::function<Vec3(std::size_t)>;

// The root of the mean square of the angles to the true normals, over the pixels inside the rim that have a
// normal; infinite if these are too few. The sign of a normal does not matter.
double rms_deg(const scenes::DepthScene& truth, const NormalAt& normal_at) {
  double sum = 0, count = 0, all = 0;
  for (int v = kRim; v < truth.camera.height - kRim; ++v)
    for (int u = kRim; u < truth.camera.width - kRim; ++u, ++all) {
      const auto i = static_cast<std::size_t>(v * truth.camera.width + u);
      const Vec3 n = normal_at(i), expected = truth.normals[i];
      const double angle = std::atan2(n.cross(expected).norm(), std::abs(n.dot(expected)));
      if (!std::isnan(angle)) sum += angle * angle, ++count;
    }
  if (count < kLeastFraction * all) return std::numeric_limits<double>::infinity();
  return std::sqrt(sum / count) * 180 / 3.14159265358979323846;
}

void add_normals(const std::string& name, const std::function<void()>& run,
                 const std::function<double()>& error_deg) {
  add(
      name,
      [=] {
        run();
        return error_deg() < kMostError_deg;
      },
      [=](benchmark::State& state) {
        omp_set_num_threads(1);
        for (auto _ : state) run();
        state.counters["rms_deg"] = error_deg();
      });
}

peers::OrganisedPoints organised(const PointCloud& cloud) {
  const CameraIntrinsics& camera = cloud.image->camera;
  peers::OrganisedPoints points{camera.width, camera.height, camera.fx, camera.cx, camera.cy, {}};
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (const double x : {cloud.x[i], cloud.y[i], cloud.z[i]}) points.xyz.push_back(static_cast<float>(x));
  return points;
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const scenes::DepthScene truth = scenes::waves(scenes::kinect(), 0.8, 0.02, 0.3);
  DepthImage depth = truth.depth;
  scenes::add_noise(depth, 0.0015, 1);
  for (const Kernels* kernels : supported_kernels()) {
    const auto pipeline = std::make_shared<DepthPipeline>(DepthPipelineSettings{}, *kernels);
    const auto cloud = std::make_shared<PointCloud>();
    add_normals(
        std::string("normals/ours/") + kernels->isa,
        [=, &truth, &depth] { pipeline->process(depth, truth.camera, kIdentity, *cloud); },
        [=, &truth] { return rms_deg(truth, [&](std::size_t i) { return cloud->normal(i); }); });
  }
  for (const peers::Peer& peer :
       peers::normals_of_others(organised(cloud_from_depth(depth, truth.camera, kIdentity))))
    add_normals("normals/" + peer.name, peer.run, [&truth, result = peer.result] {
      const std::vector<float> n = result();
      return rms_deg(truth, [&](std::size_t i) { return Vec3(n[3 * i], n[3 * i + 1], n[3 * i + 2]); });
    });
  return run_benchmarks(argc, argv);
}
