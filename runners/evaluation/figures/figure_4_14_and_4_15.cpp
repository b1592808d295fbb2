// Fig 4.14: sharp corners, against what a ball of radius r_c can reach.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/theory/surface_contacts.h"
#include "analysis/trace/contact_measures.h"
#include "analysis/trace/interval_estimates.h"
#include "core/kernels/isa.h"
#include "core/points/point_cloud.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/figure_pictures.h"
#include "runners/evaluation/figures/parts/fixture_run.h"
#include "scenarios/simulated/depth_camera.h"
#include "scenarios/simulated/depth_sensor.h"

namespace remote_touch {

namespace {

constexpr double kSampling_m = 1e-5;  // sampling of the exact profile; its corners are multiples of it

// The true profile and its closing with a ball of radius r_c, sampled from x = low on.
struct Oracle {
  double low;
  std::vector<double> heights, closing;

  Oracle(const Scenario& scenario, double from, double to) : low(from) {
    for (int i = 0; from + i * kSampling_m <= to; ++i)
      heights.push_back(scenario.surface_height(from + i * kSampling_m, 0, 0));
    closing = ball_closing(heights, kSampling_m, kContactRadius_m);
  }
  double at(double x) const {
    const double place = (x - low) / kSampling_m;
    const auto i = static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(closing.size() - 2)));
    return closing[i] + (place - static_cast<double>(i)) * (closing[i + 1] - closing[i]);
  }
};

// Returns the contact points with x in [from, to], in the ticks in which the surface holds the HIP back.
Table contact_table(const Trace& trace, const Oracle& oracle, double from, double to) {
  std::vector<Vec3> contact;
  Numbers error, shell;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const Vec3 p = contact_point(trace, i, kContactRadius_m);
    if (!pressing(trace, i, kContactRadius_m) || p.x() < from || p.x() > to) continue;
    contact.push_back(p);
    error.push_back(p.y() - oracle.at(p.x()));
    shell.push_back(trace.nearest_distance_m[i] - kContactRadius_m);
  }
  return {"contact",
          "contact point",
          {{"x", "m", "position of the contact point", along(0, contact)},
           {"y", "m", "height of the contact point", along(1, contact)},
           {"error", "m", "height over the exact closing with a ball of r_c", error},
           {"shell", "m", "distance of the nearest point less r_c", shell}}};
}

Table profile_table(const Oracle& oracle) {
  const auto x = [&](std::size_t i) { return oracle.low + static_cast<double>(i) * kSampling_m; };
  return every(20, {"profile",
                    "exact profile and its closing",
                    {{"x", "m", "position", each_of(oracle.heights.size(), x)},
                     {"surface_y", "m", "true height", oracle.heights},
                     {"closing_y", "m", "height that a ball of r_c can reach", oracle.closing}}});
}

Table surface_table(const PointCloud& cloud) {
  Table table{"surface", "the points"};
  table.add("x", "m", "x of the point", {cloud.x.begin(), cloud.x.end()});
  table.add("y", "m", "height, y", {cloud.y.begin(), cloud.y.end()});
  table.add("z", "m", "z of the point", {cloud.z.begin(), cloud.z.end()});
  return table;
}

// Returns the points of the grid row under the path, and the position of the proxy when it is nearest to
// valley_x, the last full valley.
std::vector<Table> points_and_ball(const Scenario& scenario, const Trace& trace, double valley_x) {
  const PointCloud cloud = scenario.cloud(0);
  TableRows points;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (std::abs(cloud.z[i] - trace.hip_position_m[0].z()) < 1e-6) points.push_back({cloud.x[i], cloud.y[i]});
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (std::abs(trace.proxy_position_m[i].x() - valley_x) <
        std::abs(trace.proxy_position_m[nearest].x() - valley_x))
      nearest = i;
  const Vec3& ball = trace.proxy_position_m[nearest];
  const std::vector<ColumnName> columns = {{"x", "m", "position"}, {"y", "m", "height"}};
  return {table_of("points", "one row of the grid", columns, points),
          table_of("ball", "the proxy in a valley", columns, {{ball.x(), ball.y()}})};
}

}  // namespace

