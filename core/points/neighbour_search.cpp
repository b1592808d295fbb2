#include "core/points/neighbour_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/kernels/point_kernels.h"
#include "core/points/number_columns.h"

namespace remote_touch {

namespace {

// Moves bit k of the lowest 21 bits to bit 3 k.
std::uint64_t spread(std::uint64_t bits) {
  bits &= 0x1fffff;
  bits = (bits | bits << 32) & 0x1f00000000ffff;
  bits = (bits | bits << 16) & 0x1f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

}  // namespace

std::vector<std::uint32_t> morton_order(const PointCloud& cloud) {
  BoundingBox box;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.is_measured(i)) box.extend(cloud.point(i));
  const double max = std::max(box.sizes().maxCoeff(), 1e-9);
  const double per_m = 0x1ffffe / max;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> codes;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const Vec3 u = (cloud.point(i) - box.min()) * per_m;
    const auto part = [&](int axis) { return spread(static_cast<std::uint64_t>(u[axis])) << axis; };
    codes.emplace_back(part(0) | part(1) | part(2), static_cast<std::uint32_t>(i));
  }
  std::sort(codes.begin(), codes.end());
  std::vector<std::uint32_t> order;
  for (const auto& code : codes) order.push_back(code.second);
  return order;
}

namespace {

constexpr std::size_t kRuns[] = {4096, 512, 64, 8};

// Returns the length of the first part of a run that is halved; 0 if it is not halved any more.
std::size_t half(std::size_t count) {
  for (const std::size_t run : kRuns)
    if (count > run) return std::max<std::size_t>(count / run / 2, 1) * run;
  return 0;
}

struct Item {
  Vec3 p;
  std::uint32_t index;
};

void sort(std::span<Item> items) {
  const std::size_t first = half(items.size());
  if (first == 0) return;
  BoundingBox box;
  for (const Item& item : items) box.extend(item.p);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  // Equal coordinates are ordered by index, so that the parts do not depend on the library.
  const auto is_before = [axis](const Item& a, const Item& b) {
    return a.p[axis] < b.p[axis] || (a.p[axis] == b.p[axis] && a.index < b.index);
  };
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(first), items.end(), is_before);
  sort(items.first(first)), sort(items.subspan(first));
}

}  // namespace

std::vector<std::uint32_t> compact_order(std::span<const Vec3> points) {
  std::vector<Item> items;
  items.reserve(points.size());
  for (const Vec3& p : points) items.push_back({p, static_cast<std::uint32_t>(items.size())});
  sort(items);
  std::vector<std::uint32_t> order;
  order.reserve(items.size());
  for (const Item& item : items) order.push_back(item.index);
  return order;
}

void GatheredPoints::reserve(std::size_t cloud_size, bool with_radius, bool with_stiffness) {
  const std::size_t capacity = cloud_size + 2 * kLanes;
  x_.grow(capacity), y_.grow(capacity), z_.grow(capacity), index_.grow(capacity);
  if (with_radius) radius_.grow(capacity);
  if (with_stiffness) stiffness_.grow(capacity);
  with_radius_ = with_radius, with_stiffness_ = with_stiffness;
}

void GatheredPoints::add(const PointRun& run, const Ball& ball, const Kernels& kernels) {
  const PointSink sink{x_.data(), y_.data(), z_.data(), radius_.data(), stiffness_.data(), index_.data()};
  count_ = kernels.gather.append_within(run, ball.centre.data(), ball.radius, sink, count_);
}

void GatheredPoints::finish() {
  for (std::size_t i = count_; i % kLanes != 0; ++i) {
    x_[i] = y_[i] = z_[i] = kFarAway;
    if (with_radius_) radius_[i] = 0;
    if (with_stiffness_) stiffness_[i] = 0;
  }
}

PointsView GatheredPoints::view() const {
  const std::size_t padded = (count_ + kLanes - 1) / kLanes * kLanes;
  return {x_.data(),
          y_.data(),
          z_.data(),
          with_radius_ ? radius_.data() : nullptr,
          with_stiffness_ ? stiffness_.data() : nullptr,
          padded};
}

PointRun GatheredPoints::run() const {
  const PointsView columns = view();
  return {columns.x, columns.y, columns.z, columns.radius, columns.stiffness, index_.data(), 0, count_};
}

const PointCloud& NeighbourSearch::every_point(const Kernels& kernels, PointCloud& buffer) const {
  constexpr double kEverywhere_m = 1e6;
  GatheredPoints all;
  all.reserve(size(), has_fixture_radius(), has_stiffness());
  gather({Vec3::Zero(), kEverywhere_m}, kernels, all);
  const PointsView view = all.view();
  const auto column = [&](const double* from) {
    return from ? std::vector<double>(from, from + all.size()) : std::vector<double>();
  };
  buffer = {};
  buffer.x = column(view.x), buffer.y = column(view.y), buffer.z = column(view.z);
  buffer.fixture_radius_m = column(view.radius), buffer.stiffness_N_per_m = column(view.stiffness);
  return buffer;
}

