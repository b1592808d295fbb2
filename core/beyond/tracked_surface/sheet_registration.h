// Registration of the points of a frame to the map that predicts the sheet.
#pragma once

#include "core/beyond/tracked_surface/height_map.h"
#include "core/beyond/tracked_surface/height_profile.h"
#include "core/beyond/tracked_surface/patch_points.h"

namespace remote_touch {

// The height of the sheet above the prediction is height + slope_u u + slope_v v, in contact radii.
struct SheetShift {
  double height = 0, slope_u = 0, slope_v = 0;
};

// Only points within this distance of the proxy, along the patch, determine the shift; contact radii.
inline constexpr double kRegistrationReach = 6;

// Computes the shift, at most gate in either direction, from the profiles of two frames. A robust plane
// through the residuals then refines it. profile: that of the previous frame. pre: points.set_residuals() was
// called.
SheetShift register_sheet(const PatchPoints& points, const HeightProfile& profile, const PatchPlace& proxy,
                          double gate, double half_range, double sigma);

}  // namespace remote_touch
