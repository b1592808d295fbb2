#include "runners/presentation/result_pages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "runners/experiment/catalog/frame_stream.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

class FrameObserver final : public FrameReceiver {
 public:
  explicit FrameObserver(const std::function<void(const Frame&)>& on_frame) : on_frame_(on_frame) {}
  void on_frame(const Frame& frame) override { on_frame_(frame); }

 private:
  const std::function<void(const Frame&)>& on_frame_;
};

// Returns a rank from 1 to 2^32 - 1. The ranks of successive numbers are spread evenly (multiplicative
// hashing, Knuth 6.4).
std::uint32_t rank_of(std::uint32_t number) {
  number *= 2654435769u;
  number ^= number >> 16;
  number *= 2246822519u;
  return std::max(number ^ number >> 13, 1u);
}

// Returns the path without positions that are within side_m of the last one that was kept. The proxy moves
// little from one tick to the next, so most positions need not be compared with the points.
std::vector<Vec3> thinned_path(std::span<const Vec3> path_W, double side_m) {
  std::vector<Vec3> kept;
  for (const Vec3& p : path_W)
    if (p.allFinite() && (kept.empty() || (p - kept.back()).norm() > side_m)) kept.push_back(p);
  return kept;
}

bool is_known(const ToolPose& pose) {
  return pose.p_W.allFinite() && pose.q_WT.coeffs().allFinite();
}

double distance_m(const VoxelTool& tool, const ToolPose& pose, const Vec3& p_W) {
  return sample_field(tool, pose.q_WT.conjugate() * (p_W - pose.p_W)).distance_m;
}

// Returns the points that can touch in any of the poses. The distance of a point changes by no more than the
// tool moves. Returns none if no pose is finite.
std::vector<std::uint32_t> candidates(const VoxelTool& tool, std::span<const ToolPose> poses,
                                      const PointCloud& cloud) {
  // The pose from which the tool moves least: near the middle.
  auto middle =
      std::find_if(poses.begin() + static_cast<std::ptrdiff_t>(poses.size() / 2), poses.end(), is_known);
  if (middle == poses.end()) middle = std::find_if(poses.begin(), poses.end(), is_known);
  std::vector<std::uint32_t> found;
  if (middle == poses.end()) return found;
  double motion_m = 0;
  for (const ToolPose& pose : poses)
    if (is_known(pose))
      motion_m = std::max(motion_m, max_point_displacement_m(displacement(*middle, pose), tool.reach_m));
  // Outside the distance field the distance is known only to within a voxel.
  const double max_m = motion_m + kTouchingTool_m + tool.grid.size_m, far_m = tool.reach_m + max_m;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const Vec3 p = cloud.point(i);
    if ((p - middle->p_W).squaredNorm() > far_m * far_m) continue;
    if (distance_m(tool, *middle, p) <= max_m) found.push_back(static_cast<std::uint32_t>(i));
  }
  return found;
}

constexpr double kMaxNumber = 65535;
constexpr double kOutside_m = 0.15;  // points that touch may be this far outside the box, by their regions

std::vector<std::uint16_t> numbers_of(const PointCloud& cloud, const std::vector<std::uint32_t>& points,
                                      const PointScale& scale) {
  std::vector<std::uint16_t> numbers;
  numbers.reserve(3 * points.size());
  for (const std::uint32_t i : points) {
    const Vec3 number = (cloud.point(i) - scale.low_W) / scale.step_m;
    for (int axis = 0; axis < 3; ++axis)
      numbers.push_back(static_cast<std::uint16_t>(std::lround(std::clamp(number[axis], 0.0, kMaxNumber))));
  }
  return numbers;
}

std::vector<std::uint8_t> colours_of(const PointCloud& cloud, const std::vector<std::uint32_t>& points) {
  std::vector<std::uint8_t> colours;
  if (cloud.colour.empty()) return colours;
  colours.reserve(3 * points.size());
  for (const std::uint32_t i : points)
    for (const int shift : {16, 8, 0})
      colours.push_back(static_cast<std::uint8_t>(shown_colour(cloud.colour[i]) >> shift));
  return colours;
}

bool lacks_colours(const PointCloud& cloud, const std::vector<std::uint32_t>& points) {
  return !cloud.colour.empty() && std::any_of(points.begin(), points.end(),
                                              [&](std::uint32_t i) { return cloud.colour[i] == kNoColour; });
}

std::vector<float> radii_of(const PointCloud& cloud, const std::vector<std::uint32_t>& points) {
  std::vector<float> radii;
  if (cloud.fixture_radius_m.empty()) return radii;
  for (const std::uint32_t i : points) radii.push_back(static_cast<float>(cloud.fixture_radius_m[i]));
  return std::any_of(radii.begin(), radii.end(), [](float radius) { return radius > 0; })
             ? radii
             : std::vector<float>{};
}