CloudSearch::CloudSearch(PointCloud cloud) : cloud_(std::move(cloud)) {
  for (const double r : cloud_.fixture_radius_m) max_fixture_radius_ = std::max(max_fixture_radius_, r);
}

PointRun CloudSearch::run(std::size_t first, std::size_t count) const {
  const auto column = [first](const std::vector<double>& values) {
    return values.empty() ? nullptr : values.data() + first;
  };
  return {cloud_.x.data() + first,           cloud_.y.data() + first,
          cloud_.z.data() + first,           column(cloud_.fixture_radius_m),
          column(cloud_.stiffness_N_per_m),  nullptr,
          static_cast<std::uint32_t>(first), count};
}

void BruteForceSearch::gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const {
  out.add(run(0, cloud_.size()), ball, kernels);
}

namespace {

// --- image window ---

struct PixelRange {
  int first, last;  // ends included; empty when first > last
};

// Returns the pixels along one axis that can see the ball. They lie between the two tangents from the
// camera's centre to a circle at (lateral, z). pre: z > radius, so that both tangents are in front of the
// camera.
PixelRange tangent_range(double lateral, double z, double radius, double focal, double centre, double slack,
                         int count) {
  const double squared = z * z - radius * radius, scale = focal / squared;
  const double spread = radius * std::sqrt(std::max(0.0, lateral * lateral + squared));
  const double low = scale * (lateral * z - spread) + centre - slack;
  const double high = scale * (lateral * z + spread) + centre + slack;
  // The bounds are clamped as doubles, because a pixel far outside the image does not fit an int. The result
  // is low rounded up and high rounded down. Both come from truncation, which rounds a positive number down:
  // std::floor is a function call on the oldest machines.
  const int top = count + 2;
  return {top - static_cast<int>(top - std::clamp(low, -1.0, count + 1.0)),
          static_cast<int>(std::clamp(high, -2.0, count - 1.0) + 2.0) - 2};
}

}  // namespace

ImageWindowSearch::ImageWindowSearch(PointCloud cloud) : CloudSearch(std::move(cloud)) {
  if (!cloud_.image) throw std::invalid_argument("ImageWindowSearch: the cloud has no image layout");
  X_CW_ = cloud_.image->X_WC.inverse();
  nearest_depth_m_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    const double depth = X_CW_.linear().row(2).dot(cloud_.point(i)) + X_CW_.translation().z();
    nearest_depth_m_ = depth < nearest_depth_m_ ? depth : nearest_depth_m_;  // NaN is not less
  }
}

void ImageWindowSearch::gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const {
  const CameraIntrinsics& camera = cloud_.image->camera;
  const Vec3 c_C = X_CW_ * ball.centre;
  // The radius is enlarged for the rounding of the transform and of the points. The margin is far above the
  // rounding of doubles at room scale.
  const double radius = widened(ball).radius * (1 + 1e-9) + 1e-9;
  PixelRange columns{0, camera.width - 1}, rows{0, camera.height - 1};
  // A ball in front of everything that was measured holds no point. This test avoids a search of the whole
  // image for a ball at the camera.
  if (!(c_C.z() + radius >= nearest_depth_m_)) return;
  if (c_C.z() > 1.001 * radius) {
    const double slack = cloud_.image->pixel_slack;
    columns = tangent_range(c_C.x(), c_C.z(), radius, camera.fx, camera.cx, slack, camera.width);
    rows = tangent_range(c_C.y(), c_C.z(), radius, camera.fy, camera.cy, slack, camera.height);
    columns.first = std::max(columns.first, 0), rows.first = std::max(rows.first, 0);
  }
  if (columns.first > columns.last || rows.first > rows.last) return;
  const auto width = static_cast<std::size_t>(columns.last - columns.first + 1);
  PointRun window = run(static_cast<std::size_t>(rows.first) * camera.width + columns.first, width);
  window.rows = static_cast<std::size_t>(rows.last - rows.first + 1);
  window.stride = static_cast<std::size_t>(camera.width);
  out.add(window, ball, kernels);
}

// --- uniform grid ---

UniformGridSearch::UniformGridSearch(PointCloud cloud, double cell_m)
    : CloudSearch(std::move(cloud)), columns_(cloud_.columns()) {
  if (!(cell_m > 0)) throw std::invalid_argument("UniformGridSearch: cell size must be positive");
  cloud_.grid_columns = 0;
  choose_cells(cell_m);
  sort_points_by_cell();
}

