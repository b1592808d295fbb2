#include "tests/benchmarks/full_lift.h"

#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace remote_touch::benchmarks {
namespace {

// The scenario with other frames.
class WithFrames final : public Scenario {
 public:
  WithFrames(std::unique_ptr<Scenario> scenario, const MakeFrame& make_frame)
      : scenario_(std::move(scenario)), make_frame_(make_frame) {}
  double frame_rate_hz() const override { return scenario_->frame_rate_hz(); }
  int frame_count() const override { return scenario_->frame_count(); }
  double captured_s(int frame) const override { return scenario_->captured_s(frame); }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override {
    return make_frame_(*scenario_, frame);
  }
  PointCloud cloud(int frame) const override { return scenario_->cloud(frame); }
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return scenario_->signed_distance(p_W, time_s);
  }
  double surface_height(double x, double z, double time_s) const override {
    return scenario_->surface_height(x, z, time_s);
  }

 private:
  const std::unique_ptr<Scenario> scenario_;
  const MakeFrame make_frame_;
};

class AllNoiseSearch final : public NeighbourSearch {
 public:
  AllNoiseSearch(const Grid& grid, double height_m, double sigma_m, const NoiseStream& stream,
                 const Kernels& kernels)
      : size_(static_cast<std::size_t>(grid.size())) {
    x_.grow(size_), y_.grow(size_), z_.grow(size_);
    const auto columns = static_cast<std::size_t>(grid.columns);
    std::vector<std::uint32_t> index(columns);
    for (std::size_t start = 0; start < size_; start += columns) {
      std::iota(index.begin(), index.end(), static_cast<std::uint32_t>(start));
      double *x = x_.data() + start, *y = y_.data() + start, *z = z_.data() + start;
      kernels.noise.normals(stream, index.data(), columns, x, y, z);
      const double row_z = grid.z(static_cast<int>(start / columns));
      for (std::size_t i = 0; i < columns; ++i) {
        x[i] = grid.x(static_cast<int>(i)) + sigma_m * x[i];
        y[i] = height_m + sigma_m * y[i];
        z[i] = row_z + sigma_m * z[i];
      }
    }
  }
  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override {
    out.add({x_.data(), y_.data(), z_.data(), nullptr, nullptr, nullptr, 0, size_}, ball, kernels);
  }
  std::size_t size() const override { return size_; }

 private:
  const std::size_t size_;
  Buffer<double> x_, y_, z_;
};

}  // namespace

Trace simulate_with(const Experiment& experiment, const Kernels& kernels, const MakeFrame& make_frame) {
  const WithFrames scenario(experiment.build_scenario(kernels), make_frame);
  const auto trajectory = experiment.build_trajectory(scenario);
  const auto renderer = experiment.build_renderer(kernels);
  const double rate_hz = experiment.settings().haptic_rate_hz;
  const auto ticks = static_cast<std::size_t>(std::ceil(experiment.settings().duration_s * rate_hz - 1e-6));
  Trace trace;
  trace.reserve(ticks);
  int next = 0;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const double time_s = static_cast<double>(tick) / rate_hz;
    for (; next < scenario.frame_count() && scenario.captured_s(next) <= time_s + kSameTime_s; ++next)
      renderer->on_frame({next, scenario.captured_s(next), scenario.captured_s(next), scenario.points(next)});
    const DeviceState device = trajectory->at(time_s);
    const RenderOutput out = renderer->step(device, time_s);
    trace.append(
        time_s, device, out,
        {scenario.signed_distance(out.proxy_W, time_s), scenario.signed_distance(out.slave_W, time_s), 0});
  }
  return trace;
}

std::shared_ptr<const NeighbourSearch> whole_cloud(const Scenario& scenario, int frame) {
  return std::make_shared<BruteForceSearch>(scenario.cloud(frame));
}

MakeFrame all_noise(const MovingLift::Settings& scene, const NoiseKey& key, const Kernels& kernels) {
  return [=, &kernels](const Scenario& scenario, int frame) {
    const double height_m = -scenario.signed_distance(Vec3::Zero(), scenario.captured_s(frame));
    const auto drawn = static_cast<std::uint32_t>(frame);
    return std::make_shared<AllNoiseSearch>(scene.grid, height_m, scene.noise_sigma_m,
                                            noise_stream(key, NoiseUse::point_position, drawn), kernels);
  };
}

}  // namespace remote_touch::benchmarks
