// Chapter 7: the regions of a frame as a tree, pairs of leaves, and whole ticks of a tool among regions.
// Every answer is compared with a plain loop over all pairs before anything is timed. Ticks are also
// compared, bit for bit, with those of the slowest instruction set level.
#include <benchmark/benchmark.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/tool_motion/look_ahead_motion.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/sphere_tree.h"
#include "core/dissertation/tool_motion/sphere_tree_renderer.h"
#include "core/kernels/kernels.h"
#include "core/mesh/voxel_tool.h"
#include "core/points/point_cloud.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/tool_scene.h"
#include "tests/support/cloud_form.h"
#include "tests/support/leaf_pairs.h"

namespace remote_touch::benchmarks {
namespace {

// --- two handwheels among forbidden regions as a camera sees them, 7.5.1, and tools of spheres that meet
// them. The camera is at the origin and faces along z. ---

constexpr double kRegion_m = 0.04;
constexpr double kWheelAway_m = 0.9, kWheelAside_m = 0.09, kRing_m = 0.045;
constexpr int kRoundTicks = 2828;
constexpr double kTube_m = 0.007, kSpoke_m = 0.006;
constexpr double kHub_m = 0.013, kHubHalfLength_m = 0.004;
constexpr int kWidth = 640, kHeight = 480;
constexpr double kFocal_px = 525;

double away_from_capsule(const Vec3& p, const Vec3& from, const Vec3& to, double radius_m) {
  const Vec3 along = to - from;
  const double fraction = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - from - fraction * along).norm() - radius_m;
}

// Returns the signed distance of a position, in the wheel's frame, to the wheel: a ring, three spokes and a
// hub along its axis.
double away_from_wheel(const Vec3& p) {
  double away = std::hypot(std::hypot(p.x(), p.y()) - kRing_m, p.z()) - kTube_m;
  for (const double turn : {0.25, 0.25 + 1.0 / 3, 0.25 + 2.0 / 3}) {
    const double a = 2 * std::numbers::pi * turn;
    const Vec3 rim(kRing_m * std::cos(a), kRing_m * std::sin(a), 0);
    away = std::min(away, away_from_capsule(p, Vec3::Zero(), rim, kSpoke_m));
  }
  const Vec3 hub(0, 0, kHubHalfLength_m);
  return std::min(away, away_from_capsule(p, -hub, hub, kHub_m));
}

// Returns z of the point where a ray of the camera meets one of the wheels, or 2 m, beyond the wall, if it
// meets none. Each step is as long as the distance to the wheel, so no step passes through it.
double depth_of_wheels(const Vec3& ray, double nearer_m) {
  double depth = 2;
  for (const double side : {-1.0, 1.0}) {
    const Vec3 middle(side * kWheelAside_m, 0, kWheelAway_m - nearer_m);
    double z = middle.z() - 0.1;
    while (z < middle.z() + 0.1) {
      const double away = away_from_wheel(z * ray - middle);
      if (away < 1e-6) depth = std::min(depth, z);
      if (away < 1e-6) break;
      z += away / ray.norm();
    }
  }
  return depth;
}

double reach_of(const SphereTree& tree) {
  double reach_m = 0;
  for (const Sphere& leaf : tree.leaves()) reach_m = std::max(reach_m, leaf.centre.norm() + leaf.radius_m);
  return reach_m;
}

// The image has 640 x 480 pixels, with the wheels nearer_m nearer than usual. A wall without regions is
// behind them.
PointCloud frame_of_wheels(double nearer_m = 0) {
  constexpr double kWall_m = 1.2;
  PointCloud cloud;
  cloud.image.emplace();
  cloud.image->camera = {kWidth, kHeight, kFocal_px, kFocal_px, 0.5 * (kWidth - 1), 0.5 * (kHeight - 1)};
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const Vec3 ray((u - 0.5 * (kWidth - 1)) / kFocal_px, (v - 0.5 * (kHeight - 1)) / kFocal_px, 1);
      const double depth = depth_of_wheels(ray, nearer_m);
      cloud.append(std::min(depth, kWall_m) * ray);
      cloud.fixture_radius_m.push_back(depth < kWall_m ? kRegion_m : 0);
    }
  return cloud;
}

struct SphereTool {
  std::shared_ptr<const VoxelTool> body;
  std::shared_ptr<const SphereTree> leaves;
  double reach_m;
};

SphereTool generated_sphere_tool(const std::string& name, int max_leaves) {
  const auto body = generated_tool(name);
  const auto leaves = std::make_shared<const SphereTree>(make_tool_spheres(*body, max_leaves).spheres);
  return {body, leaves, reach_of(*leaves)};
}

