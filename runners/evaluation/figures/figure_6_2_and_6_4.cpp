// Fig 6.2: a recorded hand as a cloud with normals; and what the filter does to a depth edge. Fig 6.4: tools
// of meshes slide over recorded objects.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "analysis/trace/force_measures.h"
#include "analysis/trace/measures.h"
#include "core/dissertation/depth/depth_pipeline.h"
#include "core/points/noise.h"
#include "runners/evaluation/figures/figure_pictures.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/experiment/settings/changed_settings.h"

namespace remote_touch {

namespace {

constexpr double kWide_m = 0.025, kNarrow_m = 0.010;  // sigma_f as 6.3 prints it, and a smaller one
constexpr double kWall_m = 0.8, kStep_m = 0.025, kNoise_m = 0.0015;
constexpr int kBorder_px = 12, kEdge_px = 12;  // pixels left out at the image's border and at the step
constexpr double kNormal_m = 0.012;            // length of a drawn normal
constexpr int kEnoughNeighbours = 10;          // more than a line through the window contains
constexpr double kHand_m = 0.62, kForearm_m = 0.66, kRight_m = 0.02;  // limits of the hand in the recording

struct NormalCount {
  double points = 0, with_neighbours = 0, wrong = 0, without_normal = 0;
};

// True if enough measured points lie around the pixel, within the window and the radius of the normals.
bool has_neighbours(const PointCloud& cloud, int u, int v, const DepthPipelineSettings& settings) {
  const CameraIntrinsics& camera = cloud.image->camera;
  const int half = settings.normal_window / 2;
  const auto at = [&](int x, int y) { return cloud.point(static_cast<std::size_t>(y * camera.width + x)); };
  int count = -1;  // the pixel itself is counted below
  for (int y = std::max(0, v - half); y <= std::min(camera.height - 1, v + half); ++y)
    for (int x = std::max(0, u - half); x <= std::min(camera.width - 1, u + half); ++x)
      count += (at(x, y) - at(u, v)).norm() < settings.normal_radius_m ? 1 : 0;
  return count >= kEnoughNeighbours;
}

NormalCount count_normals(const PointCloud& cloud) {
  const DepthPipelineSettings settings;
  NormalCount counted;
  const int width = cloud.image->camera.width;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.point(i).allFinite()) continue;
    ++counted.points;
    const Vec3 n = cloud.normal(i);
    if (!n.allFinite()) ++counted.without_normal;
    const int pixel = static_cast<int>(i);
    if (!has_neighbours(cloud, pixel % width, pixel / width, settings)) continue;
    ++counted.with_neighbours;
    const bool right = std::abs(n.norm() - 1) < 1e-5 && n.dot(cloud.point(i)) < 0;  // NaN counts as wrong
    if (!right) ++counted.wrong;
  }
  return counted;
}

// Returns the points of the hand and its forearm, without the person behind.
std::vector<std::size_t> hand_points(const PointCloud& cloud, double max_depth_m) {
  return chosen_points(cloud,
                       [&](std::size_t i) { return cloud.z[i] < max_depth_m && cloud.x[i] < kRight_m; });
}

Table normal_table(const PointCloud& cloud, const std::vector<std::size_t>& points) {
  TableRows rows;
  for (std::size_t k = 0; k < points.size(); k += 100) {
    const Vec3 p = cloud.point(points[k]), end = p + kNormal_m * cloud.normal(points[k]);
    if (end.allFinite()) rows.push_back({p.x(), p.y(), p.z(), end.x(), end.y(), end.z()});
  }
  return table_of("normals", "every 100th normal, 12 mm long",
                  {{"x", "m", "x of the point"},
                   {"y", "m", "y of the point"},
                   {"z", "m", "z of the point"},
                   {"x_end", "m", "x of the end of the normal"},
                   {"y_end", "m", "y of the end of the normal"},
                   {"z_end", "m", "z of the end of the normal"}},
                  rows);
}

