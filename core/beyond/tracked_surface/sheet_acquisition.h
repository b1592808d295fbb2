// Search for the sheet of surface that is nearest to a proxy, in one frame alone.
#pragma once

#include <memory>
#include <optional>

#include "core/beyond/tracked_surface/height_fit.h"
#include "core/beyond/tracked_surface/patch_points.h"
#include "core/kernels/kernels.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

struct FoundSheet {
  PatchFrame frame;             // its origin lies on the sheet, its normal points to the proxy's side
  std::optional<double> sigma;  // standard deviation of the noise, contact radii; none: too few points
  double known = 0;             // radius around the origin in which the sheet was seen, contact radii
};

// Work buffers of a search.
struct AcquisitionBuffers {
  GatheredPoints& gathered;
  PatchPoints& points;
  HeightFit& fit;
};

// Searches for the mode of the heights along a normal that is nearest to the proxy. The first normal is (4.1)
// over a wide reach; the next ones are those of the plane through the points of the mode. Returns no sheet if
// there are too few points, or if no surface faces the proxy.
std::optional<FoundSheet> find_sheet(const NeighbourSearch& frame, const Vec3& proxy_W,
                                     double contact_radius_m, const Kernels& kernels,
                                     const AcquisitionBuffers& buffers);

}  // namespace remote_touch