Figure figure_4_14(FigureContext& context) {
  const Experiment experiment = Experiment::load("fig4.14");
  const auto scenario = experiment.build_scenario(kernels_for(Isa::x86_64));
  const Trace trace = context.run(experiment);
  constexpr double kFrom = -0.2, kTo = 0.2;  // the ends of the grid have no neighbours on one side
  const Oracle oracle(*scenario, -0.22, 0.22);
  const Table contact = contact_table(trace, oracle, kFrom, kTo);
  Figure figure{
      "4.14", "Sharp corners",
      "A 300 x 100 cloud shaped as a triangle wave of growing amplitude. Top: the points as a "
      "surface. Middle: a cross-section of the wave and the contact point. Bottom: a part of it, "
      "with the points and the proxy, a ball of radius r_c. Convex corners are rendered sharp; in a "
      "valley the proxy rests on both flanks."};
  figure.tables = {contact, profile_table(oracle), surface_table(scenario->cloud(0))};
  for (Table& table : points_and_ball(*scenario, trace, 0.135)) figure.tables.push_back(std::move(table));
  const Curve points{"points", "x", "y", CurveStyle::dots, "points"};
  const Curve line{"contact", "x", "y", CurveStyle::line, "contact point"};
  figure.panels = {
      plot("The point cloud, x, y and z equally scaled", "x (m)", "z (m)",
           {{"surface", "x", "z", CurveStyle::surface, "", 0, "y"}}),
      plot("The whole wave", "x (m)", "y (m)",
           {{"profile", "x", "surface_y", CurveStyle::dashed, "surface"}, line}),
      plot("A part of it", "x (m)", "y (m)",
           {points,
            line,
            {"ball", "x", "y", CurveStyle::circle, "proxy, a ball of radius r_c", kContactRadius_m}},
           {.x_range = {{0.095, 0.175}}, .y_range = {{-0.014, 0.015}}, .equal_aspect = true})};
  const Claims claims(figure);
  const Numbers& error = numbers(contact, "error");
  claims.at_most("the contact point follows the exact closing of the wave with a ball of r_c: rms distance",
                 rms(error), 1e-4, "m", "very well");
  claims.at_most(
      "the contact point follows the exact closing of the wave with a ball of r_c: largest distance",
      max_of(magnitudes(error)), 5e-4, "m");
  claims.at_most("the nearest point is r_c from the proxy: largest difference",
                 max_of(magnitudes(numbers(contact, "shell"))), 2e-5, "m", "1e-5");
  return figure;
}

// Fig 4.15 b: the points that the depth camera of 4.16 measures; and such a scene as meshes with colours,
// with the proxy's path over the true profile. The photo of 4.15 a has no counterpart.

namespace {

// The part of the table that is shown.
constexpr double kAcross_4_15_m = 0.16, kFrom_4_15_m = -0.42, kTo_4_15_m = 0.28;

std::vector<std::size_t> points_of_4_15(const PointCloud& cloud) {
  return chosen_points(cloud, [&](std::size_t i) {
    const Vec3 p = cloud.point(i);  // a point that is NaN fails the test below
    return std::abs(p.x()) < kAcross_4_15_m && p.z() > kFrom_4_15_m && p.z() < kTo_4_15_m;
  });
}

// Returns the rms distance of the points to the true surface, in units of the standard deviation of their
// error along the ray. The error in depth is a Gaussian value that is then rounded to a step. The true
// surface is at most as far away as where the ray meets it, so the result is at most 1, except for chance:
// for N points one standard deviation is (2 N)^(-1/2), 0.3 % for 60 000.
double error_in_sigmas(const Scenario& scenario, const PointCloud& cloud) {
  const DepthCameraSettings camera =
      CameraScene::Settings().camera;  // the experiment leaves them as they are
  const RigidTransform X_CW = cloud.image->X_WC.inverse();
  const double sigma_per_m2 = std::hypot(camera.noise_per_m, camera.quantisation_per_m / std::sqrt(12.0));
  double squares = 0, count = 0;
  for (const std::size_t i : points_of_4_15(cloud)) {
    const Vec3 p_C = X_CW * cloud.point(i);
    const double along_ray_m = sigma_per_m2 * p_C.z() * p_C.norm();
    const double distance_m = scenario.signed_distance(cloud.point(i), 0);
    squares += distance_m * distance_m / (along_ray_m * along_ray_m), ++count;
  }
  return std::sqrt(squares / count);
}

}  // namespace

