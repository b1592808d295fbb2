// Variants of the proxy of chapter 4: on averaged points, with a radius that depends on the density, and with
// knowledge of the truth.
#pragma once

#include <string>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/rivals/frame_average.h"
#include "core/rivals/point_normals.h"

namespace remote_touch {

// The proxy of chapter 4 on points that are averaged over the last frames (frame_average.h). A user has this
// result when the temporal filter of the depth camera is on.

struct AveragedProxyParameters {
  ProxyParameters proxy;
  FrameAverageSettings average;
};

Parameters parameters(AveragedProxyParameters& p);
std::string validate(const AveragedProxyParameters& p);

class AveragedProxyRenderer final : public Renderer {
 public:
  // pre: validate(parameters) is empty. haptic_rate_hz: the rate at which step() is called.
  AveragedProxyRenderer(const AveragedProxyParameters& parameters, double haptic_rate_hz,
                        const Kernels& kernels)
      : proxy_(parameters.proxy, haptic_rate_hz, kernels), average_(parameters.average, kernels) {}
  void reserve(std::size_t points) override;
  void on_frame(const Frame& frame) override;
  Parameters live_parameters() override { return proxy_.live_parameters(); }
  void parameters_changed() override { proxy_.parameters_changed(); }
  RenderOutput step(const DeviceState& device, double time_s) override { return proxy_.step(device, time_s); }

 private:
  ProxyRenderer proxy_;
  FrameAverage average_;
};

// The proxy of chapter 4 with a contact radius that depends on the local density of the points. The idea is
// that of P. Kumari, K. G. Sreeni, S. Chaudhuri, "Scalable rendering of variable density point cloud data",
// World Haptics 2013 and arXiv 2010.02626: a larger ball does not sink between sparse points. Only the
// abstract of their rule (a kernel bandwidth) is known; the rule here is this project's:
//
//   s = sqrt(pi (d_K^2 - d_1^2) / K),    r_c = f s,  from min_radius_m to max_radius_m,
//
// d_1 and d_K are the distances from the proxy to the nearest and the K-th nearest point, s is the spacing of
// a square grid of that density, and f is radius_ratio. r_1 and r_2 differ from r_c by as much as those of
// the nominal radius; r_3 = 2 r_c. The radius is computed in every tick. It has one of the values
// min_radius_m, 1.05 min_radius_m, 1.05^2 min_radius_m, ..., max_radius_m, so that it seldom changes.
//
// The output's proxy in contact is the centre of a ball of the nominal radius that touches the surface at the
// same position, so that heights are comparable with those of other balls.

struct DensityProxyParameters {
  ProxyParameters proxy;  // r_1 and r_2 define the nominal radius r_c
  double radius_ratio = 10.0 / 3;
  double min_radius_m = 0.002, max_radius_m = 0.02;
  int neighbours = 24;
};

Parameters parameters(DensityProxyParameters& p);
std::string validate(const DensityProxyParameters& p);

class DensityProxyRenderer final : public Renderer {
 public:
  // pre: validate(parameters) is empty. haptic_rate_hz: the rate at which step() is called.
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

// ORACLE, not a method: the proxy of chapter 4 with knowledge of the true surface's motion. It shows what the
// proxy would achieve with a perfect estimate of the velocity, and which failures have other causes: the
// points and their noise are the same. Only a simulation knows the truth (Frame::truth). The proxy without it
// is the same as with velocity_estimate = false.
//
// At a frame, the displacement in (4.3) is that of the true surface since the previous frame, along its true
// normal at the proxy. v_hat in (4.15) is its mean velocity in that time, of either sign. A frame whose truth
// is not known at the proxy does not move it.

struct OracleProxyParameters {
  ProxyParameters proxy;
};

Parameters parameters(OracleProxyParameters& p);
inline std::string validate(const OracleProxyParameters& p) {
  return validate(p.proxy);
}

// Returns the motion of the true surface nearest to p from before_s to now_s, along its normal at now_s. The
// motion is zero if it is not known.
SurfaceMotion true_motion(const TrueSurface& truth, const Vec3& p_W, double before_s, double now_s);

class OracleProxyRenderer final : public Renderer {
 public:
  // pre: validate(parameters) is empty. haptic_rate_hz: the rate at which step() is called.
  OracleProxyRenderer(const OracleProxyParameters& parameters, double haptic_rate_hz, const Kernels& kernels)
      : proxy_(parameters.proxy, haptic_rate_hz, kernels) {}
  void reserve(std::size_t points) override { proxy_.reserve(points); }
  void on_frame(const Frame& frame) override;
  Parameters live_parameters() override;
  void parameters_changed() override { proxy_.parameters_changed(); }
  RenderOutput step(const DeviceState& device, double time_s) override { return proxy_.step(device, time_s); }

 private:
  ProxyRenderer proxy_;
  double captured_s_ = 0;  // capture time of the newest frame
  bool has_frame_ = false;
};

}  // namespace remote_touch
