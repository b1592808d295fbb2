// Fig 4.15 b: the points that the depth camera of 4.16 measures; and such a scene as meshes with colours,
// with the proxy's path over the true profile. The photo of 4.15 a has no counterpart. Fig 4.16: the proxy
// over a ramp and a box seen by a depth camera, simulated and recorded.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/measures.h"
#include "core/kernels/kernels.h"
#include "core/points/point_cloud.h"
#include "runners/evaluation/figures/figure_pictures.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "scenarios/simulated/depth_camera.h"

namespace remote_touch {

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

constexpr double kSlice_m = 0.0015;  // half width of the slice below the path

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
  return every(4, {"path",
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
  const auto in_slice = [&](std::size_t i) { return is_in_slice(cloud, i); };
  return {"slice",
          "points of the first frame within 1.5 mm of the path",
          {{"along", "m", "along the path", where(cloud.z, in_slice)},
           {"up", "m", "height over the table", where(cloud.y, in_slice)}}};
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
  PointCloud shown = run.cloud;
  for (std::uint32_t& colour : shown.colour) colour = shown_colour(colour);
  figure.tables = {cloud_table("scene_cloud", "points of the first frame", shown, points_of_4_15(shown)),
                   profile_table(*run.scenario), path_table(run, exact), slice_of_points(run.cloud)};
  add_panels(figure, largest_error_m(run));
  add_claims(figure, run, exact);
  return figure;
}

// Fig 4.16.

namespace {

// Positions along one axis and heights along another, of HIP and proxy, and the force.
Table path_table(const std::string& name, const Trace& t, int scan, int up) {
  return {
      name,
      "paths of HIP and proxy, and the force",
      {{"time", "s", "simulated time", t.time_s},
       {"proxy_along", "m", "proxy along the scan", along(scan, t.proxy_position_m)},
       {"proxy_up", "m", "proxy across the scan", along(up, t.proxy_position_m)},
       {"hip_along", "m", "HIP along the scan", along(scan, t.hip_position_m)},
       {"hip_up", "m", "HIP across the scan", along(up, t.hip_position_m)},
       {"force", "N", "magnitude of the force", norms(t.force_N)},
       {"signed_distance", "m", "distance of the proxy's centre to the true surface", t.signed_distance_m}}};
}

// The first frame's points within a slice around the scan.
template <class InSlice>
Table slice_table(const std::string& name, const PointCloud& cloud, int along, int up, InSlice&& in_slice) {
  TableRows rows;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p = cloud.point(i);
    if (p.allFinite() && in_slice(p)) rows.push_back({p[along], p[up]});
  }
  return table_of(name, "points of the first frame near the scan",
                  {{"along", "m", "along the scan"}, {"up", "m", "across the scan"}}, rows);
}

void add_claims(Figure& figure, const std::string& where, const Trace& trace) {
  const std::string prefix = where.empty() ? "" : where + ": ";
  add_side_claim(figure, prefix, trace);
  add_sound_claims(figure, prefix, trace);
  // The claim leaves out the other ticks. Its value is NaN if the HIP is never held back.
  const auto touches = [&](std::size_t i) { return pressing(trace, i, kContactRadius_m); };
  const auto is_known = [&](std::size_t i) { return std::isnan(trace.signed_distance_m[i]) ? 0 : 1; };
  Claims(figure, prefix, &Claim::set_up)
      .at_least("the true side of the surface is known in most touching ticks: fraction of them",
                mean_where(trace.length(), touches, is_known), 0.7, "fraction");
}

// Returns the limits of an axis around a path, so that points far away do not shrink the path in the picture.
std::pair<double, double> around(const Trace& trace, int axis) {
  Numbers places = along(axis, trace.hip_position_m), proxy = along(axis, trace.proxy_position_m);
  places.insert(places.end(), proxy.begin(), proxy.end());
  return {min_of(places) - 0.03, max_of(places) + 0.03};
}

void add_panels(Figure& figure, const std::string& title, const std::string& table, const std::string& slice,
                const std::string& along, const std::string& up) {
  figure.panels.push_back(plot(title, along, up,
                               {{slice, "along", "up", CurveStyle::dots, "points, first frame"},
                                {table, "hip_along", "hip_up", CurveStyle::dashed, "HIP"},
                                {table, "proxy_along", "proxy_up", CurveStyle::line, "proxy"}},
                               {.equal_aspect = true}));
  figure.panels.push_back(
      plot("Force", along, "force (N)", {{table, "hip_along", "force", CurveStyle::line, ""}}));
}

// The HIP scans over a cloud at rest.
void add_scan(Figure& figure, FigureContext& context, int column, const char* name, const std::string& table,
              const std::string& title) {
  const Experiment experiment = Experiment::load(name);
  const Trace trace = context.run(experiment);
  const PointCloud cloud = experiment.build_scenario(kernels_for(Isa::x86_64))->cloud(0);
  const Vec3 middle = trace.hip_position_m[trace.length() / 2];
  const double slope = middle.y() / middle.z();  // slope of the plane through camera and scanned row
  figure.tables.push_back(path_table(table, trace, 0, 2));
  figure.tables.push_back(slice_table(
      table + "_slice", cloud, 0, 2, [&](const Vec3& p) { return std::abs(p.y() - slope * p.z()) < 0.001; }));
  add_panels(figure, title, table, table + "_slice", "x (m)", "z (m)");
  figure.panels.push_back(plot("Proxy to measured surface", "x (m)", "distance (m)",
                               {{table, "hip_along", "signed_distance", CurveStyle::line, ""}},
                               {.y_range = {{-0.002, 0.03}}}));
  const std::size_t first = figure.panels.size() - 3;
  for (std::size_t i = first; i < figure.panels.size(); ++i) {
    figure.panels[i].x_range = around(trace, 0);
    figure.panels[i].grid_position = {i - first, column};
  }
  figure.panels[first].y_range = around(trace, 2);
  figure.panels[first].equal_aspect = false;  // three columns leave no room for it
  add_claims(figure, title, trace);
}

// The HIP presses at one pixel while the camera moves.
void add_moving(Figure& figure, FigureContext& context) {
  const Trace trace = context.run("fig4.16-moving");
  figure.tables.push_back(path_table("moving", trace, 0, 2));
  PanelColumn panels{figure, "moving", "time", "time (s)", 2};
  panels.add("organ model, moving camera", "z (m)",
             {{"hip_up", CurveStyle::dashed, "HIP"}, {"proxy_up", CurveStyle::line, "proxy"}});
  panels.add("Force", "force (N)", {{"force"}});
  panels.add("Proxy to measured surface", "distance (m)", {{"signed_distance"}});
  add_claims(figure, "organ model, moving camera", trace);
}

}  // namespace

Figure figure_4_16(FigureContext& context) {
  const Experiment experiment = Experiment::load("fig4.16");
  const Trace trace = context.run(experiment);
  const PointCloud cloud = experiment.build_scenario(kernels_for(Isa::x86_64))->cloud(0);
  Figure figure{
      "4.16", "Ramp and box, simulated depth camera",
      "A simulated depth camera (quantised, noisy, with holes at depth edges) looks at a ramp and a box "
      "on a table; the HIP moves along z, 10 mm below the true surface, and lifts off over the two steps. "
      "Top: paths of HIP and proxy. Bottom: force."};
  figure.tables = {path_table("path", trace, 2, 1),
                   slice_table("slice", cloud, 2, 1, [](const Vec3& p) { return std::abs(p.x()) < 0.0015; })};
  add_panels(figure, "Paths over the table", "path", "slice", "z (m)", "y (m)");
  figure.panels[0].x_range = figure.panels[1].x_range = around(trace, 2);
  add_claims(figure, "", trace);
  // The same run with a budget of two steps a tick: the share of the ticks in which two steps are enough.
  const Trace two = context.run(Experiment::load("fig4.16", {"renderer.steps_per_tick=2"}));
  Claims(figure).differs(
      "two proxy steps suffice to converge (4.8) in a part of the ticks only: fraction of ticks",
      1 - unconverged_fraction(two), 0.3, 0.5, "fraction", "typically in 1 - 2 (4.3.4)");
  return figure;
}

Figure figure_4_16_recorded(FigureContext& context) {
  Figure figure{"4.16-recorded", "Recorded depth images and clouds",
                "The experiment of Fig 4.16 on recordings; x to the right, z away from the camera. "
                "Scans: the HIP follows an image row, 10 mm behind the surface of the first frame, and "
                "lifts off over holes and depth edges. The truth is the measurement itself: a plane "
                "through the pixels around the proxy. The proxy also slides across the row, along y, so "
                "in this projection it can lie beside the row's points. Moving camera: the HIP stays 10 "
                "mm behind the newest frame's surface at one pixel, and lifts off while that pixel sees "
                "a hole or an edge."};
  add_scan(figure, context, 0, "fig4.16-recorded", "still", "box and organ model, camera at rest");
  add_scan(figure, context, 1, "fig4.16-boxes", "boxes", "two boxes on a table, one cloud held");
  add_moving(figure, context);
  return figure;
}

}  // namespace remote_touch