Figure figure_4_15(FigureContext& context) {
  const Experiment experiment = Experiment::load("fig4.16");
  context.uses(experiment);
  const auto scenario = experiment.build_scenario(context.kernels());
  const PointCloud cloud = scenario->cloud(0);
  Figure figure{"4.15", "Ramp and box as points, simulated depth camera",
                "The first frame of 4.16: a simulated depth camera above the scene, on the right, measures a "
                "ramp (behind) and a box (in front) on a table. Points near edges of depth are missing. The "
                "colour shows the height over the table. In the dissertation a Kinect camera sees the real "
                "objects (b), next to a photo (a)."};
  figure.tables = {cloud_table("scene_cloud", "points of the first frame", cloud, points_of_4_15(cloud))};
  for (Column& column : figure.tables[0].columns)
    if (column.name == "y") column.long_name = "height over the table";
  ScenePart points{ScenePart::Kind::points, "scene_cloud", 0x808080, 0.002};
  points.coloured_by = "y";
  figure.panels = {
      scene_panel("The point cloud", 0, 0,
                  {{0.55, 0.45, 0.62}, {-0.01, -0.04, -0.03}, Vec3::UnitY(), 0.8, 0.58, {points}})};
  Claims(figure).at_most(
      "the points lie on the true surface within the sensor's error: rms distance, in standard "
      "deviations of that error along the ray",
      error_in_sigmas(*scenario, cloud), 1.01, "1");
  return figure;
}

namespace {

constexpr double kSlice_m = 0.0015;      // half width of the slice below the path
constexpr std::size_t kStride_4_15 = 4;  // ticks, in tables

struct MeshRun {
  Experiment experiment;
  Trace trace;
  std::unique_ptr<Scenario> scenario;
  PointCloud cloud;  // first frame
  Numbers gap_m;     // from the proxy's ball to the true surface in each tick; NaN: no contact

