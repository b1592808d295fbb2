// Finding the sheet of surface that lies nearest to a proxy, from one frame alone.
#pragma once

#include <memory>
#include <optional>

#include "core/beyond/tracked_surface/height_fit.h"
#include "core/beyond/tracked_surface/patch_points.h"
#include "core/kernels/kernels.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

struct FoundSheet {
  PatchFrame frame;  // its origin lies on the sheet, its normal points to the proxy's side
  double sigma = 0;  // noise, contact radii
  double known = 0;  // radius around the origin in which it was seen, contact radii
};

// Scratch memory of a search.
struct AcquisitionBuffers {
  GatheredPoints& gathered;
  PatchPoints& points;
  HeightFit& fit;
};

// Takes the nearest mode of the heights along a normal: first the normal (4.1) over a wide reach, then that
// of the mode itself. None: too few points, or no surface that faces the proxy.
std::optional<FoundSheet> find_sheet(const NeighbourSearch& frame, const Vec3& proxy_W,
                                     double contact_radius_m, const Kernels& kernels,
                                     const AcquisitionBuffers& buffers);

}  // namespace remote_touch