// Pose of the device on its way around the first wheel at 0.1 m/s. It turns on the way, 10 mm inside the
// regions.
ToolPose device_around_wheel(int tick) {
  const double a = 2 * std::numbers::pi * tick / kRoundTicks;
  const double pressed_m = 0.01;
  return {{-kWheelAside_m + kRing_m * std::cos(a), kRing_m * std::sin(a),
           kWheelAway_m - kTube_m - kRegion_m + pressed_m},
          rotation({0.3 * std::sin(3 * a), 0.2 * std::cos(2 * a), 0.5 * std::sin(a)})};
}

const double kLookAhead_m = ToolParameters{}.look_ahead_m;
constexpr double kSettled_m = 1e-4;
constexpr double kAtRest_m = 1e-5;  // both are the defaults of the renderer sphere-tree
constexpr int kDetections = 30;
constexpr int kLeaves = 112;

struct NamedPose {
  std::string name;
  ToolPose pose;
};

// The poses are out of reach of all regions, at their surface, and with the tool's middle in the tube of the
// wheel.
std::vector<NamedPose> named_poses() {
  ToolPose clear = device_around_wheel(0), touching = clear, deep = clear;
  clear.p_W.z() -= 0.3, touching.p_W.z() -= 0.0225, deep.p_W.z() += 0.03;
  return {{"clear", clear}, {"touching", touching}, {"deep", deep}};
}

double deepest_m(const std::vector<LeafPair>& pairs) {
  double deepest = -std::numeric_limits<double>::infinity();
  for (const LeafPair& pair : pairs) deepest = std::max(deepest, -pair.gap_m);
  return deepest;
}

// --- the tree of a frame ---

bool tree_right(const PointCloud& cloud) {
  RegionTree tree;
  tree.assign(cloud);
  std::vector<std::uint32_t> points = tree.points(), expected;
  std::sort(points.begin(), points.end());
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (cloud.fixture_radius_m[i] > 0) expected.push_back(i);
  bool right = points == expected && !points.empty();
  const SphereTree& spheres = tree.spheres();
  for (const SphereNode& node : spheres.level(0))
    for (const Sphere& leaf : spheres.leaves().subspan(node.first, node.count))
      right = right && (leaf.centre - node.sphere.centre).norm() + leaf.radius_m <= node.sphere.radius_m;
  return right;
}

void add_tree(const PointCloud& cloud) {
  add(
      "region_tree/wheels", [&cloud] { return tree_right(cloud); },
      [&cloud](benchmark::State& state) {
        RegionTree tree;
        for (auto _ : state) {
          tree.assign(cloud);
          benchmark::ClobberMemory();
        }
      });
}

// --- one detection ---

bool detection_right(const SphereTool& tool, const PointCloud& cloud, const ToolPose& pose,
                     const Kernels& kernels) {
  RegionContacts contacts(tool.leaves, kLookAhead_m, kernels);
  contacts.on_frame(in_form<RegionTree>(cloud));
  const SphereTree& regions = contacts.regions().spheres();
  const std::vector<LeafPair> expected = naive_pairs(*tool.leaves, pose, regions, kLookAhead_m);
  TreeCollision collision(*tool.leaves, kernels);
  collision.on_frame(regions);
  return near_pairs(collision, pose, kLookAhead_m) == expected &&
         contacts.near(pose, 0).deepest_m == deepest_m(expected);
}

void add_detection(const SphereTool& tool, const PointCloud& cloud, const NamedPose& named) {
  const ToolPose pose = named.pose;
  for (const Kernels* kernels : supported_kernels())
    add(
        "region_contacts/" + named.name + "/" + kernels->isa,
        [=, &tool, &cloud] { return detection_right(tool, cloud, pose, *kernels); },
        [=, &tool, &cloud](benchmark::State& state) {
          RegionContacts contacts(tool.leaves, kLookAhead_m, *kernels);
          contacts.on_frame(in_form<RegionTree>(cloud));
          for (auto _ : state) benchmark::DoNotOptimize(contacts.near(pose, 0).contacts.size());
        });
  add("region_contacts_naive/" + named.name, [=, &tool, &cloud](benchmark::State& state) {
    RegionTree regions;
    regions.assign(cloud);
    for (auto _ : state) {
      const std::vector<LeafPair> pairs = naive_pairs(*tool.leaves, pose, regions.spheres(), kLookAhead_m);
      benchmark::DoNotOptimize(pairs.data());
    }
  });
}

// --- whole ticks ---

// The inputs of a ride: the pose of the device in each tick, and the frame that arrives in it, if any.
struct Course {
  int ticks;
  ToolPose (*device)(int tick);
  const PointCloud* (*frame)(int tick);
};

