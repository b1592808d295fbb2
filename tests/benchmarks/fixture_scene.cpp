#include "tests/benchmarks/fixture_scene.h"

#include <algorithm>
#include <limits>
#include <random>
#include <utility>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "tests/support/scenes.h"

namespace remote_touch::benchmarks {
namespace {

constexpr std::size_t kSteps = 1024;
constexpr double kRadius_m = 0.02;
// The slide of the other benchmarks, on a nearer surface. It begins beside the plane x = 0, which separates
// the protected half from the other.
const Vec3 kAbove(-0.012, 0, 0.42), kStart(-0.012, 0, 0.525);

PointCloud with_columns(PointCloud cloud, double radius, double radius_right, bool stiff) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.fixture_radius_m.push_back(cloud.x[i] >= 0 ? radius_right : radius);
    if (stiff)
      cloud.stiffness_N_per_m.push_back(i % 3 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                                   : 200 + 100 * static_cast<double>(i % 7));
  }
  return cloud;
}

// Single steps in contact, as the renderer itself finds them.
FixtureSteps contact_steps(const FixtureScene& scene) {
  ProxyParameters one_step = kSettings;
  one_step.steps_per_tick = 1, one_step.max_exit_steps = 0;
  const double rate_hz = kTickRate_hz * kSettings.steps_per_tick;
  ProxyRenderer renderer(one_step, rate_hz, scenes::kernels());
  renderer.on_frame({0, 0, 0, scene.search});
  renderer.step({kAbove}, 0);
  FixtureSteps steps{"contact", ContactState::contact};
  for (int i = 0; steps.proxies.size() < kSteps; ++i) {
    const double time_s = std::max(0, i - 1000) / rate_hz;  // the first steps go down to the surface
    const RenderOutput out = renderer.step({fixture_hip_at(time_s)}, i / rate_hz);
    if (i < 1000 || out.state != ContactState::contact) continue;
    steps.proxies.push_back(out.proxy_W);
    steps.hips.push_back(fixture_hip_at(time_s + 1 / rate_hz));
  }
  return steps;
}

// The same steps begin at a height along the normal. If displacement_m > 0, the HIP is that far below the
// proxy.
FixtureSteps lifted(const FixtureScene& scene, const FixtureSteps& contact, FixtureSteps out, double height_m,
                    double displacement_m) {
  Neighbourhood near(kSettings.r3_m, scenes::kernels());
  near.set_points(scene.search);
  for (std::size_t i = 0; i < contact.proxies.size(); ++i) {
    const Vec3& p_W = contact.proxies[i];
    const PointsView points = near.around(p_W).view();
    const ContactQuery query = scenes::kernels().proxy.contact_query(
        points, p_W.data(), {kSettings.r1_m, kSettings.r2_m, kSettings.r3_m, near.sum_grid(), 0});
    const Vec3 normal = Vec3(query.normal_sum[0], query.normal_sum[1], query.normal_sum[2]).normalized();
    out.proxies.push_back(p_W + height_m * normal);
    out.hips.push_back(displacement_m > 0 ? Vec3(out.proxies.back() - displacement_m * normal)
                                          : contact.hips[i]);
  }
  return out;
}

// Returns balls in front of random points of the middle of the image, towards the camera.
std::vector<Ball> jumps_on(const PointCloud& cloud) {
  // A new list reaches 0.8661 of its cubes' edge beyond r3, as Neighbourhood gathers it.
  const double list_radius_m = kSettings.r3_m * (1 + 0.8661 * 0.125);
  const int width = cloud.image->camera.width, height = cloud.image->camera.height;
  std::mt19937 random(1);
  std::vector<Ball> jumps;
  while (jumps.size() < kSteps) {
    const std::size_t u = width / 6 + random() % (width * 2 / 3),
                      v = height / 6 + random() % (height * 2 / 3);
    const std::size_t i = v * width + u;
    const double radius = cloud.fixture_radius_m.empty() ? 0 : cloud.fixture_radius_m[i];
    jumps.push_back({cloud.point(i) - Vec3(0, 0, radius + kSettings.contact_radius_m()), list_radius_m});
  }
  return jumps;
}

FixtureScene made_scene(std::string name, PointCloud cloud) {
  FixtureScene scene{{std::move(name), std::move(cloud)}};
  scene.search = make_search(scene.cloud);
  const FixtureSteps contact = contact_steps(scene);
  scene.steps = {contact, lifted(scene, contact, {"free", ContactState::free}, 0.0005, 0.002),
                 lifted(scene, contact, {"free_far", ContactState::free}, 0.0005, 0),
                 lifted(scene, contact, {"entrenched", ContactState::entrenched}, -0.0002, 0)};
  scene.balls = jumps_on(scene.cloud);
  for (std::size_t i = 0; i < scene.balls.size(); i += kFixtureCheckEvery)
    scene.expected.push_back(naive::points_within(scene.cloud, scene.balls[i]));
  // Regions farther away are not reached. The reference then takes a tenth of the time.
  std::vector<naive::RegionPoint> points;
  for (const naive::RegionPoint& point : naive::region_points_of(scene.cloud, kSettings))
    if ((point.x - kStart).norm() < 0.12) points.push_back(point);
  for (FixtureSteps& steps : scene.steps)
    for (std::size_t i = 0; i < steps.proxies.size(); i += kFixtureCheckEvery)
      steps.expected.push_back(
          naive::region_step(points, steps.proxies[i], steps.hips[i], Vec3::Zero(), kSettings));
  naive::RegionProxy proxy{kAbove, Vec3::Zero(), kAbove};
  for (std::size_t i = 0; i < kFixtureCheckedTicks; ++i) {
    if (i > 0) naive::region_tick(points, fixture_hip_at(i / kTickRate_hz), kSettings, proxy);
    scene.expected_ticks.push_back(proxy.proxy_W);
  }
  return scene;
}

}  // namespace

Vec3 fixture_hip_at(double time_s) {
  return kStart + 0.1 * time_s * Vec3(1, 0.3, 0).normalized();
}

Vec3 fixture_hip_above() {
  return kAbove;
}

std::vector<FixtureScene> fixture_scenes() {
  const PointCloud plain = naive::wave_image(0.5);
  std::vector<FixtureScene> scenes;
  scenes.push_back(made_scene("none", plain));
  scenes.push_back(made_scene("zero", with_columns(plain, 0, 0, false)));
  scenes.push_back(made_scene("all", with_columns(plain, kRadius_m, kRadius_m, false)));
  scenes.push_back(made_scene("half", with_columns(plain, 0, kRadius_m, false)));
  scenes.push_back(made_scene("stiff", with_columns(plain, kRadius_m, kRadius_m, true)));
  return scenes;
}

}  // namespace remote_touch::benchmarks
