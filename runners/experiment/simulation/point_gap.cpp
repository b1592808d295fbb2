#include "runners/experiment/simulation/point_gap.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace remote_touch {

namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kRounding = 1e-9;  // relative difference of distances that count as equal

// Returns the points in their plane, with the position as the origin. Returns none if they define no plane.
std::vector<Vec2> in_their_plane(const std::vector<Vec3>& points, const Vec3& position) {
  constexpr double kLine = 1e-6;  // ratio of the variances across and along points on a line
  if (points.size() < 3) return {};
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += (p - position) / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) {
    const Vec3 apart = p - position - mean;
    scatter += apart * apart.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);  // the smallest variance comes first
  if (!(axes.eigenvalues()[1] > kLine * axes.eigenvalues()[2])) return {};
  std::vector<Vec2> flat;
  flat.reserve(points.size());
  for (const Vec3& p : points)
    flat.emplace_back(axes.eigenvectors().col(2).dot(p - position),
                      axes.eigenvectors().col(1).dot(p - position));
  return flat;
}

double nearest_m(const std::vector<Vec2>& points, const Vec2& centre) {
  double squared = std::numeric_limits<double>::infinity();
  for (const Vec2& p : points) squared = std::min(squared, (p - centre).squaredNorm());  // no NaN
  return std::sqrt(squared);
}

bool has_point_within(const std::vector<Vec2>& points, const Vec2& centre, double radius_m) {
  const double squared = radius_m * radius_m;
  return std::ranges::any_of(points, [&](const Vec2& p) { return (p - centre).squaredNorm() <= squared; });
}

struct Disk {
  Vec2 centre;
  double radius_m;
};

// The widest angle, seen from the centre of a disk, in which no point lies on the border of the disk.
struct OpenAngle {
  double width;    // radians, up to 2 pi
  Vec2 direction;  // its bisector
  Vec2 side;       // a point on the border, at one side of the angle
};

OpenAngle widest_open_angle(const std::vector<Vec2>& points, const Disk& disk) {
  std::vector<std::pair<double, Vec2>> border;
  for (const Vec2& p : points) {
    const Vec2 apart = p - disk.centre;
    if (apart.norm() <= disk.radius_m * (1 + kRounding))
      border.emplace_back(std::atan2(apart.y(), apart.x()), p);
  }
  std::ranges::sort(border, [](const auto& a, const auto& b) { return a.first < b.first; });
  OpenAngle widest{-1, Vec2::Zero(), Vec2::Zero()};
  for (std::size_t i = 0; i < border.size(); ++i) {
    const bool is_last = i + 1 == border.size();
    const double next = is_last ? border.front().first + 2 * std::numbers::pi : border[i + 1].first;
    const double width = next - border[i].first, middle = border[i].first + 0.5 * width;
    if (width > widest.width) widest = {width, {std::cos(middle), std::sin(middle)}, border[i].second};
  }
  return widest;
}

// Moves the centre of a disk away from its nearest points, in the direction in which their distance grows
// fastest, until points hold the disk all around. Returns nothing if it leaves the points.
std::optional<Disk> held_disk(const std::vector<Vec2>& points, Vec2 centre) {
  constexpr int kMaxMoves = 100;  // few are needed: each ends at one more point of the border
  for (int move = 0; move < kMaxMoves; ++move) {
    const Disk disk{centre, nearest_m(points, centre)};
    const OpenAngle open = widest_open_angle(points, disk);
    if (open.width <= std::numbers::pi * (1 + kRounding)) return disk;
    // The disk moves to centre + t direction and keeps open.side on its border. Its border meets q at this t.
    double t = std::numeric_limits<double>::infinity();
    for (const Vec2& q : points) {
      const double farther = (q - centre).squaredNorm() - disk.radius_m * disk.radius_m;
      const double ahead = open.direction.dot(q - open.side);
      const bool is_at_border = farther <= 3 * kRounding * disk.radius_m * disk.radius_m;
      if (!is_at_border && ahead > 0) t = std::min(t, farther / (2 * ahead));  // no NaN
    }
    if (std::isinf(t)) return {};
    centre += t * open.direction;
  }
  return {};
}

}  // namespace

// A gap at the position is wider than the ball. It contains a disk of radius ball_radius_m that contains the
// position, so the centre of that disk is at most ball_radius_m from the position. The search starts from the
// cells of a lattice over these centres. A cell is skipped if one point is within the ball's radius of all of
// the cell: no such disk can have its centre there.
PointGap widest_gap(const std::vector<Vec3>& points, const Vec3& position, double ball_radius_m,
                    double known_m) {
  const std::vector<Vec2> flat = in_their_plane(points, position);
  if (flat.empty()) return {};
  PointGap gap{0, true};
  constexpr int kCells = 6;  // number of cells from the position to the border of the lattice
  const double pitch_m = 0.25 * ball_radius_m;
  for (int row = -kCells; row <= kCells; ++row)
    for (int column = -kCells; column <= kCells; ++column) {
      const Vec2 cell(column * pitch_m, row * pitch_m);
      if (cell.norm() > kCells * pitch_m) continue;
      if (has_point_within(flat, cell, ball_radius_m - std::numbers::sqrt2 / 2 * pitch_m)) continue;
      const std::optional<Disk> disk = held_disk(flat, cell);
      if (!disk || disk->centre.norm() + disk->radius_m > known_m) {
        gap.is_decided = false;
        continue;
      }
      const bool passes = disk->radius_m > ball_radius_m * (1 + kRounding);
      const bool is_here = disk->centre.norm() <= disk->radius_m * (1 + kRounding);
      if (passes && is_here) gap.radius_m = std::max(gap.radius_m, disk->radius_m);  // no NaN
    }
  return gap;
}

}  // namespace remote_touch