  Numbers known_gaps_m() const {
    return where(gap_m, [this](std::size_t i) { return !std::isnan(gap_m[i]); });
  }
};

MeshRun ramp_run(FigureContext& context, const std::vector<std::string>& overrides) {
  Experiment experiment = Experiment::load("fig4.15", overrides);
  Trace t = context.run(experiment);
  Numbers gaps_m = each_of(t.length(), [&](std::size_t i) {
    const bool touches = t.frame_index[i] >= 0 && pressing(t, i, kContactRadius_m);
    return touches ? t.signed_distance_m[i] - kContactRadius_m : kNoValue;
  });
  auto scenario = experiment.build_scenario(context.kernels());
  PointCloud cloud = scenario->cloud(0);
  return {std::move(experiment), std::move(t), std::move(scenario), std::move(cloud), std::move(gaps_m)};
}

// Returns the largest error of a depth along the optical axis, at the largest depth that the proxy has while
// its gap is known: three standard deviations, the rounding included, and half of a step.
double largest_error_m(const MeshRun& run) {
  const RigidTransform X_CW = run.cloud.image->X_WC.inverse();
  double z_m = 0;
  for (std::size_t i = 0; i < run.trace.length(); ++i)
    if (!std::isnan(run.gap_m[i])) z_m = std::max(z_m, (X_CW * run.trace.proxy_position_m[i]).z());
  const auto number = [&](const char* name) {
    return run.experiment.value_at_start(std::string("scenario.") + name).get<double>();
  };
  DepthSensorSettings settings;
  settings.sensor = DepthSensorKind::structured_light;
  settings.camera.focal_px = number("focal_px");
  settings.baseline_m = number("baseline_m");
  settings.disparity_focal_px = number("disparity_focal_px");
  settings.noise_px = number("noise_px");
  settings.disparity_step_px = number("disparity_step_px");
  const Triangulation sensor = triangulation(settings);
  const double per_px = z_m * z_m / (sensor.focal_px * sensor.baseline_m);
  return 3 * (per_px * sensor.noise_px) + 0.5 * per_px * sensor.step_px;
}

bool is_in_slice(const PointCloud& cloud, std::size_t i) {
  const Vec3 p = cloud.point(i);  // a point that is NaN fails the test
  return std::abs(p.x()) < kSlice_m && p.z() > kFrom_4_15_m && p.z() < kTo_4_15_m;
}

// True for points of the slice on surfaces that the HIP follows, which face up, and not on walls.
bool is_below_path(const MeshRun& run, std::size_t i) {
  constexpr double kFacesUp = 0.5;
  return is_in_slice(run.cloud, i) && run.scenario->true_normal(run.cloud.point(i), 0).y() > kFacesUp;
}

// Returns how deep a ball of r_c sinks between four neighbouring points below the path, at most: r - (r^2 -
// a^2)^(1/2), where 2 a is the longer diagonal of the four points. Squares with a side above r_c, which have
// a depth edge, are left out.
double deepest_sink_m(const MeshRun& run) {
  constexpr double r = kContactRadius_m;
  const PointCloud& cloud = run.cloud;
  const auto width = static_cast<std::size_t>(cloud.image->camera.width);
  double sink_m = kNoValue;
  for (std::size_t i = 0; i + width + 1 < cloud.size(); ++i) {
    if (i % width + 1 == width || !is_below_path(run, i)) continue;
    const Vec3 a = cloud.point(i), b = cloud.point(i + 1), c = cloud.point(i + width),
               d = cloud.point(i + width + 1);
    const double side_m = std::max({(b - a).norm(), (c - a).norm(), (d - b).norm(), (d - c).norm()});
    if (!(side_m < r) || !d.allFinite()) continue;  // or NaN: a point is missing
    const double half_m = 0.5 * std::max((d - a).norm(), (c - b).norm());
    sink_m = std::fmax(sink_m, r - std::sqrt(r * r - half_m * half_m));
  }
  return sink_m;
}

// Returns the height of the true surface over z in the plane of the path, seen from above.
double true_height(const Scenario& scenario, double z) {
  constexpr double kAbove_m = 0.2, kOnSurface_m = 1e-7;
  constexpr int kMostSteps = 1000;
  double y = kAbove_m;
  for (int step = 0; step < kMostSteps; ++step) {
    const double distance_m = scenario.signed_distance({0, y, z}, 0);  // no surface is nearer
    if (!(distance_m > kOnSurface_m)) break;
    y -= distance_m;
  }
  return y;
}

Table profile_table(const Scenario& scenario) {
  constexpr double kStep_m = 0.001;
  TableRows rows;
  for (double z = kFrom_4_15_m + 0.5 * kStep_m; z < kTo_4_15_m; z += kStep_m)
    rows.push_back({z, true_height(scenario, z)});
  return table_of("profile", "true surface in the plane of the path",
                  {{"along", "m", "along the path"}, {"up", "m", "height over the table"}}, rows);
}

Table path_table(const MeshRun& run, const MeshRun& exact) {
  const Trace& t = run.trace;
  return every(kStride_4_15,
               {"path",
                "paths of HIP and proxy, gap of the proxy's ball, and force",
                {{"time", "s", "simulated time", t.time_s},
                 {"hip_along", "m", "HIP along the path", along(2, t.hip_position_m)},
                 {"hip_up", "m", "height of the HIP", along(1, t.hip_position_m)},
                 {"proxy_along", "m", "proxy along the path", along(2, t.proxy_position_m)},
                 {"proxy_up", "m", "height of the proxy", along(1, t.proxy_position_m)},
                 {"gap", "m", "from the proxy's ball to the true surface; NaN: no contact", run.gap_m},
                 {"exact_gap", "m", "the same with a camera without noise and rounding", exact.gap_m},
                 {"force", "N", "magnitude of the force", norms(t.force_N)}}});
}

Table slice_of_points(const PointCloud& cloud) {
  TableRows rows;
  for (const std::size_t i : chosen_points(cloud, [&](std::size_t i) { return is_in_slice(cloud, i); }))
    rows.push_back({cloud.point(i).z(), cloud.point(i).y()});
  return table_of("slice", "points of the first frame within 1.5 mm of the path",
                  {{"along", "m", "along the path"}, {"up", "m", "height over the table"}}, rows);
}

Table coloured_points(PointCloud cloud) {
  for (std::uint32_t& colour : cloud.colour) colour = shown_colour(colour);
  return cloud_table("scene_cloud", "points of the first frame", cloud, points_of_4_15(cloud));
}

double rms_point_distance_m(const MeshRun& run) {
  return rms(values_where(
      run.cloud.size(), [&](std::size_t i) { return is_below_path(run, i); },
      [&](std::size_t i) { return run.scenario->signed_distance(run.cloud.point(i), 0); }));
}

void add_claims(Figure& figure, const MeshRun& run, const MeshRun& exact) {
  add_side_claim(figure, "", run.trace);
  add_sound_claims(figure, "", run.trace);
  const Numbers gaps_m = run.known_gaps_m(), exact_gaps_m = exact.known_gaps_m();
  const Claims claims(figure);
  claims.at_most(
      "the proxy stays on the true surface within the largest error of a depth (three standard "
      "deviations and half a step): largest gap between its ball and the surface",
      max_of(magnitudes(gaps_m)), largest_error_m(run), "m");
  claims.between(
      "the proxy rests on the points that noise brings nearest to the camera: its rms gap, divided by "
      "the rms distance of the points below the path from the true surface",
      rms(gaps_m) / rms_point_distance_m(run), 1, 1.5, "1");
  claims.at_most(
      "with a camera without noise and rounding, the ball only sinks between the points: largest gap",
      max_of(magnitudes(exact_gaps_m)), deepest_sink_m(exact), "m");
  claims.at_most(
      "nearly all of the error is the camera's: rms gap without its errors, divided by that with them",
      rms(exact_gaps_m) / rms(gaps_m), 0.1, "1");
}

void add_panels(Figure& figure, double largest_m) {
  ScenePart points{ScenePart::Kind::points, "scene_cloud", 0x808080, 0.002};
  figure.panels = {
      scene_panel("The point cloud", 0, 0,
                  {{0.55, 0.45, 0.62}, {-0.01, -0.04, -0.03}, Vec3::UnitY(), 0.8, 0.58, {points}}),
      plot("Paths over the table", "z (m)", "y (m)",
           {{"slice", "along", "up", CurveStyle::dots, "points, first frame"},
            {"profile", "along", "up", CurveStyle::line, "true surface"},
            {"path", "hip_along", "hip_up", CurveStyle::dashed, "HIP"},
            {"path", "proxy_along", "proxy_up", CurveStyle::line, "proxy"}},
           {.x_range = {{kFrom_4_15_m, kTo_4_15_m}}, .equal_aspect = true}),
      plot("Gap between the proxy's ball and the true surface", "z (m)", "gap (m)",
           {{"bounds", "along", "high", CurveStyle::line, "bound: 3 sigma and half a step"},
            {"bounds", "along", "low", CurveStyle::line, "bound: 3 sigma and half a step"},
            {"path", "hip_along", "gap", CurveStyle::line, "structured light"},
            {"path", "hip_along", "exact_gap", CurveStyle::line, "no noise, no rounding"}},
           {.x_range = {{kFrom_4_15_m, kTo_4_15_m}}})};
  figure.tables.push_back(
      table_of("bounds", "largest error of a depth at the largest depth of the path",
               {{"along", "m", "along the path"},
                {"high", "m", "upper bound of the gap"},
                {"low", "m", "lower bound of the gap"}},
               {{kFrom_4_15_m, largest_m, -largest_m}, {kTo_4_15_m, largest_m, -largest_m}}));
}

}  // namespace

Figure figure_4_15_meshes(FigureContext& context) {
  const MeshRun run = ramp_run(context, {}),
                exact = ramp_run(context, {"scenario.noise_px=0", "scenario.disparity_step_px=0",
                                           "scenario.lateral_noise_px=0"});
  Figure figure{"4.15-meshes", "Ramp and box as meshes with colours, simulated Kinect",
                "A structured-light camera above the scene, on the right, sees a ramp (behind) and a box (in "
                "front) on a table: meshes with colours, as in Fig 4.15 b. The ramp is a tilted cube, partly "
                "below the table. Middle: the HIP moves along z, 10 mm below the true surface, and lifts off "
                "over the steps. Bottom: the gap between the proxy's ball and the true surface, and the same "
                "with a camera without noise and rounding, which shows the error of the renderer alone."};
  figure.tables = {coloured_points(run.cloud), profile_table(*run.scenario), path_table(run, exact),
                   slice_of_points(run.cloud)};
  add_panels(figure, largest_error_m(run));
  add_claims(figure, run, exact);
  return figure;
}

}  // namespace remote_touch