void UniformGridSearch::choose_cells(double cell_m) {
  BoundingBox box;
  for (std::size_t i = 0; i < cloud_.size(); ++i)
    if (const Vec3 p = cloud_.point(i); p.allFinite()) box.extend(p);
  if (!box.isEmpty()) low_ = box.min(), high_ = box.max();
  const double allowed = 4.0 * static_cast<double>(cloud_.size()) + 64.0;
  const auto cells_along = [&](int axis) { return std::floor((high_[axis] - low_[axis]) / cell_m) + 1; };
  while (cells_along(0) * cells_along(1) * cells_along(2) > allowed) cell_m *= 1.25;
  cells_per_m_ = 1 / cell_m;
  for (int axis = 0; axis < 3; ++axis) cells_[axis] = static_cast<int>(cells_along(axis));
}

// The result is clamped, because a query may lie anywhere. It increases monotonically with the coordinate, so
// the range of cells of a ball's bounding box includes the cell of each of the ball's points.
int UniformGridSearch::cell_along(int axis, double coordinate) const {
  const double cell = std::floor((coordinate - low_[axis]) * cells_per_m_);
  return static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(cells_[axis] - 1)));
}

// Sorts the points with a counting sort. Points that were not measured come last, in an additional cell that
// no query reads.
void UniformGridSearch::sort_points_by_cell() {
  const std::size_t cell_count = static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2];
  std::vector<std::uint32_t> cell_of(cloud_.size());
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    const Vec3 p = cloud_.point(i);
    std::size_t cell = cell_count;
    if (p.allFinite())
      cell = (static_cast<std::size_t>(cell_along(0, p.x())) * cells_[1] + cell_along(1, p.y())) * cells_[2] +
             cell_along(2, p.z());
    cell_of[i] = static_cast<std::uint32_t>(cell);
  }
  cell_start_.resize(cell_count + 2);
  std::vector<std::uint32_t> next(cell_start_.size());
  original_index_.resize(cloud_.size());
  sort_by_cell(
      cloud_.size(), cell_start_, next, [&](std::size_t i) { return cell_of[i]; },
      [&](std::size_t i, std::uint32_t to) { original_index_[to] = static_cast<std::uint32_t>(i); });

  const auto reorder = [this](auto& column) {
    if (column.empty()) return;
    auto sorted = column;
    for (std::size_t i = 0; i < column.size(); ++i) sorted[i] = column[original_index_[i]];
    column.swap(sorted);
  };
  reorder(cloud_.x), reorder(cloud_.y), reorder(cloud_.z);
  reorder(cloud_.fixture_radius_m), reorder(cloud_.stiffness_N_per_m), reorder(cloud_.colour);
  reorder(cloud_.nx), reorder(cloud_.ny), reorder(cloud_.nz);
}

void UniformGridSearch::gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const {
  const double reach = widened(ball).radius * (1 + 1e-9);
  int first[3], last[3];
  for (int axis = 0; axis < 3; ++axis) {
    if (!(ball.centre[axis] + reach >= low_[axis] && ball.centre[axis] - reach <= high_[axis])) return;
    first[axis] = cell_along(axis, ball.centre[axis] - reach);
    last[axis] = cell_along(axis, ball.centre[axis] + reach);
  }
  for (int i = first[0]; i <= last[0]; ++i) {
    for (int j = first[1]; j <= last[1]; ++j) {
      const std::size_t column = (static_cast<std::size_t>(i) * cells_[1] + j) * cells_[2];
      const std::uint32_t begin = cell_start_[column + first[2]], end = cell_start_[column + last[2] + 1];
      if (begin == end) continue;
      PointRun cells = run(begin, end - begin);
      cells.index = original_index_.data() + begin;
      out.add(cells, ball, kernels);
    }
  }
}

std::unique_ptr<NeighbourSearch> make_search(PointCloud cloud, double cell_m) {
  if (cloud.image) return std::make_unique<ImageWindowSearch>(std::move(cloud));
  if (cloud.size() <= 256) return std::make_unique<BruteForceSearch>(std::move(cloud));
  return std::make_unique<UniformGridSearch>(std::move(cloud), cell_m);
}

namespace {
// The edge of a cube in units of the reach. A smaller edge means fewer useless points in a list, a larger one
// means fewer new lists.
constexpr double kPitch = 0.125;
// The distance that a proxy may move with a narrow list, in units of the reach, and the longest step of a
// slow proxy, in units of that distance. Each step of 4.2.4 is 1 - gamma times the one before, so a slow
// proxy often stays near.
constexpr double kNarrowMargin = 0.02, kSlow = 0.3;
// The maximum number of hops in which a tube is searched, however far the HIP jumped.
constexpr double kMaxHops = 64;
}  // namespace

Neighbourhood::Neighbourhood(double reach, const Kernels& kernels) : kernels_(kernels) {
  set_reach(reach);
}

