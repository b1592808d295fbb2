// Fig 6.2: a recorded hand as a cloud with normals; and what the filter does to a depth edge.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/trace/interval_estimates.h"
#include "core/dissertation/depth/depth_pipeline.h"
#include "core/points/noise.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/figure_pictures.h"
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
  return table_over<NormalCount>(
      "counts", "normals of the whole frame", {counted},
      {{"points", "1", "measured points", &NormalCount::points},
       {"with_neighbours", "1", "measured points with 10 others within the window and the radius",
        &NormalCount::with_neighbours},
       {"wrong", "1", "of these, points without a unit normal towards the sensor", &NormalCount::wrong},
       {"without_normal", "1", "measured points without a normal", &NormalCount::without_normal}});
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

}  // namespace remote_touch
