// A ball that rises and sinks. The sensor sees its top.
#pragma once

#include <core/parameters/parameter.h>
#include <scenarios/simulated/scenario.h>

namespace lab {

struct DomeSettings {
  double radius_m = 0.04;
  double amplitude_m = 0.005;
  double frequency_hz = 0.5;
  double noise_sigma_m = 0;
};

remote_touch::Parameters parameters(DomeSettings& settings);
inline std::string validate(const DomeSettings&) {
  return {};
}

class Dome final : public remote_touch::Scenario {
 public:
  using Settings = DomeSettings;
  Dome(const Settings& settings, const remote_touch::NoiseKey& key, const remote_touch::Kernels& kernels);

  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 90; }
  std::shared_ptr<const remote_touch::NeighbourSearch> points(int frame) const override;
  remote_touch::PointCloud cloud(int frame) const override;
  double signed_distance(const remote_touch::Vec3& p_W, double time_s) const override;

 private:
  double height_m(double time_s) const;  // height of the centre

  Settings settings_;
  remote_touch::NoiseKey key_;
  const remote_touch::Kernels& kernels_;
};

}  // namespace lab
