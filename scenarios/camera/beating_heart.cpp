#include "scenarios/camera/beating_heart.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

// Ends of the phases of a ventricle, as fractions of a beat: it contracts, stays contracted, relaxes, and
// rests until the beat ends. The atrium is ahead of the ventricles by kAtriumLeads.
constexpr double kContracted = 0.3, kRelaxes = 0.35, kRelaxed = 0.75;
constexpr double kAtriumLeads = 0.18;

// Vertical semi-axis of the left ventricle, which ends at the organ's top. amplitude_m is the largest
// decrease of this semi-axis.
constexpr double kTopSemiAxis_m = 0.032;

// Reds that differ a little (hues 3 to 11 degrees) for the organ, and hue 190 for the drape on the table.
constexpr std::uint32_t kLeftVentricle = 0xB23A30, kRightVentricle = 0xC4553C, kAtrium = 0x9A2F2A;
constexpr std::uint32_t kTable = 0x3A6E78;

// Rises from 0 to 1 with zero velocity and zero acceleration at both ends.
double smooth_step(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 - u * (15 - 6 * u));
}

// A turn of 16.3 degrees about y.
Eigen::Matrix3d turned() {
  Eigen::Matrix3d axes;
  axes << 0.96, 0, 0.28,  //
      0, 1, 0,            //
      -0.28, 0, 0.96;
  return axes;
}

}  // namespace

Parameters parameters(BeatingHeart::Settings& s) {
  const Parameters own = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the camera per second, f_c"},
      {"rate_per_min", &s.rate_per_min, 1, 600, "beats per minute"},
      {"amplitude_m", &s.amplitude_m, 0, 0.015,
       "amplitude of the motion of the organ's top in each beat; 0: no motion"},
  };
  return appended(own, parameters(s.camera));
}

BeatingHeart::BeatingHeart(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings), camera_(settings.camera, key, kernels) {}

int BeatingHeart::frame_count() const {
  return settings_.amplitude_m > 0 || camera_.noisy() ? std::numeric_limits<int>::max() : 1;
}

double BeatingHeart::contraction(double beats) {
  const double phase = beats - std::floor(beats);
  return phase < kRelaxes ? smooth_step(phase / kContracted)
                          : 1 - smooth_step((phase - kRelaxes) / (kRelaxed - kRelaxes));
}

std::array<BeatingHeart::Lobe, 3> BeatingHeart::lobes(double time_s) const {
  const double beats = time_s * settings_.rate_per_min / 60;
  const double max = settings_.amplitude_m / kTopSemiAxis_m;
  const double ventricles = 1 - max * contraction(beats);
  const double atrium = 1 - max * contraction(beats + kAtriumLeads);
  return {{
      {Ellipsoid({0, 0.028, 0}, ventricles * Vec3(0.040, kTopSemiAxis_m, 0.034)), kLeftVentricle},
      {Ellipsoid({0.004, 0.020, 0.024}, ventricles * Vec3(0.036, 0.026, 0.026), turned()), kRightVentricle},
      {Ellipsoid({-0.035, 0.022, -0.004}, atrium * Vec3(0.020, 0.022, 0.024)), kAtrium},
  }};
}

double BeatingHeart::surface_height(double x, double z, double time_s) const {
  double height = 0;
  for (const Lobe& lobe : lobes(time_s)) height = std::max(height, lobe.solid.height(x, z));
  return height;
}

double BeatingHeart::signed_distance(const Vec3& p_W, double time_s) const {
  double distance = p_W.y();
  for (const Lobe& lobe : lobes(time_s)) distance = std::min(distance, lobe.solid.signed_distance(p_W));
  return distance;
}

PointCloud BeatingHeart::cloud(int frame) const {
  const auto now = lobes(captured_s(frame));
  const auto cast = [&now](const Vec3& origin_W, const Vec3& ray_W) {
    RayHit hit;
    if (ray_W.y() < 0) hit = {-origin_W.y() / ray_W.y(), kTable};
    for (const Lobe& lobe : now) {
      const double t = lobe.solid.cast(origin_W, ray_W);
      if (t < hit.t) hit = {t, lobe.colour};
    }
    return hit;
  };
  return camera_.measured(camera_.view(cast, /*coloured=*/true), frame);
}

}  // namespace remote_touch
