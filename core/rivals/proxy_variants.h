// Variants of the proxy of chapter 4: on averaged points, with a radius that depends on the density, and with
// knowledge of the truth.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "core/points/vector.h"
#include "core/rivals/point_normals.h"

namespace remote_touch {

// Averages of each point over the last frames: a simple way to reduce noise that sensors and programs offer.
// A point is identified by its index: the pixel of an image, or the node of a simulated grid. So the averaged
// surface lags behind a moving surface.
//
//   exponential  the temporal filter of common depth cameras, from the public description of its settings
//                (librealsense): along the ray, d_j' = alpha d_j + (1 - alpha) d_{j-1}', but d_j where both
//                differ by step_threshold_m or more; a missing point keeps its last position as long as it
//                was measured in persistence_hits of the last persistence_frames frames
//   mean         the mean position over those of the last mean_frames frames in which it was measured; a
//                point that is missing in the newest frame is left out

// A neighbour search over points in the order of their indices, in blocks with bounding boxes. It can be
// filled repeatedly without allocating. Points with neighbouring indices should be near each other, as in an
// image or a grid.
class BlockSearch final : public NeighbourSearch {
 public:
  void reserve(std::size_t points);
  // Sets the number of points. All points are missing until set() is called for them. The memory is kept.
  void clear(std::size_t points, int columns, bool with_radius, bool with_stiffness);
  void set(std::size_t number, const Vec3& p_W) {
    x_[number] = p_W.x(), y_[number] = p_W.y(), z_[number] = p_W.z();
  }
  void set_fixture_radius(std::size_t number, double radius_m) { radius_[number] = radius_m; }
  void set_stiffness(std::size_t number, double N_per_m) { stiffness_[number] = N_per_m; }
  // Must be called after the last set().
  void finish();

  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override;
  std::size_t size() const override { return x_.size(); }
  bool has_fixture_radius() const override { return !radius_.empty(); }
  bool has_regions() const override { return max_radius_m_ > 0; }
  double max_fixture_radius_m() const override { return max_radius_m_; }
  bool has_stiffness() const override { return !stiffness_.empty(); }
  int organised_columns() const override { return columns_; }

 private:
  std::vector<double> x_, y_, z_, radius_, stiffness_;
  std::vector<BoundingBox> boxes_;
  double max_radius_m_ = 0;
  int columns_ = 0;
};

enum class AverageRule { exponential, mean };

struct FrameAverageSettings {
  AverageRule rule = AverageRule::exponential;
  double alpha = 0.4;
  double step_threshold_m = 0.02;
  int persistence_hits = 2, persistence_frames = 4;
  int mean_frames = 4;
  Vec3 view_direction{0, -1, 0};
};

Parameters parameters(FrameAverageSettings& s);
std::string validate(const FrameAverageSettings& s);

class FrameAverage {
 public:
  FrameAverage(const FrameAverageSettings& settings, const Kernels& kernels);
  void reserve(std::size_t points);
  // Adds a frame to the stream and returns the averaged points. They are valid until the second next call. A
  // frame of another size restarts the averages; a frame without points counts as one in which all points are
  // missing. Allocates only for a frame larger than reserved. r_f and k_s are those of the newest frame; a
  // point that is missing there has neither.
  std::shared_ptr<const NeighbourSearch> next(const NeighbourSearch& points);

 private:
  static constexpr int kMaxFrames = 16;
  void begin(std::size_t points);
  void store(const NeighbourSearch& points);
  Vec3 exponential(std::size_t number, const ViewPoint& view);
  Vec3 mean(std::size_t number) const;
  const Vec3& latest(std::size_t number) const { return history_[newest_][number]; }

  const FrameAverageSettings s_;
  const Kernels& kernels_;
  GatheredPoints all_;
  // Measured positions of the last frames; NaN if a point was not measured. Only as many frames are used as
  // the rule needs.
  std::array<std::vector<Vec3>, kMaxFrames> history_;
  int newest_ = 0;
  std::vector<Vec3> smooth_;         // state of the exponential rule
  std::vector<std::uint32_t> seen_;  // one bit for each of the last frames: the point was measured in it
  std::array<std::shared_ptr<BlockSearch>, 2> shown_;
  int shown_last_ = 0;
};

// The proxy of chapter 4 on points that are averaged over the last frames (FrameAverage). A user has this
// result when the temporal filter of the depth camera is on.

struct AveragedProxyParameters {
  ProxyParameters proxy;
  FrameAverageSettings average;
};

Parameters parameters(AveragedProxyParameters& p);
std::string validate(const AveragedProxyParameters& p);

class AveragedProxyRenderer final : public Renderer {
 public:
  // haptic_rate_hz: the rate at which step() is called.
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
// This renderer reports the position of a ball with the nominal radius, whatever its current radius is. The
// current radius grows with the spacing of the points, so that the ball does not fall through between them:
// ball_radius_m is 0.
inline RenderedContact rendered_contact(const DensityProxyParameters& p) {
  return {p.proxy.contact_radius_m()};
}

class DensityProxyRenderer final : public Renderer {
 public:
  // haptic_rate_hz: the rate at which step() is called.
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
  // haptic_rate_hz: the rate at which step() is called.
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