// Two walls that face the camera; the one on the right is farther.
DepthImage step_scene(const CameraIntrinsics& camera) {
  DepthImage depth{camera.width, camera.height, {}};
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      depth.z_m.push_back(u < camera.width / 2 ? kWall_m : kWall_m + kStep_m);
  return depth;
}

DepthImage with_noise(DepthImage depth, const Kernels& kernels) {
  const std::size_t count = depth.z_m.size();
  std::vector<std::uint32_t> pixels(count);
  std::iota(pixels.begin(), pixels.end(), 0u);
  std::vector<double> normal(count), unused(count), unused_too(count);
  kernels.noise.normals(noise_stream({}, NoiseUse::depth, 0), pixels.data(), count, normal.data(),
                        unused.data(), unused_too.data());
  for (std::size_t i = 0; i < count; ++i) depth.z_m[i] += kNoise_m * normal[i];
  return depth;
}

struct StepMeasurement {
  double smear_m = 0, noise_gain = 0;
  std::vector<double> across_m;  // filtered depth of the middle row, without noise
};

StepMeasurement measure_step(double sigma_f_m, const Kernels& kernels) {
  const CameraIntrinsics camera{640, 480, 525, 525, 319.5, 239.5};
  const DepthImage truth = step_scene(camera);
  DepthPipelineSettings settings;
  settings.sigma_f_m = sigma_f_m;
  DepthPipeline pipeline(settings, kernels);
  const std::vector<double> clean = pipeline.process(truth, camera, RigidTransform::Identity()).z;
  const std::vector<double> noisy =
      pipeline.process(with_noise(truth, kernels), camera, RigidTransform::Identity()).z;
  StepMeasurement measured;
  double squares = 0, count = 0;
  for (int v = kBorder_px; v < camera.height - kBorder_px; ++v)
    for (int u = kBorder_px; u < camera.width - kBorder_px; ++u) {
      const auto i = static_cast<std::size_t>(v * camera.width + u);
      measured.smear_m = max_or_nan(measured.smear_m, std::abs(clean[i] - truth.z_m[i]));
      if (std::abs(u - camera.cx) < kEdge_px) continue;
      squares += (noisy[i] - truth.z_m[i]) * (noisy[i] - truth.z_m[i]), ++count;
    }
  measured.noise_gain = std::sqrt(squares / count) / kNoise_m;
  const auto row = clean.begin() + camera.height / 2 * camera.width;
  measured.across_m.assign(row, row + camera.width);
  return measured;
}

Table step_table(const StepMeasurement& wide, const StepMeasurement& narrow) {
  return table_of("step", "a step of 25 mm at 0.8 m, after the filter",
                  {{"sigma_f", "m", "standard deviation of the filter, (7.2)"},
                   {"smear", "m", "largest error at the step, without noise"},
                   {"noise_gain", "1", "noise left on the walls, share of 1.5 mm"}},
                  {{kWide_m, wide.smear_m, wide.noise_gain}, {kNarrow_m, narrow.smear_m, narrow.noise_gain}});
}

Table profile_table(const StepMeasurement& wide, const StepMeasurement& narrow) {
  TableRows rows;
  for (int u = 320 - kEdge_px; u < 320 + kEdge_px; ++u) {
    const auto i = static_cast<std::size_t>(u);
    rows.push_back({u - 319.5, u < 320 ? kWall_m : kWall_m + kStep_m, wide.across_m[i], narrow.across_m[i]});
  }
  return table_of("profile", "one row of pixels over the step, without noise",
                  {{"pixel", "px", "column of the pixel, from the step"},
                   {"truth", "m", "depth of the walls"},
                   {"wide", "m", "depth after the filter with sigma_f = 0.025 m"},
                   {"narrow", "m", "depth after the filter with sigma_f = 0.010 m"}},
                  rows);
}

