// Registration of a frame's points to what the map of a sheet predicts.
#pragma once

#include "core/beyond/tracked_surface/height_map.h"
#include "core/beyond/tracked_surface/height_profile.h"
#include "core/beyond/tracked_surface/patch_points.h"

namespace remote_touch {

// The sheet lies height + slope_u u + slope_v v above the prediction, in contact radii.
struct SheetShift {
  double height = 0, slope_u = 0, slope_v = 0;
};

// Only points within this distance of the proxy, along the patch, determine the shift; contact radii.
inline constexpr double kRegistrationReach = 6;

// The profiles give the shift, at most gate either way; a robust plane through the residuals refines it.
// profile: of the frame before. pre: points.set_residuals() was called.
SheetShift register_sheet(const PatchPoints& points, const HeightProfile& profile, const PatchPlace& proxy,
                          double gate, double half_range, double sigma);

}  // namespace remote_touch
