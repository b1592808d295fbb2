// The error of normals against the time that they take: this project's settings, PCL, OpenCV, 3F2N and D2NT
// on one scene with noise of 0.5, 1 and 2 mm. Planes, creases and limbs are counted separately. The answer of
// every method is checked on a plane without noise before it is timed: it must be within 0.5 degrees.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"
#include "core/kernels/isa.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/peers/depth_trade_scene.h"
#include "tests/benchmarks/peers/peer_depth.h"
#include "tests/benchmarks/peers/peer_points.h"
#include "tests/benchmarks/peers/published_normals.h"

namespace remote_touch::benchmarks {
namespace {

using peers::Peer;
constexpr double kAgreesDeg = 0.5;
constexpr std::array kNoises_mm = {0.5, 1.0, 2.0};

struct Setting {
  std::string name;
  DepthPipelineSettings settings;
};

constexpr NormalFit kInverse = NormalFit::inverse_depth;
const std::vector<Setting> kSettings = {
    {"ours_9_9_default", {}},
    {"ours_7_7", {true, 7, 0.025, 7, 0.014}},
    {"ours_5_5", {true, 5, 0.025, 5, 0.014}},
    {"ours_9_9_step_2_inverse", {true, 9, 0.025, 9, 0.02, 2, kInverse}},
    {"ours_5_9_step_2_inverse", {true, 5, 0.025, 9, 0.02, 2, kInverse}},
    {"ours_3_7_step_3_inverse", {true, 3, 0.025, 7, 0.02, 3, kInverse}},
    {"ours_5_9_step_2", {true, 5, 0.025, 9, 0.014, 2}},
    {"ours_fast_blunt", {true, 3, 0.025, 9, 0.02, 2, kInverse}},
    {"ours_3_7_step_3_sharp", {true, 3, 0.025, 7, 0.02, 3, kInverse, true}},
    {"ours_9_9_step_2_sharp", {true, 9, 0.025, 9, 0.02, 2, kInverse, true}},
    {"ours_fast", kFastDepthPipeline}};

// The error of the pixels of each kind, and of all pixels, that have a normal: the root of the mean square of
// the angle to the truth, and the fraction of these pixels.
struct Errors {
  std::array<double, 4> squares{}, count{}, all{};

  double rms_deg(std::size_t kind) const { return std::sqrt(squares[kind] / count[kind]); }
};

Errors errors(const TradeScene& truth, const std::vector<float>& normals) {
  Errors errors;
  for (std::size_t i = 0; i < truth.kinds.size(); ++i) {
    if (truth.kinds[i] == PixelKind::rim) continue;
    const double e =
        angle_deg({normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]}, truth.seen.normals[i]);
    for (const std::size_t kind : {static_cast<std::size_t>(truth.kinds[i]), std::size_t{3}}) {
      ++errors.all[kind];
      if (!std::isnan(e)) errors.squares[kind] += e * e, ++errors.count[kind];
    }
  }
  return errors;
}

Peer ours(const Setting& setting, const scenes::DepthScene& scene) {
  const auto pipeline = std::make_shared<DepthPipeline>(setting.settings, kernels_for(best_isa()));
  const auto cloud = std::make_shared<PointCloud>();
  const auto seen = std::make_shared<scenes::DepthScene>(scene);
  return {setting.name,
          [=] {
            omp_set_num_threads(1);
            pipeline->process(seen->depth, seen->camera, RigidTransform::Identity(), *cloud);
          },
          [=] {
            std::vector<float> numbers;
            for (std::size_t i = 0; i < cloud->size(); ++i)
              for (const double x : {cloud->nx[i], cloud->ny[i], cloud->nz[i]})
                numbers.push_back(static_cast<float>(x));
            return numbers;
          }};
}

peers::DepthOfCamera depth_of(const scenes::DepthScene& scene) {
  const CameraIntrinsics& camera = scene.camera;
  return {camera.width,
          camera.height,
          static_cast<float>(camera.fx),
          static_cast<float>(camera.cx),
          static_cast<float>(camera.cy),
          {scene.depth.z_m.begin(), scene.depth.z_m.end()}};
}

std::vector<Peer> published(const scenes::DepthScene& scene) {
  const auto depth = std::make_shared<peers::DepthOfCamera>(depth_of(scene));
  std::vector<Peer> all;
  using peers::Translator;
  for (const auto& [name, how] : {std::pair{"3f2n_mean", Translator::three_filters_mean},
                                  {"3f2n_median", Translator::three_filters_median},
                                  {"d2nt", Translator::d2nt},
                                  {"d2nt_dag", Translator::d2nt_discontinuities},
                                  {"d2nt_refined", Translator::d2nt_refined}})
    for (const auto& [before, prefilter] : peers::prefilters(*depth)) {
      const auto smooth = std::make_shared<std::vector<float>>();
      const auto normals = std::make_shared<std::vector<float>>();
      const auto translator = std::make_shared<peers::NormalTranslator>();
      all.push_back({std::string(name) + "_" + before,
                     [=] {
                       prefilter(*smooth);
                       translator->run(how, *depth, *smooth, *normals);
                     },
                     [=] { return *normals; }});
    }
  return all;
}

std::vector<Peer> everyone(const scenes::DepthScene& scene) {
  std::vector<Peer> all;
  for (const Setting& setting : kSettings) all.push_back(ours(setting, scene));
  const PointCloud measured = cloud_from_depth(scene.depth, scene.camera, RigidTransform::Identity());
  for (auto& peer : published(scene)) all.push_back(std::move(peer));
  for (auto& peer : peers::normals_of_others(organised(measured))) all.push_back(std::move(peer));
  return all;
}

void add_trade(const TradeScene& truth, double noise_mm, const Peer& peer, const Peer& on_a_plane,
               const TradeScene& plane) {
  char noise[8];
  std::snprintf(noise, sizeof noise, "%.1f", noise_mm);
  add(
      "trade/" + peer.name + "/" + noise,
      [=, &plane] {
        on_a_plane.run();
        const Errors found = errors(plane, on_a_plane.result());
        return found.count[0] > 0.99 * found.all[0] && found.rms_deg(0) < kAgreesDeg;
      },
      [=, &truth](benchmark::State& state) {
        for (auto _ : state) peer.run();
        const Errors found = errors(truth, peer.result());
        for (const auto& [name, kind] : {std::pair{"plane", 0}, {"crease", 1}, {"limb", 2}, {"all", 3}}) {
          const auto k = static_cast<std::size_t>(kind);
          state.counters[std::string("deg_") + name] = found.rms_deg(k);
          state.counters[std::string("fraction_") + name] = found.count[k] / found.all[k];
        }
      });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const TradeScene truth = room_with_boxes();
  TradeScene plane{scenes::plane(scenes::kinect(), {0.3, -0.2, 1}, 0.8), truth.kinds};
  for (PixelKind& kind : plane.kinds)
    if (kind != PixelKind::rim) kind = PixelKind::plane;
  const std::vector<Peer> on_a_plane = everyone(plane.seen);
  for (const double noise_mm : kNoises_mm) {
    scenes::DepthScene noisy = truth.seen;
    scenes::add_noise(noisy.depth, 1e-3 * noise_mm, 1);
    const std::vector<Peer> all = everyone(noisy);
    for (std::size_t i = 0; i < all.size(); ++i) add_trade(truth, noise_mm, all[i], on_a_plane[i], plane);
  }
  return run_benchmarks(argc, argv);
}
