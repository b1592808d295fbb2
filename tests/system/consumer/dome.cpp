#include "dome.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace lab {

using namespace remote_touch;

namespace {
constexpr int kSide = 80;
constexpr double kSpacing_m = 0.001;
}  // namespace

Parameters parameters(DomeSettings& settings) {
  return {{"radius_m", &settings.radius_m, 0.01, 1, "radius of the ball"},
          {"amplitude_m", &settings.amplitude_m, 0, 1, "how far it rises and sinks"},
          {"frequency_hz", &settings.frequency_hz, 0, 100, "how often"},
          {"noise_sigma_m", &settings.noise_sigma_m, 0, 1, "standard deviation of the height of a point"}};
}

Dome::Dome(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings), key_(key), kernels_(kernels) {}

double Dome::height_m(double time_s) const {
  return settings_.amplitude_m * std::sin(2 * std::numbers::pi * settings_.frequency_hz * time_s) -
         settings_.radius_m;
}

PointCloud Dome::cloud(int frame) const {
  PointCloud cloud;
  cloud.grid_columns = kSide;
  std::vector<std::uint32_t> index(kSide * kSide);
  std::iota(index.begin(), index.end(), 0);
  std::vector<double> noise(index.size()), unused(index.size()), also_unused(index.size());
  kernels_.noise.normals(noise_stream(key_, NoiseUse::point_position, static_cast<std::uint32_t>(frame)),
                         index.data(), index.size(), noise.data(), unused.data(), also_unused.data());
  const double centre_m = height_m(captured_s(frame)),
               radius_squared = settings_.radius_m * settings_.radius_m;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const double x = (i - 0.5 * (kSide - 1)) * kSpacing_m, z = (j - 0.5 * (kSide - 1)) * kSpacing_m;
      const double cap_m = std::sqrt(radius_squared - x * x - z * z);  // NaN beside the ball: nothing is seen
      const double y = centre_m + cap_m + settings_.noise_sigma_m * noise[cloud.size()];
      cloud.append(std::isnan(cap_m) ? Vec3(Vec3::Constant(cap_m)) : Vec3(x, y, z));
    }
  return cloud;
}

std::shared_ptr<const NeighbourSearch> Dome::points(int frame) const {
  return make_search(cloud(frame));
}

double Dome::signed_distance(const Vec3& p_W, double time_s) const {
  return (p_W - Vec3(0, height_m(time_s), 0)).norm() - settings_.radius_m;
}

}  // namespace lab
