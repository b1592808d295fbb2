#include "runners/presentation/view/shown_frames.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/colour.h"
#include "runners/experiment/catalog/frame_stream.h"
#include "runners/presentation/view/frames_again.h"

namespace remote_touch {

namespace {

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

// Keeps the part of each frame that is shown.
class FrameViewer {
 public:
  FrameViewer(const RunPath& path, const ShownPointsRule& rule, const Kernels& kernels)
      : path_(path), rule_(rule), scale_(point_scale(rule.box_W)), kernels_(kernels) {}

  void on_frame(const Frame& frame) {
    const auto [first, last] = std::equal_range(path_.frame.begin(), path_.frame.end(), frame.index);
    const auto begin = static_cast<std::size_t>(first - path_.frame.begin()),
               end = static_cast<std::size_t>(last - path_.frame.begin());
    if (begin == end) return;  // no tick used it: it arrived too late
    PointCloud buffer;
    const PointCloud& cloud = frame.points->every_point(kernels_, buffer);
    const std::uint64_t hash = path_.frame_hash.empty() ? 0 : path_.frame_hash[begin];
    if (hash != 0 && hash != frame_hash(cloud, frame.captured_s)) shown.are_those_of_the_run = false;
    if (shown.frames.empty() && cloud.image) shown.X_WC = cloud.image->X_WC;
    const auto touching = touching_in(cloud, begin, end);
    ShownPoints points =
        shown_points(cloud, all_of(touching), std::span(path_.proxy_W).subspan(begin, end - begin), rule_);
    ShownFrame& now = shown.frames.emplace_back();
    now.index = frame.index, now.captured_s = frame.captured_s;
    now.measured = points.measured, now.in_box = points.in_box, now.others = points.others;
    now.rank = std::move(points.rank);
    now.positions = numbers_of(cloud, points.indices, scale_);
    now.colours = colours_of(cloud, points.indices);
    now.lacks_colours = lacks_colours(cloud, points.indices);
    now.fixture_radius_m = radii_of(cloud, points.indices);
    for (const auto& of_tick : touching) {
      for (const std::uint32_t i : of_tick)
        now.touching.push_back(static_cast<std::uint32_t>(
            std::lower_bound(points.indices.begin(), points.indices.end(), i) - points.indices.begin()));
      now.touching_end.push_back(static_cast<std::uint32_t>(now.touching.size()));
    }
  }

  ShownFrames shown;

 private:
  TouchingPoints touching_in(const PointCloud& cloud, std::size_t begin, std::size_t end) const {
    if (!path_.tool)
      return touching_proxy(std::span(path_.proxy_W).subspan(begin, end - begin), path_.touch_radius_m,
                            cloud);
    std::vector<ToolPose> poses;
    for (std::size_t tick = begin; tick < end; ++tick)
      poses.push_back({path_.proxy_W[tick], path_.tool_orientation_W[tick]});
    return touching_tool(*path_.tool, poses, cloud);
  }

  const RunPath& path_;
  const ShownPointsRule& rule_;
  const PointScale scale_;
  const Kernels& kernels_;
};

}  // namespace

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
  FrameViewer viewer(path, rule, kernels);
  replay_frames(experiment, path.time_s, kernels, stop, [&](const Frame& frame) { viewer.on_frame(frame); });
  return std::move(viewer.shown);
}

}  // namespace remote_touch
