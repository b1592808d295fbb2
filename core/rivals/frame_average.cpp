#include "core/rivals/frame_average.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace remote_touch {
namespace {

constexpr std::size_t kBlock = 128;

}  // namespace

void BlockSearch::reserve(std::size_t points) {
  for (std::vector<double>* column : {&x_, &y_, &z_, &radius_, &stiffness_}) column->reserve(points);
  boxes_.reserve(points / kBlock + 1);
}

void BlockSearch::clear(std::size_t points, int columns, bool with_radius, bool with_stiffness) {
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  for (std::vector<double>* column : {&x_, &y_, &z_}) column->assign(points, kNoNumber);
  radius_.assign(with_radius ? points : 0, 0);
  stiffness_.assign(with_stiffness ? points : 0, kNoNumber);
  columns_ = columns;
}

void BlockSearch::finish() {
  max_radius_m_ = 0;
  for (const double radius : radius_) max_radius_m_ = std::max(max_radius_m_, radius);
  boxes_.clear();
  for (std::size_t first = 0; first < size(); first += kBlock) {
    BoundingBox box;
    for (std::size_t i = first; i < std::min(first + kBlock, size()); ++i)
      if (const Vec3 p(x_[i], y_[i], z_[i]); p.allFinite()) box.extend(p);
    boxes_.push_back(box);
  }
}

void BlockSearch::gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const {
  const double reach = (ball.radius + max_radius_m_) * (1 + 1e-9);
  for (std::size_t block = 0; block < boxes_.size(); ++block) {
    const BoundingBox& box = boxes_[block];
    if (box.isEmpty() || box.squaredExteriorDistance(ball.centre) > reach * reach) continue;
    const std::size_t first = block * kBlock, count = std::min(kBlock, size() - first);
    out.add({x_.data() + first, y_.data() + first, z_.data() + first,
             has_fixture_radius() ? radius_.data() + first : nullptr,
             has_stiffness() ? stiffness_.data() + first : nullptr, nullptr,
             static_cast<std::uint32_t>(first), count},
            ball, kernels);
  }
}

namespace {

const Vec3 kNotMeasured = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());

}  // namespace

Parameters parameters(FrameAverageSettings& s) {
  return {
      {"average", choice(s.rule, {"exponential", "mean"}), 0, 0,
       "average of each point over the frames; exponential: temporal filter of a depth camera, along the ray; mean: of the last frames"},
      {"alpha", &s.alpha, 0.01, 1, "weight of the newest depth in the exponential average; 1: no filter"},
      {"step_threshold_m", &s.step_threshold_m, 0, 10,
       "exponential: a depth that differs from the average by this distance or more replaces the average"},
      {"persistence_hits", &s.persistence_hits, 1, 16,
       "exponential: a missing point is shown at its last position if it was measured in at least this many of the "
       "last persistence_frames frames"},
      {"persistence_frames", &s.persistence_frames, 0, 16,
       "exponential: number of last frames that persistence_hits counts; 0: a missing point is never shown"},
      {"mean_frames", &s.mean_frames, 1, 16, "mean: number of last frames that are averaged"},
      {"view_direction", &s.view_direction, -1, 1,
       "viewing direction of the sensor; for images the ray of each pixel is used instead"},
  };
}

std::string validate(const FrameAverageSettings& s) {
  if (s.view_direction.norm() < 0.001) return "view_direction: expected a vector of length 0.001 or more";
  if (s.persistence_frames > 0 && s.persistence_hits > s.persistence_frames)
    return "persistence_hits = " + std::to_string(s.persistence_hits) +
           ": expected at most persistence_frames = " + std::to_string(s.persistence_frames);
  return "";
}

FrameAverage::FrameAverage(const FrameAverageSettings& settings, const Kernels& kernels)
    : s_(settings),
      kernels_(kernels),
      shown_{std::make_shared<BlockSearch>(), std::make_shared<BlockSearch>()} {}

void FrameAverage::reserve(std::size_t points) {
  all_.reserve(points, true, true);
  const int frames = s_.rule == AverageRule::mean ? s_.mean_frames : 1;
  for (int i = 0; i < frames; ++i) history_[i].reserve(points);
  smooth_.reserve(points), seen_.reserve(points);
  for (const auto& shown : shown_) shown->reserve(points);
}

void FrameAverage::begin(std::size_t points) {
  reserve(points);
  const int frames = s_.rule == AverageRule::mean ? s_.mean_frames : 1;
  for (int i = 0; i < frames; ++i) history_[i].assign(points, kNotMeasured);
  smooth_.assign(points, kNotMeasured), seen_.assign(points, 0);
}

// Stores the positions of the newest frame by the indices of its points.
void FrameAverage::store(const NeighbourSearch& points) {
  constexpr double kEverywhere_m = 1e6;
  newest_ = s_.rule == AverageRule::mean ? (newest_ + 1) % s_.mean_frames : 0;
  std::vector<Vec3>& now = history_[newest_];
  std::fill(now.begin(), now.end(), kNotMeasured);
  all_.clear();
  points.gather({Vec3::Zero(), kEverywhere_m}, kernels_, all_);
  const PointsView view = all_.view();
  for (std::size_t i = 0; i < all_.size(); ++i) now[all_.index()[i]] = Vec3(view.x[i], view.y[i], view.z[i]);
}

// Returns the average of a point after the newest frame. A missing point keeps its average as long as the
// persistence allows; then the result is NaN.
Vec3 FrameAverage::exponential(std::size_t number, const ViewPoint& view) {
  const Vec3 now = latest(number);
  const bool is_measured = now.allFinite();
  std::uint32_t& seen = seen_[number];
  seen = seen << 1 | (is_measured ? 1u : 0u);
  Vec3& smooth = smooth_[number];
  if (!is_measured) {
    const std::uint32_t recent = seen & ((1u << s_.persistence_frames) - 1);
    return s_.persistence_frames > 0 && std::popcount(recent) >= s_.persistence_hits ? smooth : kNotMeasured;
  }
  const Vec3 ray = view.ray_to(now).normalized();
  const double change_m = ray.dot(smooth - now);  // NaN at first
  smooth = std::abs(change_m) < s_.step_threshold_m ? Vec3(now + (1 - s_.alpha) * change_m * ray) : now;
  return smooth;
}

Vec3 FrameAverage::mean(std::size_t number) const {
  if (!latest(number).allFinite()) return kNotMeasured;
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (int i = 0; i < s_.mean_frames; ++i)
    if (const Vec3& p = history_[i][number]; p.allFinite()) sum += p, ++count;
  return sum / count;
}

std::shared_ptr<const NeighbourSearch> FrameAverage::next(const NeighbourSearch& points) {
  all_.reserve(points.size(), true, true);
  if (points.size() != seen_.size() && points.size() > 0) begin(points.size());
  store(points);
  shown_last_ = 1 - shown_last_;
  BlockSearch& shown = *shown_[shown_last_];
  shown.clear(seen_.size(), points.organised_columns(), points.has_fixture_radius(), points.has_stiffness());
  const PointsView view_of_all = all_.view();
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (points.has_fixture_radius()) shown.set_fixture_radius(all_.index()[i], view_of_all.radius[i]);
    if (points.has_stiffness()) shown.set_stiffness(all_.index()[i], view_of_all.stiffness[i]);
  }
  const ViewPoint view = view_point(points, s_.view_direction);
  for (std::size_t i = 0; i < seen_.size(); ++i)
    shown.set(i, s_.rule == AverageRule::mean ? mean(i) : exponential(i, view));
  shown.finish();
  return shown_[shown_last_];
}

}  // namespace remote_touch
