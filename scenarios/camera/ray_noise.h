// Noise along the viewing rays as depth sensors have it: it grows with the square of the distance, and it is
// correlated between neighbouring points and between successive frames.
#pragma once

#include <vector>

#include "core/geometry/point_cloud.h"
#include "core/kernels/kernels.h"
#include "core/numeric/noise.h"

namespace remote_touch {

struct RayNoise {
  double sigma_m = 0;        // standard deviation at a distance of 1 m; it is sigma_m (distance / 1 m)^2
  double correlation_m = 0;  // pitch of the square lattice across the view that carries the noise
  double memory = 0;         // correlation of the noise of successive frames (-)
};

// Returns one standard normal for each point of a frame. positions: position of each point across the view,
// in x and z, in the unit of correlation_m. A point that was not measured is NaN there, and its noise is NaN
// if correlation_m is above 0.
//
// Without correlation_m every point has independent noise. Otherwise the noise of the lattice's nodes is
// interpolated bilinearly and scaled to standard deviation 1 everywhere. The noise of two points that are
// farther apart than two pitches along x or z is independent. Throws InputError if correlation_m is so small
// against the cloud that the lattice would have more than 2^24 nodes.
//
// The noise x_j of frame j with memory m has the law of x_j = m x_(j-1) + (1 - m^2)^(1/2) w_j with
// independent w: the correlation of two frames is m^|i - j|, from the first frame on (to 1e-8). It is not
// computed by this recursion, so that a frame needs no other frames. pre: 0 <= m < 1.
std::vector<double> standard_noise(const RayNoise& noise, const PointCloud& positions, const NoiseKey& key,
                                   int frame, const Kernels& kernels);

}  // namespace remote_touch
