// How a frame's points lie against what the map of a sheet predicts.
#pragma once

#include "core/tracked_sheet/height_map.h"
#include "core/tracked_sheet/height_profile.h"
#include "core/tracked_sheet/patch_points.h"

namespace remote_touch {

// height + slope_u u + slope_v v is what the sheet lies above the prediction, in contact radii.
struct SheetShift {
  double height = 0, slope_u = 0, slope_v = 0;
};

// Points farther than this from the proxy, along the patch, have no part in finding the shift.
inline constexpr double kRegistrationReach = 6;

// The profile tells the shift within the gate, a robust plane through the residuals the rest. profile: of the
// frame before. After points.set_residuals().
SheetShift register_sheet(const PatchPoints& points, const HeightProfile& profile, const PatchPlace& proxy,
                          double gate, double half_range, double sigma);

}  // namespace remote_touch
