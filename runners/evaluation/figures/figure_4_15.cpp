// Fig 4.15 b: the points that the depth camera of 4.16 measures. The photo of 4.15 a has no counterpart.
#include <cmath>

#include "runners/evaluation/figures/figures.h"
#include "runners/evaluation/figures/tools/figure_form.h"
#include "runners/evaluation/figures/tools/tool_picture.h"
#include "scenarios/camera/camera_scene.h"

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

}  // namespace remote_touch
