// A spring without a proxy: it pushes the HIP away from the centroid of the points in a ball around it,
//
//   F = k (r - d) (HIP - centroid) / d,    d = |HIP - centroid|.
//
// It is a first renderer, and a bad one: if the HIP is deeper than the points, it pushes to the other side.
#pragma once

#include <core/kernels/kernels.h>
#include <core/rendering/renderer.h>
#include <runners/experiment/catalog/catalog.h>

namespace lab {

struct CentroidSettings {
  double radius_m = 0.005;
  double stiffness_N_per_m = 500;
};

remote_touch::Parameters parameters(CentroidSettings& settings);
std::string validate(const CentroidSettings& settings);
inline double max_stiffness_N_per_m(const CentroidSettings& settings) {
  return settings.stiffness_N_per_m;
}

// The force over a plane ends where the centroid is radius_m away.
inline remote_touch::RenderedContact rendered_contact(const CentroidSettings& settings) {
  return {settings.radius_m, settings.stiffness_N_per_m};
}

class CentroidRenderer final : public remote_touch::Renderer {
 public:
  using Settings = CentroidSettings;
  CentroidRenderer(const Settings& settings, double haptic_rate_hz, const remote_touch::Kernels& kernels);

  void reserve(std::size_t points) override { near_.reserve(points, false, false); }
  void on_frame(const remote_touch::Frame& frame) override;
  remote_touch::Parameters live_parameters() override { return live_ones(parameters(settings_)); }
  remote_touch::RenderOutput step(const remote_touch::DeviceState& device, double time_s) override;

 private:
  Settings settings_;
  const remote_touch::Kernels& kernels_;
  remote_touch::FrameOrder order_;
  std::shared_ptr<const remote_touch::NeighbourSearch> points_;
  remote_touch::GatheredPoints near_;
  remote_touch::Vec3 last_finite_W_ = remote_touch::Vec3::Zero();  // position of the device
};

}  // namespace lab
