#include "scenarios/synthetic/plates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace remote_touch {

namespace {

// Columns of Settings::plates.
struct PlateColumn {
  enum { x, y, z, size_x, size_z, velocity_x, velocity_y, from_s, until_s };
};

}  // namespace

Parameters parameters(Plates::Settings& s) {
  const Parameters more = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
      {"plates",
       Rows{{"x_m", "y_m", "z_m", "size_x_m", "size_z_m", "velocity_x_m_per_s", "velocity_y_m_per_s",
             "from_s", "until_s"},
            &s.plates},
       -1000, 1000,
       "a row for each plate: centre at the start, size along x and z, velocity along x and y in m/s, when it starts and stops to move; the first is the true surface"},
      {"max_height_m", &s.max_height_m, -1000, 1000,
       "a plate higher than this is too near to the camera: it gives no points, but hides what is below"},
      {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1, "standard deviation of the noise on x, y and z", kLive},
      {"truth", choice(s.truth, {"newest-frame", "moving"}), 0, 0,
       "true surface: newest-frame: as at the last capture; moving: as it moves between frames"},
  };
  return appended(parameters(s.grid), more);
}

std::string validate(const Plates::Settings& s) {
  if (s.plates.empty()) return "plates = []: expected one row or more";
  for (std::size_t first = 0; first < s.plates.size(); first += Plates::kColumns)
    if (!(s.plates[first + PlateColumn::size_x] > 0 && s.plates[first + PlateColumn::size_z] > 0))
      return "plates: row " + std::to_string(first / Plates::kColumns + 1) + ": expected sizes above 0";
  return "";
}

bool Plates::moves(std::size_t number) const {
  const double* row = settings_.plates.data() + number * kColumns;
  const bool has_velocity = row[PlateColumn::velocity_x] != 0 || row[PlateColumn::velocity_y] != 0;
  return has_velocity && row[PlateColumn::until_s] > row[PlateColumn::from_s];
}

std::vector<Phase> Plates::phases() const {
  std::vector<Phase> list;
  for (std::size_t i = 0; i < plate_count(); ++i) {
    const double* row = settings_.plates.data() + i * kColumns;
    if (moves(i))
      list.push_back({"the motion of plate " + std::to_string(i + 1), row[PlateColumn::from_s],
                      row[PlateColumn::until_s]});
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const Phase& a, const Phase& b) { return a.ends_s < b.ends_s; });
  return list;
}

int Plates::frame_count() const {
  double until = 0;
  for (std::size_t i = 0; i < plate_count(); ++i)
    if (moves(i)) until = std::max(until, settings_.plates[i * kColumns + PlateColumn::until_s]);
  if (settings_.noise_sigma_m > 0) return std::numeric_limits<int>::max();
  return static_cast<int>(std::ceil(until * settings_.frame_rate_hz)) + 1;
}

FlatPanel Plates::plate(std::size_t number, double time_s) const {
  const double* row = settings_.plates.data() + number * kColumns;
  const double moving_s =
      std::max(0.0, std::min(time_s, row[PlateColumn::until_s]) - row[PlateColumn::from_s]);
  FlatPanel panel;
  panel.centre = {row[PlateColumn::x] + moving_s * row[PlateColumn::velocity_x],
                  row[PlateColumn::y] + moving_s * row[PlateColumn::velocity_y], row[PlateColumn::z]};
  panel.half_u_m = 0.5 * row[PlateColumn::size_x], panel.half_v_m = 0.5 * row[PlateColumn::size_z];
  return panel;
}

PointCloud Plates::cloud(int frame) const {
  std::vector<FlatPanel> panels;
  for (std::size_t i = 0; i < plate_count(); ++i) panels.push_back(plate(i, captured_s(frame)));
  const auto highest_over = [&](double px, double pz) {
    double height = -std::numeric_limits<double>::infinity();
    for (const FlatPanel& panel : panels)
      if (std::abs(px - panel.centre.x()) <= panel.half_u_m &&
          std::abs(pz - panel.centre.z()) <= panel.half_v_m)
        height = std::max(height, panel.centre.y());
    return height;
  };
  return sampled(frame, [&](double px, double pz) -> Vec3 {
    const double height = highest_over(px, pz);
    const bool is_seen = std::isfinite(height) && height <= settings_.max_height_m;
    return is_seen ? Vec3(px, height, pz) : Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  });
}

double Plates::signed_distance(const Vec3& p_W, double time_s) const {
  const FlatPanel panel = plate(0, truth_time_s(time_s));
  return remote_touch::signed_distance(std::span(&panel, 1), p_W);
}

double Plates::surface_height(double, double, double time_s) const {
  return plate(0, time_s).centre.y();
}

}  // namespace remote_touch
