#include "core/beyond/tracked_surface/sheet_registration.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

// Returns the plane of least squares through the residuals that are within reach of the plane `before`. It is
// only the mean height if there are few points.
SheetShift refined(const PatchPoints& points, const PatchPlace& proxy, const SheetShift& before,
                   double reach) {
  constexpr double kSteepest = 0.5, kMinPoints = 12;
  const auto [n, su, sv, se, uu, uv, vv, ue, ve] = points.sums_near(
      {proxy.u, proxy.v, kRegistrationReach, before.height, before.slope_u, before.slope_v, reach});
  if (n < 3) return before;
  const double mu = su / n, mv = sv / n, me = se / n;
  const double cuu = uu - n * mu * mu, cuv = uv - n * mu * mv, cvv = vv - n * mv * mv;
  const double cue = ue - n * mu * me, cve = ve - n * mv * me, det = cuu * cvv - cuv * cuv;
  SheetShift shift{me, 0, 0};
  if (n < kMinPoints || !(det > 0.05 * cuu * cvv)) return shift;
  shift.slope_u = std::clamp((cvv * cue - cuv * cve) / det, -kSteepest, kSteepest);
  shift.slope_v = std::clamp((cuu * cve - cuv * cue) / det, -kSteepest, kSteepest);
  shift.height = me - shift.slope_u * mu - shift.slope_v * mv;
  return shift;
}

}  // namespace

SheetShift register_sheet(const PatchPoints& points, const HeightProfile& profile, const PatchPlace& proxy,
                          double gate, double half_range, double sigma) {
  const HeightProfile now =
      points.profile_near(proxy, kRegistrationReach, half_range).smoothed(std::max(0.3, sigma));
  SheetShift shift{profile.shift_of(now, gate), 0, 0};
  for (const double narrow : {1.0, 0.5, 0.5})
    shift = refined(points, proxy, shift, std::max(narrow, 3 * sigma));
  return shift;
}

}  // namespace remote_touch
