// The columns of the gathered points that the kernels read.
#pragma once

#include "core/kernels/lanes.h"

namespace remote_touch {

// Columns in m. They need no alignment. They are padded with points at kFarAway to padded_count, a multiple
// of kLanes. radius is r_f of each point and stiffness is k_s in N/m (NaN: the renderer's own); both are null
// if the cloud has no such column.
struct PointsView {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;
  const double* stiffness;
  std::size_t padded_count;
};

}  // namespace remote_touch