const PointCloud& wheels() {
  static const PointCloud cloud = frame_of_wheels();
  return cloud;
}
// Frames whose wheels are 30 mm nearer swallow the tool. The motion pushes it out, and the next frame lets it
// down again.
const PointCloud& nearer_wheels() {
  static const PointCloud cloud = frame_of_wheels(0.03);
  return cloud;
}

constexpr int kFrameTicks = 33;
const Course kSlide{kRoundTicks, device_around_wheel, [](int) -> const PointCloud* { return nullptr; }};
const Course kSwallow{20 * kFrameTicks, [](int tick) { return device_around_wheel(4 * tick); },
                      [](int tick) -> const PointCloud* {
                        if (tick % kFrameTicks != 0) return nullptr;
                        return tick / kFrameTicks % 2 == 0 ? &wheels() : &nearer_wheels();
                      }};

class Ride {
 public:
  Ride(const SphereTool& tool, const Course& course, const Kernels& kernels)
      : tool_(tool),
        course_(course),
        contacts_(tool.leaves, kLookAhead_m, kernels),
        motion_({.detections_per_tick = kDetections, .rest_threshold_m = kAtRest_m}, *tool.body,
                tool.reach_m) {
    contacts_.on_frame(in_form<RegionTree>(wheels()));
    pose_ = course.device(0);
    pose_.p_W.z() -= 0.3;
    for (int i = 0; i < 20; ++i) step(course.device(0));
  }
  // The time of a tick does not include the frame.
  void begin(int tick) {
    const PointCloud* frame = course_.frame(tick);
    if (frame) contacts_.on_frame(in_form<RegionTree>(*frame));
    updated_ = frame != nullptr;
  }
  ToolMotionReport step(int tick) { return step(course_.device(tick)); }

  const ToolPose& pose() const { return pose_; }
  double deepest_of_all_m() const {
    return deepest_m(naive_pairs(*tool_.leaves, pose_, contacts_.regions().spheres(), kLookAhead_m));
  }

 private:
  ToolMotionReport step(const ToolPose& device) {
    return motion_.move(pose_, device, contacts_, std::exchange(updated_, false));
  }

  const SphereTool tool_;
  const Course& course_;
  RegionContacts contacts_;
  LookAheadMotion motion_;
  ToolPose pose_;
  bool updated_ = false;
};

// Some ticks are also compared with all pairs: no leaf rests in a region.
bool ride_right(const SphereTool& tool, const Course& course, const Kernels& kernels) {
  constexpr int kCheckedTick = 61;
  Ride ride(tool, course, kernels), slowest(tool, course, kernels_for(Isa::x86_64));
  int touching = 0;
  for (int tick = 0; tick < course.ticks; ++tick) {
    ride.begin(tick), slowest.begin(tick);
    const ToolMotionReport report = ride.step(tick);
    slowest.step(tick);
    if (!(ride.pose() == slowest.pose())) return false;
    if (tick % kCheckedTick != 0 || !report.at_rest) continue;
    const double deep_m = ride.deepest_of_all_m();
    if (deep_m > kSettled_m) return false;
    touching += deep_m > -kSettled_m ? 1 : 0;
  }
  return touching > 0;
}

void time_ride(benchmark::State& state, const SphereTool& tool, const Course& course,
               const Kernels& kernels) {
  LeastTimes least(course.ticks);
  for (auto _ : state) {
    state.PauseTiming();
    Ride ride(tool, course, kernels);
    state.ResumeTiming();
    for (int tick = 0; tick < course.ticks; ++tick) {
      ride.begin(tick);
      least.time(tick, [&] { return ride.step(tick); });
    }
  }
  least.count_slowest(state);
}

void add_ride(const SphereTool& tool, const std::string& name, const Course& course) {
  for (const Kernels* kernels : supported_kernels())
    add(
        "region_tick/" + name + "/" + kernels->isa,
        [=, &tool, &course] { return ride_right(tool, course, *kernels); },
        [=, &tool, &course](benchmark::State& state) { time_ride(state, tool, course, *kernels); });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch::benchmarks;
  const SphereTool key = generated_sphere_tool("key", kLeaves),
                   husky = generated_sphere_tool("husky", kLeaves);
  add_tree(wheels());
  for (const NamedPose& named : named_poses()) add_detection(key, wheels(), named);
  add_ride(key, "key_slide", kSlide);
  add_ride(key, "key_swallowed", kSwallow);
  add_ride(husky, "husky_slide", kSlide);
  add_ride(husky, "husky_swallowed", kSwallow);
  return run_benchmarks(argc, argv);
}