void Neighbourhood::set_reach(double reach) {
  reach_ = reach;
  pitch_ = kPitch * reach;
  list_radius_ = reach_ + 0.8661 * pitch_;  // sqrt(3)/2, from a cube's centre to its corner, rounded up
  narrow_margin_ = kNarrowMargin * reach;
  forget_lists();
}

void Neighbourhood::forget_lists() {
  for (CachedList& kept : cache_) kept.valid = false;
  narrow_.valid = false;
}

void Neighbourhood::set_points(std::shared_ptr<const NeighbourSearch> points) {
  points_ = std::move(points);
  reserve(points_->size(), points_->has_fixture_radius(), points_->has_stiffness());
  forget_lists();
}

void Neighbourhood::reserve(std::size_t points, bool with_radius, bool with_stiffness) {
  for (CachedList& kept : cache_) kept.points.reserve(points, with_radius, with_stiffness);
  tube_.reserve(points, with_radius, with_stiffness);
  narrow_.points.reserve(points, with_radius, with_stiffness);
}

const GatheredPoints& Neighbourhood::around(const Vec3& p) {
  // Most positions lie well inside the present cube. The slow test decides near its border.
  const CachedList& present = cache_[current_];
  if (present.valid && ((p - present.centre).array().abs() < 0.499 * pitch_).all()) return present.points;
  const Vec3 centre = (p / pitch_).array().round().matrix() * pitch_;
  const auto holds = [&](const CachedList& kept) { return kept.valid && centre == kept.centre; };
  for (std::size_t i = 0; i < cache_.size(); ++i)
    if (holds(cache_[i])) return cache_[current_ = i].points;
  current_ = (current_ + 1) % cache_.size();
  cache_[current_].centre = centre;
  gather(cache_[current_]);
  return cache_[current_].points;
}

void Neighbourhood::gather(CachedList& kept) {
  kept.points.clear();
  points_->gather({kept.centre, list_radius_}, kernels_, kept.points);
  kept.points.finish();
  kept.sum_grid = 1.5 * static_cast<double>(std::bit_ceil(kept.points.size() + 1));
  kept.valid = true;
  narrow_.valid = false;
}

const GatheredPoints& Neighbourhood::narrowed(const Vec3& p) {
  const GatheredPoints& wide = around(p);
  const auto is_near = [&](const Vec3& q, double distance) {
    return (p - q).squaredNorm() < distance * distance;
  };
  const bool is_slow = is_near(std::exchange(last_W_, p), kSlow * narrow_margin_);
  // The narrow list of one cube is not used in the next: it was made from a list that may lack points within
  // the reach of a position there.
  if (narrow_.valid && narrow_of_ == current_ && is_near(narrow_.centre, narrow_margin_))
    return narrow_.points;
  if (!is_slow) return wide;
  narrow_.centre = p;
  narrow_.valid = true, narrow_of_ = current_;
  narrow_.points.clear();
  narrow_.points.add(wide.run(), {p, (reach_ + narrow_margin_) * (1 + 1e-9)}, kernels_);
  narrow_.points.finish();
  return narrow_.points;
}

const GatheredPoints& Neighbourhood::within(const Vec3& p, double radius) {
  tube_.clear();
  points_->gather({p, radius * (1 + 1e-9)}, kernels_, tube_);
  tube_.finish();
  return tube_;
}

double Neighbourhood::first_hit(const Vec3& p, const Vec3& u, double radius, double limit,
                                bool with_regions) {
  const auto hit_in = [&](const GatheredPoints& gathered) {
    PointsView points = gathered.view();
    if (!with_regions) points.radius = nullptr;
    return kernels_.proxy.first_hit(points, p.data(), u.data(), radius);
  };
  // The present list holds every point that can be met before `known`: its region meets the ball around p
  // that contains the swept tube up to there.
  if (const CachedList& here = cache_[current_]; here.valid) {
    const double known = list_radius_ * (1 - 1e-9) - (p - here.centre).norm() - radius;
    const double hit = known > 0 ? std::min(limit, hit_in(here.points)) : limit;
    if (hit <= known) return hit;
  }

  // A point whose region is met first between two hops lies within radius (plus r_f) of that part of the
  // axis, so it meets the ball of that hop. The root is computed from p itself for every hop, so the result
  // does not depend on the hops.
  const double hop = std::max(2 * reach_, limit / kMaxHops);
  for (double start = 0; start < limit; start += hop) {
    const double end = std::min(start + hop, limit);
    const double rounding = 1e-9 * (1 + end);
    tube_.clear();
    points_->gather({p + 0.5 * (start + end) * u, 0.5 * (end - start) + radius + rounding}, kernels_, tube_);
    tube_.finish();
    const double hit = hit_in(tube_);
    if (hit <= end) return hit;
  }
  return limit;
}

}  // namespace remote_touch