std::vector<std::uint32_t> all_of(const TouchingPoints& lists) {
  std::vector<std::uint32_t> all;
  for (const auto& list : lists) all.insert(all.end(), list.begin(), list.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

TouchingPoints touching_in(const PointCloud& cloud, const RunPath& path, std::size_t begin, std::size_t end) {
  if (!path.tool)
    return touching_proxy(std::span(path.proxy_W).subspan(begin, end - begin), path.touch_radius_m, cloud);
  std::vector<ToolPose> poses;
  for (std::size_t tick = begin; tick < end; ++tick)
    poses.push_back({path.proxy_W[tick], path.tool_orientation_W[tick]});
  return touching_tool(*path.tool, poses, cloud);
}

// Returns the part of a frame that is shown. begin, end: the ticks that used it.
ShownFrame shown_frame(const Frame& frame, const PointCloud& cloud, const RunPath& path, std::size_t begin,
                       std::size_t end, const ShownPointsRule& rule) {
  const TouchingPoints touching = touching_in(cloud, path, begin, end);
  ShownPoints points =
      shown_points(cloud, all_of(touching), std::span(path.proxy_W).subspan(begin, end - begin), rule);
  ShownFrame now;
  now.index = frame.index, now.captured_s = frame.captured_s;
  now.measured = points.measured, now.in_box = points.in_box, now.others = points.others;
  now.rank = std::move(points.rank);
  now.positions = numbers_of(cloud, points.indices, point_scale(rule.box_W));
  now.colours = colours_of(cloud, points.indices);
  now.lacks_colours = lacks_colours(cloud, points.indices);
  now.fixture_radius_m = radii_of(cloud, points.indices);
  for (const auto& of_tick : touching) {
    for (const std::uint32_t i : of_tick)
      now.touching.push_back(static_cast<std::uint32_t>(
          std::lower_bound(points.indices.begin(), points.indices.end(), i) - points.indices.begin()));
    now.touching_end.push_back(static_cast<std::uint32_t>(now.touching.size()));
  }
  return now;
}

}  // namespace

bool is_of_live_run(const TextAttributes& trace) {
  return !recipe_of(trace) && attribute(trace, "command").find(" live ") != std::string::npos;
}

Experiment experiment_of_run(const TextAttributes& trace, const std::string& name) {
  if (is_of_live_run(trace))
    throw InputError(
        name,
        "is of a live run, without its frames: expected the trace that `remote-touch run` makes from its recording");
  Experiment experiment = read_configuration(
      trace, name, [&] { return Experiment::from_json(parse_json(attribute(trace, "config"), name)); });
  for (const ChangedInput& input :
       changed_inputs(attribute(trace, "input_digests"), input_hashes(experiment.inputs())))
    throw InputError(name, "its recording " + input.path + " has changed: expected " + input.before +
                               ", found " + input.now);
  return experiment;
}

void replay_frames(const Experiment& experiment, std::span<const double> time_s, const Kernels& kernels,
                   const std::atomic<bool>* stop, const std::function<void(const Frame&)>& on_frame) {
  // A task switches fixtures on and off, at times that are known only from the run itself.
  if (!experiment.sequence().empty()) {
    SimulationOptions options;
    options.kernels = &kernels;
    options.stop = stop;
    options.on_frame = on_frame;
    simulate(experiment, options);
    return;
  }
  FrameObserver observer(on_frame);
  const auto scenario = experiment.build_scenario(kernels);
  FrameProcessing processing = experiment.build_processing(kernels);
  processing.needs = {};  // so that a run of an earlier version, which refused nothing, can be shown too
  FrameStream stream(*scenario, std::move(processing), experiment.settings().transport,
                     experiment.settings().key, false);
  for (const double now_s : time_s) {
    if (stop && *stop) throw Interrupted{};
    stream.deliver_until(now_s, observer);
  }
}

std::uint32_t rank_limit(std::size_t others, std::size_t wanted_others) {
  constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();
  if (others <= wanted_others) return kAll;
  return static_cast<std::uint32_t>(static_cast<double>(wanted_others) / static_cast<double>(others) * kAll);
}

ShownPoints shown_points(const PointCloud& cloud, std::span<const std::uint32_t> always,
                         std::span<const Vec3> proxies_W, const ShownPointsRule& rule) {
  ShownPoints shown;
  const double step_m = 0.1 * rule.near_m;
  const std::vector<Vec3> path = thinned_path(proxies_W, step_m);
  const double squared = (rule.near_m + step_m) * (rule.near_m + step_m);
  std::vector<std::uint32_t> others;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    ++shown.measured;
    const Vec3 p = cloud.point(i);
    const bool in_box = rule.box_W.contains(p);
    shown.in_box += in_box ? 1 : 0;
    if (std::binary_search(always.begin(), always.end(), i)) {
      shown.indices.push_back(static_cast<std::uint32_t>(i));
      continue;
    }
    if (!in_box) continue;
    const bool is_near = rule.near_m > 0 && std::any_of(path.begin(), path.end(), [&](const Vec3& proxy) {
                           return (p - proxy).squaredNorm() <= squared;
                         });
    (is_near ? shown.indices : others).push_back(static_cast<std::uint32_t>(i));
  }
  shown.others = others.size();
  const std::uint32_t limit = rank_limit(others.size(), rule.wanted_others);
  const std::vector<std::uint32_t> near = shown.indices;
  for (const std::uint32_t i : others)
    if (rank_of(i) < limit) shown.indices.push_back(i);
  std::sort(shown.indices.begin(), shown.indices.end());
  for (const std::uint32_t i : shown.indices)
    shown.rank.push_back(std::binary_search(near.begin(), near.end(), i) ? 0 : rank_of(i));
  return shown;
}

