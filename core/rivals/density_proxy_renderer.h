// The proxy of chapter 4 with a contact radius that follows the local density of the points, after the idea
// of P. Kumari, K. G. Sreeni, S. Chaudhuri, "Scalable rendering of variable density point cloud data", World
// Haptics 2013 and arXiv 2010.02626: a larger ball where points are sparse does not sink between them. Their
// rule (a kernel bandwidth) is known from the abstract only; the rule here is this project's:
//
//   s = sqrt(pi (d_K^2 - d_1^2) / K),    r_c = f s,  from min_radius_m to max_radius_m,
//
// with the distances d_1 and d_K from the proxy to the nearest and the K-th nearest point: s is the spacing
// of a square grid of that density and f is radius_ratio. r_1 and r_2 differ from r_c by as much as those of
// the nominal radius; r_3 = 2 r_c. The radius is computed in every tick and takes one of the values
// min_radius_m, 1.05 min_radius_m, 1.05^2 min_radius_m, ..., so that it seldom changes.
//
// The output's proxy is the centre of a ball of the nominal radius that touches the surface at the same
// place, so that heights are comparable with those of other balls.
#pragma once

#include <string>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/rivals/nearest_points.h"

namespace remote_touch {

struct DensityProxyParameters {
  ProxyParameters proxy;  // r_1 and r_2 give the nominal radius r_c
  double radius_ratio = 10.0 / 3;
  double min_radius_m = 0.002, max_radius_m = 0.02;
  int neighbours = 24;
};

Parameters parameters(DensityProxyParameters& p);
// Describes the first invalid combination of settings in one line; empty if there is none.
std::string validate(const DensityProxyParameters& p);
// Upper bound, over all poses, of how fast |force| grows with the displacement of the HIP.
inline double max_stiffness_N_per_m(const DensityProxyParameters& p) {
  return max_stiffness_N_per_m(p.proxy);
}

class DensityProxyRenderer final : public Renderer {
 public:
  // pre: validate(parameters) is empty. haptic_rate_hz: how often step() is called.
  DensityProxyRenderer(const DensityProxyParameters& parameters, double haptic_rate_hz,
                       const Kernels& kernels);
  void reserve(std::size_t points) override;
  void on_frame(const Frame& frame) override;
  Parameters live_parameters() override;
  void parameters_changed() override { proxy_.parameters_changed(); }
  RenderOutput step(const DeviceState& device, double time_s) override;

 private:
  double wanted_radius(double last_m) const;
  void adapt();

  const DensityProxyParameters p_;
  ProxyRenderer proxy_;
  NearestPoints nearest_;
  std::shared_ptr<const NeighbourSearch> points_;  // points of the newest frame
  double radius_m_;                                // r_c
};

}  // namespace remote_touch