Table count_table(const NormalCount& counted) {
  return table_of(
      "counts", "normals of the whole frame",
      {{"points", "1", "measured points"},
       {"with_neighbours", "1", "measured points with 10 others within the window and the radius"},
       {"wrong", "1", "of these, points without a unit normal towards the sensor"},
       {"without_normal", "1", "measured points without a normal"}},
      {{counted.points, counted.with_neighbours, counted.wrong, counted.without_normal}});
}

void add_panels(Figure& figure) {
  const Vec3 eye{0.24, -0.08, 0.16}, target{-0.052, 0.055, 0.615};
  ScenePart points{ScenePart::Kind::points, "raw", 0xB98B6B, 0.0017}, filtered = points;
  filtered.table = "hand";
  ScenePart normals{ScenePart::Kind::segments, "normals", 0x1F4E79};
  const Panel step = plot("A step of 25 mm seen by a camera", "pixel from the step", "depth (m)",
                          {{"profile", "pixel", "truth", CurveStyle::dashed, "walls"},
                           {"profile", "pixel", "wide", CurveStyle::line, "sigma_f = 0.025 m"},
                           {"profile", "pixel", "narrow", CurveStyle::line, "sigma_f = 0.010 m"}},
                          {{{1, 0}}});
  const Panel gain = plot("Noise left on the walls", "sigma_f (m)", "share of the noise",
                          {{"step", "sigma_f", "noise_gain", CurveStyle::bars, ""}}, {{{1, 1}}});
  const auto seen = [&](const std::vector<ScenePart>& parts) {
    return Scene{eye, target, -Vec3::UnitY(), 0.20, 1.05, parts};
  };
  figure.panels = {scene_panel("As measured", 0, 0, seen({points})),
                   scene_panel("Filtered, every 100th normal", 0, 1, seen({filtered, normals})), step, gain};
}

void add_claims(Figure& figure, const NormalCount& counted, const StepMeasurement& wide,
                const StepMeasurement& narrow) {
  const Claims claims(figure), checks(figure, "", &Claim::set_up);
  const auto second = [](const std::string& what) { return second_number("chapter_6", "/filter/" + what); };
  const auto as_second = [&](const std::string& claim, double measured, double expected, double slack,
                             const std::string& unit) {
    claims.between(claim + " (the same as in the second implementation)", measured, expected - slack,
                   expected + slack, unit);
  };
  const double smears_m = second("wide/smear_m"),
               gain = second("narrow/noise_gain") / second("wide/noise_gain");
  constexpr double kAgrees_m = 1e-6;
  // Pixels within a window share their noise, so the walls hold 300 000 / 81 independent values. The standard
  // error of an rms over them is 1.2 %; that of the ratio of two filters on the same noise is smaller.
  constexpr double kAgrees = 0.012;
  claims.differs("the filter with sigma_f = 0.025 m smears a step of 25 mm in depth: error at the step",
                 wide.smear_m, smears_m - kAgrees_m, smears_m + kAgrees_m, "m",
                 "discontinuities are preserved (6.2.1)");
  as_second("the filter with sigma_f = 0.010 m smears a step of 25 mm in depth: error at the step",
            narrow.smear_m, second("narrow/smear_m"), kAgrees_m, "m");
  as_second("the filter with sigma_f = 0.010 m leaves more noise on a wall than that with 0.025 m: ratio",
            narrow.noise_gain / wide.noise_gain, gain, kAgrees, "1");
  checks.at_most("every point with 10 neighbours has a unit normal towards the sensor: points without one",
                 counted.wrong, 0, "points", "0");
  checks.at_least("nearly all measured points have 10 neighbours: fraction that do",
                  counted.with_neighbours / counted.points, 0.99, "fraction");
}

}  // namespace

