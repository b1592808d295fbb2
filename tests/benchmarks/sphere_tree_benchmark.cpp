// Chapter 7: the regions of a frame as a tree, pairs of leaves, and whole ticks of a tool among regions.
// Every answer is compared with a plain loop over all pairs before anything is timed. Ticks are also
// compared, bit for bit, with those of the slowest instruction set level.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/tool_motion/look_ahead_motion.h"
#include "core/dissertation/tool_motion/sphere_tree_renderer.h"
#include "core/kernels/kernels.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/region_scene.h"
#include "tests/support/cloud_form.h"
#include "tests/support/leaf_pairs.h"

namespace remote_touch::benchmarks {
namespace {

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
