#include "core/beyond/tracked_surface/sheet_acquisition.h"

#include <cmath>
#include <limits>

#include "core/beyond/tracked_surface/height_profile.h"

namespace remote_touch {

namespace {

constexpr double kReaches[] = {6, 12, 24, 40};  // contact radii
constexpr std::size_t kEnough = 40, kMinGathered = 4;

double gather_near(const NeighbourSearch& frame, const Vec3& p_W, double unit_m, const Kernels& kernels,
                   GatheredPoints& gathered) {
  double reach = 0;
  for (const double r : kReaches) {
    reach = r;
    gathered.clear();
    frame.gather({p_W, r * unit_m}, kernels, gathered);
    gathered.finish();
    if (gathered.size() >= kEnough) break;
  }
  return reach;
}

// Returns the unit normal (4.1) over a wide reach, with the Wendland function of the distance itself; zero if
// it is not determined. The terms are rounded, so that their sum does not depend on their order.
Vec3 wide_normal(const GatheredPoints& gathered, const Vec3& p_W, double reach_m) {
  Vec3 sum = Vec3::Zero();
  const PointsView all = gathered.view();
  for (std::size_t i = 0; i < gathered.size(); ++i) {
    const Vec3 away = (p_W - Vec3(all.x[i], all.y[i], all.z[i])) / reach_m;
    const double q = away.norm(), rest = 1 - q;
    if (!(q > 0) || rest <= 0) continue;
    const Vec3 term = away * (rest * rest * rest * rest * (4 * q + 1) / q);
    for (int k = 0; k < 3; ++k) sum[k] += std::nearbyint(term[k] * 0x1p30) * 0x1p-30;
  }
  const double length = sum.norm();
  return length > 1e-6 ? Vec3(sum / length) : Vec3::Zero();
}

// Fills the profile with the heights of the points around the foot of the perpendicular, in a circle that is
// wide enough to hold some. Returns the radius of the circle; 0 if it holds fewer than three points.
double profile_of_column(const PatchPoints& points, double half_range, HeightProfile& profile) {
  for (double radius = 2.5;; radius *= 1.4) {
    profile.clear(half_range);
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PatchPlace p = points.place(i);
      if (p.u * p.u + p.v * p.v <= radius * radius) profile.add(p.h), ++count;
    }
    if (count >= 30 || 1.4 * radius > HeightMap::kHalf) return count >= 3 ? radius : 0;
  }
}

// Returns the height of the mode that is nearest to the height of the proxy. Small modes are ignored. NaN:
// none.
double nearest_mode(const HeightProfile& smooth, double proxy_height) {
  constexpr double kMinFraction = 0.4;
  const double min = kMinFraction * smooth.max();
  double mode = std::numeric_limits<double>::quiet_NaN(), nearest = std::numeric_limits<double>::infinity();
  for (int b = 1; b + 1 < smooth.bins(); ++b) {
    const double c = smooth.count(b);
    if (c < min || c < smooth.count(b - 1) || c < smooth.count(b + 1)) continue;
    const double distance = std::abs(proxy_height - smooth.centre(b));
    if (distance < nearest) nearest = distance, mode = smooth.centre(b);
  }
  return mode;
}

}  // namespace

std::optional<FoundSheet> find_sheet(const NeighbourSearch& frame, const Vec3& proxy_W,
                                     double contact_radius_m, const Kernels& kernels,
                                     const AcquisitionBuffers& buffers) {
  const double reach = gather_near(frame, proxy_W, contact_radius_m, kernels, buffers.gathered);
  if (buffers.gathered.size() < kMinGathered) return {};
  Vec3 normal = wide_normal(buffers.gathered, proxy_W, reach * contact_radius_m);
  if (normal.isZero(0)) return {};
  FoundSheet found;
  PatchPoints& points = buffers.points;
  Vec3 foot_W = proxy_W;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    found.frame = PatchFrame(foot_W, normal, contact_radius_m);
    points.set_points(buffers.gathered, {found.frame, HeightMap::kHalf, reach});
    HeightProfile profile;
    const double radius = profile_of_column(points, reach, profile);
    if (!(radius > 0)) return {};
    const HeightProfile smooth =
        profile.smoothed(round == 0 ? 0.3 : std::max(0.2, 0.5 * found.sigma.value_or(0)));
    const double mode = nearest_mode(smooth, found.frame.place(proxy_W).h);
    if (!std::isfinite(mode)) return {};
    const double top = mode + smooth.valley_from(mode, 1), bottom = mode - smooth.valley_from(mode, -1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PatchPlace p = points.place(i);
      points.set_member(i, p.u * p.u + p.v * p.v <= radius * radius && p.h < top && p.h > bottom);
    }
    buffers.fit.set_points(points);
    const PlaneFit plane = buffers.fit.plane_around(0, 0, radius);
    if (const double noise = buffers.fit.noise(); !std::isnan(noise)) found.sigma = noise;
    found.known = radius;
    if (!plane.valid) return {};
    const double steep = std::hypot(plane.slope_u, plane.slope_v);
    if (round + 1 == kRounds && steep > 1) return {};
    const double keep = steep > 1 ? 1 / steep : 1;
    normal = found.frame.normal_W(keep * plane.slope_u, keep * plane.slope_v);
    const Vec3 on_it_W = found.frame.world({0, 0, plane.height});
    foot_W = proxy_W - (proxy_W - on_it_W).dot(normal) * normal;
  }
  found.frame = PatchFrame(foot_W, normal, contact_radius_m);
  return found;
}

}  // namespace remote_touch
