#include "core/tracked_sheet/sheet_registration.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

bool is_near(const PatchPlace& p, const PatchPlace& proxy) {
  const double du = p.u - proxy.u, dv = p.v - proxy.v;
  return du * du + dv * dv <= kRegistrationReach * kRegistrationReach;
}

// The plane of least squares through the residuals that lie within reach of the one before.
SheetShift refined(const PatchPoints& points, const PatchPlace& proxy, const SheetShift& before,
                   double reach) {
  constexpr double kSteepest = 0.5, kFewest = 12;
  double n = 0, su = 0, sv = 0, se = 0, uu = 0, uv = 0, vv = 0, ue = 0, ve = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PatchPlace& p = points.place[i];
    const double off = points.residual[i] - before.height - before.slope_u * p.u - before.slope_v * p.v;
    if (!(std::abs(off) <= reach) || !is_near(p, proxy)) continue;
    const double e = PatchFrame::rounded(points.residual[i]);
    n += 1, su += p.u, sv += p.v, se += e;
    uu += p.u * p.u, uv += p.u * p.v, vv += p.v * p.v, ue += p.u * e, ve += p.v * e;
  }
  if (n < 3) return before;
  const double mu = su / n, mv = sv / n, me = se / n;
  const double cuu = uu - n * mu * mu, cuv = uv - n * mu * mv, cvv = vv - n * mv * mv;
  const double cue = ue - n * mu * me, cve = ve - n * mv * me, det = cuu * cvv - cuv * cuv;
  SheetShift shift{me, 0, 0};
  if (n < kFewest || !(det > 0.05 * cuu * cvv)) return shift;
  shift.slope_u = std::clamp((cvv * cue - cuv * cve) / det, -kSteepest, kSteepest);
  shift.slope_v = std::clamp((cuu * cve - cuv * cue) / det, -kSteepest, kSteepest);
  shift.height = me - shift.slope_u * mu - shift.slope_v * mv;
  return shift;
}

}  // namespace

void set_residuals(PatchPoints& points, const HeightMap& map) {
  for (std::size_t i = 0; i < points.size(); ++i)
    points.residual[i] = points.place[i].h - map.height(points.place[i].u, points.place[i].v);
}

HeightProfile profile_near(const PatchPoints& points, const PatchPlace& proxy, double half_range) {
  HeightProfile profile(half_range);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (is_near(points.place[i], proxy)) profile.add(points.residual[i]);
  return profile;
}

SheetShift register_sheet(const PatchPoints& points, const HeightProfile& profile, const PatchPlace& proxy,
                          double gate, double half_range, double sigma) {
  const HeightProfile now = profile_near(points, proxy, half_range).smoothed(std::max(0.3, sigma));
  SheetShift shift{profile.shift_of(now, gate), 0, 0};
  for (const double narrow : {1.0, 0.5, 0.5})
    shift = refined(points, proxy, shift, std::max(narrow, 3 * sigma));
  return shift;
}

}  // namespace remote_touch
