// Filters and normals compared with those of PCL and OpenCV: one scene with known normals and 1.5 mm of
// noise. The rms angle to the truth is reported beside each time. raw: every method receives the points as
// measured (ours without its filter); filtered: all receive our filtered points; both: our filter and our
// normals.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"
#include "core/kernels/isa.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/peers/peer_depth.h"
#include "tests/benchmarks/peers/peer_points.h"
#include "tests/support/depth_scenes.h"

namespace remote_touch::benchmarks {
namespace {

const RigidTransform kIdentity = RigidTransform::Identity();
constexpr int kRim = 12;  // width of the image's border, whose pixels are not judged

// Reports the root of the mean square of error(i) over the pixels inside the rim that have a number, and
// their fraction.
template <class Error>
void report(benchmark::State& state, const CameraIntrinsics& camera, const std::string& unit,
            const Error& error) {
  double sum = 0, count = 0, all = 0;
  for (int v = kRim; v < camera.height - kRim; ++v)
    for (int u = kRim; u < camera.width - kRim; ++u, ++all) {
      const double e = error(static_cast<std::size_t>(v * camera.width + u));
      if (!std::isnan(e)) sum += e * e, ++count;
    }
  state.counters["rms_" + unit] = std::sqrt(sum / count);
  state.counters["fraction"] = count / all;
}

Vec3 vector(const std::vector<float>& numbers, std::size_t i) {
  return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}

void add_ours(const scenes::DepthScene& truth, const DepthImage& depth, const std::string& name,
              bool filter) {
  for (const Kernels* kernels : supported_kernels()) {
    DepthPipelineSettings settings;
    settings.filter = filter;
    const auto pipeline = std::make_shared<DepthPipeline>(settings, *kernels);
    const auto cloud = std::make_shared<PointCloud>();
    benchmark::RegisterBenchmark(
        (name + "/ours/" + kernels->isa).c_str(), [=, &truth](benchmark::State& state) {
          omp_set_num_threads(1);
          for (auto _ : state) pipeline->process(depth, truth.camera, kIdentity, *cloud);
          report(state, truth.camera, "deg",
                 [&](std::size_t i) { return angle_deg(cloud->normal(i), truth.normals[i]); });
        });
  }
}

void add_peers(const scenes::DepthScene& truth, const std::string& name, const std::vector<peers::Peer>& all,
               bool normals) {
  for (const peers::Peer& peer : all)
    benchmark::RegisterBenchmark((name + "/" + peer.name).c_str(), [=, &truth](benchmark::State& state) {
      for (auto _ : state) peer.run();
      const std::vector<float> got = peer.result();
      if (normals)
        report(state, truth.camera, "deg",
               [&](std::size_t i) { return angle_deg(vector(got, i), truth.normals[i]); });
      else
        report(state, truth.camera, "mm",
               [&](std::size_t i) { return 1e3 * (vector(got, i).z() - truth.depth.z_m[i]); });
    });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const scenes::DepthScene truth = scenes::waves(scenes::kinect(), 0.8, 0.02, 0.3);
  DepthImage depth = truth.depth;
  scenes::add_noise(depth, 0.0015, 1);
  const PointCloud measured = cloud_from_depth(depth, truth.camera, kIdentity);
  const PointCloud filtered =
      DepthPipeline({}, *supported_kernels().back()).process(depth, truth.camera, kIdentity);
  const peers::OrganisedPoints raw_points = organised(measured), filtered_points = organised(filtered);
  add_ours(truth, depth, "both", true);
  add_ours(truth, depth, "raw", false);
  add_ours(truth, {depth.width, depth.height, filtered.z}, "filtered", false);
  add_peers(truth, "raw", peers::normals_of_others(raw_points), true);
  add_peers(truth, "filtered", peers::normals_of_others(filtered_points), true);
  add_peers(truth, "filter", peers::filters_of_others(raw_points), false);
  return run_benchmarks(argc, argv);
}