Figure figure_6_2(FigureContext& context) {
  const Experiment experiment = Experiment::load("fig6.2");
  context.uses(experiment);
  const Kernels& kernels = context.kernels();
  const PointCloud cloud = processed_cloud(experiment, kernels, 0);
  PointCloud raw = experiment.build_scenario(kernels)->cloud(0);
  raw.nx = cloud.nx, raw.ny = cloud.ny, raw.nz = cloud.nz;  // only to shade it in the picture
  const NormalCount counted = count_normals(cloud);
  const StepMeasurement wide = measure_step(kWide_m, kernels), narrow = measure_step(kNarrow_m, kernels);
  Figure figure{
      "6.2", "A recorded hand with normals",
      "Above: a hand held in front of a depth camera, as measured and after the filter; the person behind is "
      "left out. Every point has a normal, every 100th is drawn. Below: what the filter does to a step "
      "between two walls, and to the sensor's noise, with sigma_f = 25 mm as the dissertation prints it, "
      "and with 10 mm. At 0.8 m the first smears a step of its own height; the second does not, and "
      "removes as much noise."};
  figure.tables = {cloud_table("hand", "the hand, filtered", cloud, hand_points(cloud, kForearm_m)),
                   cloud_table("raw", "the hand, as measured", raw, hand_points(cloud, kForearm_m)),
                   normal_table(cloud, hand_points(cloud, kHand_m)),
                   step_table(wide, narrow),
                   profile_table(wide, narrow),
                   count_table(counted)};
  add_panels(figure);
  add_claims(figure, counted, wide, narrow);
  return figure;
}

// Fig 6.4: tools of meshes slide over recorded objects.

