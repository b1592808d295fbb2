#include "scenarios/simulated/panel_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/points/vector.h"

namespace remote_touch {
namespace {

// Tolerance for a border that falls on a point of the grid, and for distances that differ only by rounding.
constexpr double kOnPanel_m = 1e-9;
// Normals whose directions differ by less than this belong to parallel planes.
constexpr double kParallel = 1e-6;

int first_index(double half_m, double phase_m, double spacing_m) {
  return static_cast<int>(std::ceil((-half_m - phase_m - kOnPanel_m) / spacing_m));
}
int last_index(double half_m, double phase_m, double spacing_m) {
  return static_cast<int>(std::floor((half_m - phase_m + kOnPanel_m) / spacing_m));
}

// Returns true if the vector from the nearest point q on the panels to p is a combination of the normals of
// the panels that contain q: p lies over the inside of a panel, or over an edge or corner at which panels
// meet. Returns false if p lies beyond a border that no other panel continues.
bool faces_the_inside(std::span<const FlatPanel> panels, const Vec3& p, const Vec3& q) {
  Vec3 rest = p - q;  // p - q without its components along those normals
  std::array<Vec3, 3> axes;
  std::size_t count = 0;
  for (const FlatPanel& panel : panels) {
    if (count == axes.size()) break;
    if ((panel.nearest(q) - q).norm() > kOnPanel_m) continue;
    Vec3 axis = panel.normal;
    for (std::size_t i = 0; i < count; ++i) axis -= axis.dot(axes[i]) * axes[i];
    if (axis.norm() < kParallel) continue;
    axes[count] = axis.normalized();
    rest -= rest.dot(axes[count]) * axes[count];
    ++count;
  }
  return rest.norm() <= kOnPanel_m;
}

// Columns of Settings::plates.
struct PlateColumn {
  enum { x, y, z, size_x, size_z, velocity_x, velocity_y, from_s, until_s };
};

}  // namespace

Vec3 FlatPanel::nearest(const Vec3& p) const {
  const Vec3 from_centre = p - centre;
  return centre + std::clamp(from_centre.dot(u), -half_u_m, half_u_m) * u +
         std::clamp(from_centre.dot(v()), -half_v_m, half_v_m) * v();
}

void append(PointCloud& cloud, const FlatPanel& panel, const PanelGrid& grid) {
  const double s = grid.spacing_m;
  const Vec3 v = panel.v();
  const int last_u = last_index(panel.half_u_m, grid.phase_u_m, s);
  const int last_v = last_index(panel.half_v_m, grid.phase_v_m, s);
  for (int j = first_index(panel.half_v_m, grid.phase_v_m, s); j <= last_v; ++j)
    for (int i = first_index(panel.half_u_m, grid.phase_u_m, s); i <= last_u; ++i)
      cloud.append(panel.centre + (i * s + grid.phase_u_m) * panel.u + (j * s + grid.phase_v_m) * v,
                   panel.normal);
}

int columns(const FlatPanel& panel, const PanelGrid& grid) {
  return last_index(panel.half_u_m, grid.phase_u_m, grid.spacing_m) -
         first_index(panel.half_u_m, grid.phase_u_m, grid.spacing_m) + 1;
}

double signed_distance(std::span<const FlatPanel> panels, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity(), over = 0;
  Vec3 foot = p;
  for (const FlatPanel& panel : panels) {
    const Vec3 on_panel = panel.nearest(p);
    const double distance = (p - on_panel).norm();
    const double height = panel.normal.dot(p - panel.centre);
    if (distance > nearest + kOnPanel_m) continue;
    if (distance < nearest - kOnPanel_m || std::abs(height) > std::abs(over)) over = height;
    if (distance < nearest) nearest = distance, foot = on_panel;
  }
  if (over >= 0) return nearest;
  return faces_the_inside(panels, p, foot) ? -nearest : std::numeric_limits<double>::quiet_NaN();
}

PointCloud PanelScene::cloud(int frame) const {
  PointCloud cloud;
  const std::vector<FlatPanel> all = panels(captured_s(frame));
  for (const FlatPanel& panel : all) append(cloud, panel, grid_);
  if (all.size() == 1) cloud.grid_columns = columns(all.front(), grid_);  // else rows have several widths
  return cloud;
}

double PanelScene::signed_distance(const Vec3& p_W, double time_s) const {
  return remote_touch::signed_distance(panels(time_s), p_W);
}

std::optional<Vec3> PanelScene::plane_normal(double time_s) const {
  const std::vector<FlatPanel> all = panels(time_s);
  if (all.size() != 1) return {};
  return all.front().normal;
}

Parameters parameters(OpenBox::Settings& s) {
  return {
      {"size_m", &s.size_m, 0, 10, "inner size along x, y (up) and z; the middle of the box is the origin"},
      {"spacing_m", &s.spacing_m, 1e-4, 1, "distance between neighbouring points"},
      {"floor", &s.floor, 0, 1, "true: four walls and a floor; false: the four walls only"},
  };
}

std::vector<FlatPanel> OpenBox::panels(double) const {
  const Vec3 half = 0.5 * settings_.size_m;
  std::vector<FlatPanel> sides;
  for (const double side : {-1.0, 1.0})
    sides.push_back(
        {side * half.x() * Vec3::UnitX(), -side * Vec3::UnitX(), Vec3::UnitZ(), half.z(), half.y()});
  for (const double side : {-1.0, 1.0})
    sides.push_back(
        {side * half.z() * Vec3::UnitZ(), -side * Vec3::UnitZ(), Vec3::UnitX(), half.x(), half.y()});
  if (settings_.floor)
    sides.push_back({-half.y() * Vec3::UnitY(), Vec3::UnitY(), Vec3::UnitX(), half.x(), half.z()});
  return sides;
}

Parameters parameters(SinglePanel::Settings& s) {
  return {
      {"centre_m", &s.centre_m, -100, 100, "middle of the panel"},
      {"normal", &s.normal, -1, 1, "towards the side that the sensor sees; any length"},
      {"width_m", &s.width_m, 1e-3, 10,
       "size along the horizontal direction of the panel; x where it lies flat"},
      {"height_m", &s.height_m, 1e-3, 10, "size along the other direction of the panel"},
      {"spacing_m", &s.spacing_m, 1e-4, 1, "distance between neighbouring points"},
  };
}

std::vector<FlatPanel> SinglePanel::panels(double) const {
  const Vec3 normal = settings_.normal.normalized(), level = Vec3::UnitY().cross(normal);
  const Vec3 u =
      level.norm() > 1e-6 ? Vec3(level.normalized()) : (Vec3::UnitX() - normal.x() * normal).normalized();
  return {{settings_.centre_m, normal, u, 0.5 * settings_.width_m, 0.5 * settings_.height_m}};
}

Parameters parameters(Slot::Settings& s) {
  return {
      {"width_m", &s.width_m, 1e-3, 10, "distance between the walls, along z"},
      {"length_m", &s.length_m, 1e-3, 10, "length of the walls, along x"},
      {"height_m", &s.height_m, 1e-3, 10, "height of the walls, along y"},
      {"spacing_m", &s.spacing_m, 1e-4, 1, "distance between neighbouring points"},
      {"phase_m", &s.phase_m, -1, 1, "offset of the points along x"},
  };
}

std::vector<FlatPanel> Slot::panels(double) const {
  std::vector<FlatPanel> walls;
  for (const double side : {-1.0, 1.0})
    walls.push_back({side * 0.5 * settings_.width_m * Vec3::UnitZ(), -side * Vec3::UnitZ(), Vec3::UnitX(),
                     0.5 * settings_.length_m, 0.5 * settings_.height_m});
  return walls;
}

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