TouchingPoints touching_proxy(std::span<const Vec3> centres_W, double radius_m, const PointCloud& cloud) {
  BoundingBox box;
  for (const Vec3& centre : centres_W)
    if (centre.allFinite()) box.extend(centre);
  const auto region_m = [&](std::size_t i) {
    return cloud.fixture_radius_m.empty() ? 0 : cloud.fixture_radius_m[i];
  };
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < cloud.size() && !box.isEmpty(); ++i)
    if (cloud.is_measured(i) && box.exteriorDistance(cloud.point(i)) <= radius_m + region_m(i) + 1e-9)
      near.push_back(static_cast<std::uint32_t>(i));
  TouchingPoints touching;
  for (const Vec3& centre : centres_W) {
    std::vector<std::uint32_t>& now = touching.emplace_back();
    for (const std::uint32_t i : near)
      if ((centre - cloud.point(i)).norm() - region_m(i) <= radius_m) now.push_back(i);
  }
  return touching;
}

TouchingPoints touching_tool(const VoxelTool& tool, std::span<const ToolPose> poses,
                             const PointCloud& cloud) {
  const std::vector<std::uint32_t> near = candidates(tool, poses, cloud);
  TouchingPoints touching;
  for (const ToolPose& pose : poses) {
    std::vector<std::uint32_t>& now = touching.emplace_back();
    if (is_known(pose))
      for (const std::uint32_t i : near)
        if (distance_m(tool, pose, cloud.point(i)) <= kTouchingTool_m) now.push_back(i);
  }
  return touching;
}

PointScale point_scale(const BoundingBox& box_W) {
  const Vec3 outside = Vec3::Constant(kOutside_m);
  return {box_W.min() - outside, (box_W.sizes().maxCoeff() + 2 * kOutside_m) / kMaxNumber};
}

ShownFrame thinned(const ShownFrame& frame, std::size_t wanted_others) {
  ShownFrame some;
  some.index = frame.index, some.captured_s = frame.captured_s;
  some.measured = frame.measured, some.in_box = frame.in_box, some.others = frame.others;
  some.lacks_colours = frame.lacks_colours;
  const std::uint32_t limit = rank_limit(frame.others, wanted_others);
  std::vector<std::uint32_t> place(frame.rank.size());
  for (std::size_t i = 0; i < frame.rank.size(); ++i) {
    place[i] = static_cast<std::uint32_t>(some.rank.size());
    if (frame.rank[i] >= limit) continue;
    some.rank.push_back(frame.rank[i]);
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
      some.positions.push_back(frame.positions[k]);
      if (!frame.colours.empty()) some.colours.push_back(frame.colours[k]);
    }
    if (!frame.fixture_radius_m.empty()) some.fixture_radius_m.push_back(frame.fixture_radius_m[i]);
  }
  for (const std::uint32_t i : frame.touching) some.touching.push_back(place[i]);  // rank 0: never left out
  some.touching_end = frame.touching_end;
  return some;
}

ShownFrames shown_frames(const Experiment& experiment, const RunPath& path, const ShownPointsRule& rule,
                         const Kernels& kernels, const std::atomic<bool>* stop) {
  ShownFrames shown;
  replay_frames(experiment, path.time_s, kernels, stop, [&](const Frame& frame) {
    const auto [first, last] = std::equal_range(path.frame.begin(), path.frame.end(), frame.index);
    const auto begin = static_cast<std::size_t>(first - path.frame.begin()),
               end = static_cast<std::size_t>(last - path.frame.begin());
    if (begin == end) return;  // no tick used it: it arrived too late
    PointCloud buffer;
    const PointCloud& cloud = frame.points->every_point(kernels, buffer);
    const std::uint64_t hash = path.frame_hash.empty() ? 0 : path.frame_hash[begin];
    if (hash != 0 && hash != frame_hash(cloud, frame.captured_s)) shown.are_those_of_the_run = false;
    if (shown.frames.empty() && cloud.image) shown.X_WC = cloud.image->X_WC;
    shown.frames.push_back(shown_frame(frame, cloud, path, begin, end, rule));
  });
  return shown;
}

}  // namespace remote_touch