namespace {

constexpr double kSlides_s = 0.8, kLifts_s = 2.4;  // start of sliding and of lifting, in all three runs
constexpr double kFirst_s = 1.0, kSecond_s = 2.3;  // moments of the pictures
constexpr double kVoxel_m = 5e-4;
// A point in the shell is within 1.5 sqrt(3) voxels of the centre of a free voxel, which is outside the tool.
constexpr double kDeepestInShell_m = 2.5981 * kVoxel_m;

// A recording and its pictures: the part around the object, and the viewpoint. There are two runs, with the
// rule look-ahead, which is drawn, and with the rule as printed, whose name ends with _voxels.
struct DrawnMoment {
  const char *experiment, *table, *label;
  double left_m, right_m, top_m, bottom_m, max_depth_m;
  Vec3 eye, target;
  double width_m;
};

const DrawnMoment kDrawnMoments[] = {{"fig6.4", "bunny", "Bunny, printed cube", -0.25, 0.10, -0.20, 0.16,
                                      0.62, Vec3(0.36, -0.16, 0.22), Vec3(-0.03, 0.02, 0.42), 0.30},
                                     {"fig6.4-organ", "hand", "Hand, organ model", -0.02, 0.32, -0.22, 0.14,
                                      0.75, Vec3(-0.23, -0.17, 0.33), Vec3(0.12, -0.03, 0.58), 0.36},
                                     {"fig6.4-box", "drill", "Power drill, cereal box", -0.32, 0.14, -0.05,
                                      0.26, 0.80, Vec3(-0.36, -0.10, 0.24), Vec3(-0.01, 0.13, 0.52), 0.46}};

// Distance from the tool to the device in each tick.
Numbers lags_m(const Trace& t) {
  return norms_between(t.hip_position_m, t.proxy_position_m);
}

Table touch_table(const NamedRun& run) {
  const Trace& t = run.trace;
  return every(
      5, {run.name,
          run.label,
          {{"time", "s", "simulated time", t.time_s},
           {"frame", "1", "frame in use", doubles(t.frame_index)},
           {"lag", "m", "from the tool's centre of mass to the device", lags_m(t)},
           {"lag_rotation", "deg", "between their orientations",
            each_of(t.length(), [&](std::size_t i) { return lag_rad(t, i) / kRadiansPerDegree; })},
           {"points", "1", "points that touch the tool", doubles(t.contact_count)},
           {"active", "1", "constraints that hold it", doubles(t.active_constraints)},
           {"clusters", "1", "10 mm cells of the tool with points that touch", doubles(t.contact_clusters)},
           {"penetration", "m", "deepest point in the tool at the end of the tick", t.tool_penetration_m},
           {"detections", "1", "collision detections in the tick", doubles(t.detections)},
           {"exhausted", "1", "the tick ended before the tool was at rest", doubles(t.budget_exhausted)},
           {"force", "N", "magnitude of the force", norms(t.force_N)},
           {"torque", "N m", "magnitude of the torque", norms(t.torque_Nm)}}});
}

// Returns every second pixel, in a chequered pattern, of the part of the recording that is shown.
std::vector<std::size_t> seen_points(const PointCloud& cloud, const DrawnMoment& shown) {
  const auto width = static_cast<std::size_t>(cloud.image->camera.width);
  return chosen_points(cloud, [&](std::size_t i) {
    const Vec3 p = cloud.point(i);  // a point that is NaN fails the test below
    return (i / width + i % width) % 2 == 0 && p.x() > shown.left_m && p.x() < shown.right_m &&
           p.y() > shown.top_m && p.y() < shown.bottom_m && p.z() < shown.max_depth_m;
  });
}

void add_pictures(Figure& figure, const FigureContext& context, const NamedRun& run, const DrawnMoment& shown,
                  int row) {
  const PointCloud cloud = processed_cloud(run.experiment, context.kernels(), 0);
  const std::vector<std::size_t> ticks = {tick_of(run.trace, kFirst_s), tick_of(run.trace, kSecond_s)};
  figure.tables.push_back(cloud_table(run.name + "_cloud", "points of the first frame, every second pixel",
                                      cloud, seen_points(cloud, shown)));
  add_tool_tables(figure, run.name, tool_of(run.experiment)->mesh, run.trace, ticks);
  for (std::size_t instant = 0; instant < 2; ++instant)
    figure.panels.push_back(scene_panel(std::string(shown.label) + ", " +
                                            std::to_string(run.trace.time_s[ticks[instant]]).substr(0, 3) +
                                            " s",
                                        row, static_cast<int>(instant),
                                        {shown.eye, shown.target, -Vec3::UnitY(), shown.width_m, 0.8,
                                         tool_in_cloud(run.name, instant, 0.003)}));
  figure.panels.push_back(
      plot("", "time (s)", "force (N)",
           {{run.name, "time", "force", CurveStyle::line, "look-ahead"},
            {run.name + "_voxels", "time", "force", CurveStyle::dashed, "voxels, as printed"}},
           {{{row, 2}}, {{0, 3.2}}, {{0, 9}}}));
}

// Returns the share of the ticks while the tool slides in which it touches.
double touching_fraction(const Trace& t) {
  const std::size_t from = tick_of(t, kSlides_s), until = tick_of(t, kLifts_s);
  return mean_where(
      until, [&](std::size_t i) { return i >= from; }, [&](std::size_t i) { return t.contact_count[i] > 0; });
}

// Returns the largest penetration of the tool over the ticks without a new frame; NaN if one of them has no
// value or there are none.
double deepest_m(const Trace& trace) {
  return max_where(
      trace.length(), [&](std::size_t i) { return !trace.frame_update(i); },
      [&](std::size_t i) { return trace.tool_penetration_m[i]; });
}

// Counts the ticks whose log contradicts itself. No tick may make more detections than the budget, and a tick
// must report a used-up budget exactly if it is not at rest. It must then have made all its detections.
double inconsistent_ticks(const NamedRun& run) {
  const int budget = run.experiment.value_at_start("renderer.detections_per_tick");
  const Trace& t = run.trace;
  return count_where(t.length(), [&](std::size_t i) {
    const bool used_up = t.budget_exhausted[i] != 0;
    return t.detections[i] > budget || (used_up && t.detections[i] < budget) || used_up != !t.converged[i];
  });
}

void add_claims(Figure& figure, const NamedRun& run, const char* object, bool is_printed) {
  const Trace& t = run.trace;
  const Claims claims(figure, object + std::string(is_printed ? ", as printed: " : ": "));
  claim_finite(claims, t);
  claims.at_most(
      "points stay out of the tool: depth of the deepest one at the end of a tick without a new frame",
      deepest_m(t), is_printed ? kDeepestInShell_m : kVoxel_m, "m", "0");
  claims.at_most("the log of used-up budgets fits the detections: ticks in which it does not",
                 inconsistent_ticks(run), 0, "ticks");
  claims.at_least("the tool touches while it slides: fraction of that time", touching_fraction(t), 0.9,
                  "fraction");
  claims.at_least("the object holds the tool back: largest distance from tool to device", max_of(lags_m(t)),
                  0.005, "m");
  claims.at_most("no force remains when the tool was lifted: force at the end",
                 t.force_N[t.length() - 1].norm(), 0, "N", "0");
}

Table summary_table(const std::vector<NamedRun>& runs) {
  using R = const NamedRun&;
  return quantity_table<NamedRun>(
      "runs", "what happened in each run", list_of(runs, [](R run) { return run.name; }), runs,
      {{"ticks", "1", [](R r) { return r.trace.length(); }},
       {"most points that touch at once", "1", [](R r) { return most(r.trace.contact_count); }},
       {"most active constraints at once", "1", [](R r) { return most(r.trace.active_constraints); }},
       {"deepest point at the end of any tick", "m", [](R r) { return max_of(r.trace.tool_penetration_m); }},
       {"ticks that used up their detections", "1",
        [](R r) { return std::ranges::count(r.trace.budget_exhausted, 1); }},
       {"points of a frame without a normal, at most", "1",
        [](R r) { return most(r.trace.disabled_points); }},
       {"maximum force", "N", [](R r) { return max_force_N(r.trace); }},
       {"largest force jump at a frame", "N", [](R r) { return max_force_jump_N(r.trace); }}});
}

// Returns both runs of each recording in turn.
std::vector<NamedRun> touch_runs(FigureContext& context) {
  std::vector<NamedExperiment> experiments;
  for (const DrawnMoment& shown : kDrawnMoments)
    for (const std::string rule : {"look-ahead", "voxels"})
      experiments.push_back({std::string(shown.table) + (rule == "voxels" ? "_voxels" : ""),
                             std::string(shown.label) + ", contact rule " + rule,
                             shown.experiment,
                             {"renderer.contact_rule=" + rule}});
  return named_runs(context, experiments);
}

}  // namespace

Figure figure_6_4(FigureContext& context) {
  const std::vector<NamedRun> runs = touch_runs(context);
  Figure figure{
      "6.4", "Tools of meshes in recorded point clouds",
      "The tool as a filled solid, the device's pose transparent. A bunny on a printed cube and a hand on an "
      "organ model, five frames of a camera at rest played to and fro at 10 Hz; a power drill on a cereal "
      "box, one frame. Every frame is filtered and gets normals. The device comes from the camera's side, "
      "goes about 10 mm into the object, moves some tens of millimetres along it while it turns, and leaves. "
      "The points are shown from beside the camera, so what it did not see is empty. The pictures are of the "
      "rule look-ahead; the force of the printed rule is beside it."};
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const DrawnMoment& shown = kDrawnMoments[r / 2];
    const bool is_printed = r % 2 == 1;
    figure.tables.push_back(touch_table(runs[r]));
    if (!is_printed) add_pictures(figure, context, runs[r], shown, static_cast<int>(r / 2));
    add_claims(figure, runs[r], shown.label, is_printed);
  }
  figure.tables.push_back(summary_table(runs));
  return figure;
}

}  // namespace remote_touch
