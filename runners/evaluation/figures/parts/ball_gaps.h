// The gap between the ball of a proxy and a true surface that moves, in each tick of a run.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/trace.h"
#include "core/kernels/kernels.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "runners/experiment/catalog/experiment.h"
#include "scenarios/scene/scenario.h"

namespace remote_touch {

// Signed distances from the ball to the true surface: positive outside, negative if a part of the ball is
// behind the surface.
struct BallGap {
  double now_m = kNoValue;         // distance to the surface as it is in this tick
  double at_capture_m = kNoValue;  // distance to the surface as it was when the frame in use was captured
};
using GapValue = double BallGap::*;

// Returns the gaps of the ball of this radius around the proxy, one element for each tick. Both are NaN in
// ticks in which the surface does not hold the proxy back (see pressing()), before the first frame, and where
// the true surface is unknown. Pre: the trace is that of a run on the scenario, and has signed distances to
// the surface as it moves.
std::vector<BallGap> ball_gaps(const Trace& trace, const Scenario& scenario, double contact_radius_m);

// Statistics over the ticks in which the gap is known; NaN if there are none.
double rms_gap_m(const std::vector<BallGap>& gaps, GapValue value);
double max_gap_m(const std::vector<BallGap>& gaps, GapValue value);  // percentile of the absolute value

// A run in a scene of meshes.
struct MeshRun {
  Experiment experiment;
  Trace trace;
  std::unique_ptr<Scenario> scenario;
  PointCloud cloud;  // first frame
  std::vector<BallGap> gaps;
};
// Pre: the trace is that of the experiment, whose scenario is mesh-scene.
MeshRun mesh_run(Experiment experiment, Trace trace, double contact_radius_m, const Kernels& kernels);

// Returns settings of a structured-light sensor without noise and rounding. What remains are its holes and
// the distances between its points.
std::vector<std::string> exact_sensor();

// The error of a depth along the optical axis.
struct DepthError {
  double sigma_m = 0;     // standard deviation, that of the rounding included
  double rounding_m = 0;  // half of a step of the depth
  double largest_m() const { return 3 * sigma_m + rounding_m; }
};
// Returns z^2 / (f b) times the noise, and times half a step of the disparity, see depth_sensor.h. Pre: the
// scenario of the experiment is mesh-scene with the sensor structured-light.
DepthError depth_error(const Experiment& experiment, double z_m);

// Returns that error at the largest depth that the proxy has while its gap is known. Pre: also, the camera
// rests.
DepthError error_at_proxy(const MeshRun& run);

// Returns how deep a ball of this radius sinks between four neighbouring points of an image without noise, at
// most over the pixels for which shows(pixel) is true: r - (r^2 - a^2)^(1/2), where 2 a is the longer
// diagonal of the four points. Squares with a side above r, which have a depth edge, are left out. Pre: the
// cloud has a point per pixel.
template <class Shows>
double deepest_sink_m(const PointCloud& cloud, double radius_m, Shows&& shows) {
  const auto width = static_cast<std::size_t>(cloud.image->camera.width);
  const double r = radius_m;
  double sink_m = kNoValue;
  for (std::size_t i = 0; i + width + 1 < cloud.size(); ++i) {
    if (i % width + 1 == width || !shows(i)) continue;
    const Vec3 a = cloud.point(i), b = cloud.point(i + 1), c = cloud.point(i + width),
               d = cloud.point(i + width + 1);
    const double side_m = std::max({(b - a).norm(), (c - a).norm(), (d - b).norm(), (d - c).norm()});
    if (!(side_m < r) || !d.allFinite()) continue;  // or NaN: a point is missing
    const double half_m = 0.5 * std::max((d - a).norm(), (c - b).norm());
    sink_m = std::fmax(sink_m, r - std::sqrt(r * r - half_m * half_m));
  }
  return sink_m;
}

}  // namespace remote_touch
