#include "scenarios/synthetic/wedge.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/rotation.h"

namespace remote_touch {

Parameters parameters(Wedge::Settings& s) {
  return {
      {"angle_deg", &s.angle_deg, 0, 170, "angle between the walls; 0: they are parallel"},
      {"length_m", &s.length_m, 1e-3, 10, "length of the walls, along x"},
      {"height_m", &s.height_m, 1e-3, 10, "height of the walls, along their slope"},
      {"spacing_m", &s.spacing_m, 1e-4, 1, "distance between neighbouring points"},
      {"open_gap_m", &s.open_gap_m, 0, 10, "distance of the lower edges while open"},
      {"closed_gap_m", &s.closed_gap_m, 0, 10, "distance of the lower edges while closed; 0: they touch"},
      {"close_start_s", &s.close_start_s, 0, 1e4, "time at which the walls start to close"},
      {"close_end_s", &s.close_end_s, 0, 1e4, "time at which the walls are closed"},
      {"open_start_s", &s.open_start_s, 0, 1e4, "time at which the walls start to open again"},
      {"open_end_s", &s.open_end_s, 0, 1e4, "time at which the walls are open again"},
      {"offset_m", &s.offset_m, -10, 10, "shift of the wedge along z"},
      {"tilt_deg", &s.tilt_deg, -90, 90,
       "rotation of the wedge about x, through the middle of its lower edges"},
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
  };
}

std::string validate(const Wedge::Settings& s) {
  const double times[] = {s.close_start_s, s.close_end_s, s.open_start_s, s.open_end_s};
  return std::is_sorted(std::begin(times), std::end(times))
             ? ""
             : "close_start_s, close_end_s, open_start_s, open_end_s: expected in ascending order";
}

Wedge::Wedge(const Settings& settings, const NoiseKey&, const Kernels&)
    : PanelScene({settings.spacing_m}),
      settings_(settings),
      frame_count_(1 + static_cast<int>(std::ceil(settings.open_end_s * settings.frame_rate_hz - 1e-6))) {
  const auto [s, c] = sin_cos(settings.tilt_deg * kRadiansPerDegree);
  up_ = {0, c, s}, across_ = {0, -s, c};
  std::tie(sine_, cosine_) = sin_cos(0.5 * settings.angle_deg * kRadiansPerDegree);
}

std::vector<Phase> Wedge::phases() const {
  const Settings& s = settings_;
  if (s.open_gap_m == s.closed_gap_m || !(s.open_end_s > s.close_start_s)) return {};
  return {{"the closing of the walls", s.close_start_s, s.close_end_s},
          {"the opening of the walls", s.open_start_s, s.open_end_s}};
}

double Wedge::gap_m(double time_s) const {
  const Settings& s = settings_;
  if (time_s < s.close_start_s || time_s >= s.open_end_s) return s.open_gap_m;
  if (time_s >= s.close_end_s && time_s <= s.open_start_s) return s.closed_gap_m;
  const double open = time_s < s.close_end_s ? (s.close_end_s - time_s) / (s.close_end_s - s.close_start_s)
                                             : (time_s - s.open_start_s) / (s.open_end_s - s.open_start_s);
  return s.closed_gap_m + open * (s.open_gap_m - s.closed_gap_m);
}

std::vector<FlatPanel> Wedge::panels(double time_s) const {
  std::vector<FlatPanel> walls;
  for (const double side : {-1.0, 1.0}) {
    const Vec3 outwards = side * across_, slope = cosine_ * up_ + sine_ * outwards;
    const Vec3 lower_edge = settings_.offset_m * Vec3::UnitZ() + 0.5 * gap_m(time_s) * outwards;
    walls.push_back({lower_edge + 0.5 * settings_.height_m * slope, sine_ * up_ - cosine_ * outwards,
                     Vec3::UnitX(), 0.5 * settings_.length_m, 0.5 * settings_.height_m});
  }
  return walls;
}

}  // namespace remote_touch
