// Queries of the points near the proxy: the state of the proxy, its normal, its stiffness and its step sizes.
// Positions and radii are in m, directions have unit length.
#pragma once

#include "core/kernels/point_kernels.h"

namespace remote_touch {

// The radii that define the proxy's regions, Fig 4.2, and the constants of the sums over the points.
struct ProxyRegions {
  double r1, r2, r3;
  double sum_grid;   // M of kernels.h: 1.5 times a power of two, and at least 1.5 times the number of points
  double stiffness;  // stiffness of points without their own, N/m
};

// Local statistics of the points around a proxy position. r_n = |P - x| - r_f, (5.5).
struct ContactQuery {
  double nearest;         // smallest r_n; infinite without points
  double normal_sum[3];   // (4.1): sum of (P - x)/|P - x| psi(r_n), not of unit length
  double weight_sum;      // sum of psi(r_n); 0 if the points have no stiffness column
  double stiffness_sum;   // (5.8): sum of k_s psi(r_n); 0 if the points have no stiffness column
  double touching_count;  // number of points with r_n <= r2
};

struct ProxyKernels {
  ContactQuery (*contact_query)(const PointsView&, const double p[3], const ProxyRegions&);
  // Returns the smallest d > 0 at which a proxy that moves from p along the unit vector meets a point ahead,
  // |p + d direction - x| = reach + r_f, (4.9), (5.9); infinity if it meets none.
  double (*first_hit)(const PointsView&, const double p[3], const double direction[3], double reach);
  // Returns the largest positive root over the points with r_n < inner, (4.10), (5.11); 0 without such
  // points.
  double (*exit_distance)(const PointsView&, const double p[3], const double direction[3], double reach,
                          double inner);
};

}  // namespace remote_touch
