// Noise along the viewing rays as depth sensors have it: it grows with the square of the distance, and
// neighbouring points and successive frames have it in common.
#pragma once

#include <vector>

#include "core/geometry/point_cloud.h"
#include "core/kernels/kernels.h"
#include "core/numeric/noise.h"

namespace remote_touch {

struct RayNoise {
  double sigma_m = 0;        // standard deviation at a distance of 1 m; it is sigma_m (distance / 1 m)^2
  double correlation_m = 0;  // pitch of the square lattice across the view whose noise is interpolated
  double memory = 0;         // weight of the noise of the frame before
};

// Standard normals for the points of a frame. places: x and z of each point across the view, in the unit of
// correlation_m; NaN for a point that was not measured, which gets NaN if noise is correlated.
//
// Without correlation_m every point has noise of its own. Else the noise of the lattice's nodes is
// interpolated bilinearly and scaled to standard deviation 1 everywhere: points that are farther apart than
// two pitches along x or z have none in common. With memory m, frame j has sqrt(1 - m^2) (w_j + m w_{j-1} +
// m^2 w_{j-2}
// + ...) of independent w, cut off after 16 frames and scaled to 1.
std::vector<double> standard_noise(const RayNoise& noise, const PointCloud& places, const NoiseKey& key,
                                   int frame, const Kernels& kernels);

}  // namespace remote_touch
