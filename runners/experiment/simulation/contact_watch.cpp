#include "runners/experiment/simulation/run_notes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"

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

// Returns the points of a frame within a ball.
std::vector<Vec3> points_in(const NeighbourSearch& frame, const Ball& ball, const Kernels& kernels) {
  GatheredPoints found;
  found.reserve(frame.size(), frame.has_fixture_radius(), frame.has_stiffness());
  frame.gather(ball, kernels, found);
  const PointsView view = found.view();
  std::vector<Vec3> near;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Vec3 p(view.x[i], view.y[i], view.z[i]);
    // gather() also adds points outside the ball whose regions meet it.
    if ((p - ball.centre).norm() <= ball.radius) near.push_back(p);
  }
  return near;
}

// Returns the radius of the widest gap through which a ball passes; 0 if none was found. The points within 3
// ball radii decide most runs. A contact near the border of the points, or between scan lines that are far
// apart, needs more points.
double gap_radius_m(const NeighbourSearch& frame, const Vec3& position_W, double ball_radius_m,
                    const Kernels& kernels) {
  for (const double reach : {3.0, 6.0}) {
    const double known_m = reach * ball_radius_m;
    const PointGap gap =
        widest_gap(points_in(frame, {position_W, known_m}, kernels), position_W, ball_radius_m, known_m);
    if (gap.radius_m > 0 || gap.is_decided) return gap.radius_m;
  }
  return 0;
}

// Returns two numbers with three digits, or with more if they would look equal.
std::pair<std::string, std::string> distinct_texts(double a, double b) {
  constexpr int kMostDigits = 9;
  for (int digits = 3;; ++digits) {
    const std::string text_a = formatted("%.*g", digits, a), text_b = formatted("%.*g", digits, b);
    if (digits == kMostDigits || text_a != text_b) return {text_a, text_b};
  }
}

}  // namespace

// A gap at the position is wider than the ball. It contains a disk of radius ball_radius_m that contains the
// position, so the centre of that disk is at most ball_radius_m from the position. The search starts from the
// cells of a lattice over these centres. A cell is skipped if one point is within the ball's radius of all of
// the cell: no such disk can have its centre there.
PointGap widest_gap(const std::vector<Vec3>& points, const Vec3& position, double ball_radius_m,
                    double known_m) {
  assert(ball_radius_m > 0);
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

void ContactWatch::add(double time_s, const Vec3& hand_W, const RenderOutput& out, const Points& points,
                       double proxy_distance_m) {
  if (!points) return;
  if (!start_) start_ = Site{time_s, hand_W, points};
  const bool is_new_frame = out.frame_index != frame_;
  frame_ = out.frame_index;
  const auto now = [&] { return Site{time_s, out.proxy_W, points}; };
  if (contact_) {
    frames_ += is_new_frame ? 1 : 0;
  } else if (out.contact_count > 0) {
    contact_ = now();
  } else if (out.nearest_distance_m < nearest_m_) {
    nearest_m_ = out.nearest_distance_m, nearest_ = now();
  }
  if (side_.add(proxy_distance_m))
    crossing_ = Crossing{now(), contact_.has_value(), frames_};
  else if (side_.popped_through() != 1)
    crossing_.reset();
}

std::vector<Note> ContactWatch::spacing_notes(double ball_radius_m, const Kernels& kernels) const {
  struct Candidate {
    const Site* site;
    const char* where;
  };
  const Candidate candidates[] = {
      {contact_ ? &*contact_ : nullptr, "at the first contact"},
      {!contact_ && nearest_ ? &*nearest_ : nullptr, "where the proxy came nearest to them"},
      {crossing_ ? &crossing_->site : nullptr, "where the proxy passed the true surface"}};
  for (const auto& [site, where] : candidates) {
    if (!site) continue;
    const double gap_m = gap_radius_m(*site->points, site->position_W, ball_radius_m, kernels);
    if (!(gap_m > 0)) continue;
    return {
        {"wide spacing",
         formatted("the points leave a gap of radius %.3g mm %s: a proxy of contact radius %.3g mm can fall "
                   "through it",
                   1e3 * gap_m, where, 1e3 * ball_radius_m)}};
  }
  return {};
}

std::vector<Note> ContactWatch::start_notes(const Scenario& scenario, double rest_distance_m,
                                            const Kernels& kernels) const {
  if (!start_) return {};
  const Vec3& hand_W = start_->position_W;
  const double distance_m = scenario.signed_distance(hand_W, start_->time_s);
  if (distance_m > 0 && distance_m >= rest_distance_m) return {};
  // The true surface alone is not enough, because it may extend beyond the points. A point must be near too.
  const double reach_m = rest_distance_m + (distance_m < 0 ? -distance_m : 0);
  const std::vector<Vec3> near = points_in(*start_->points, {hand_W, reach_m}, kernels);
  if (near.empty()) return {};
  const std::string place =
      distance_m < 0 ? formatted("%.3g mm behind the true surface", -1e3 * distance_m)
      : std::isnan(distance_m)
          ? formatted("nearer to a point than the contact radius of %.3g mm", 1e3 * rest_distance_m)
          : formatted("%.3g mm in front of the true surface, nearer than the contact radius of %.3g mm",
                      1e3 * distance_m, 1e3 * rest_distance_m);
  return {{"starts in contact",
           formatted("when the first frame arrives, at %.6g s, the hand is ", start_->time_s) + place}};
}

std::vector<Note> ContactWatch::first_touch_notes(const Scenario& scenario, double ball_radius_m,
                                                  const Kernels& kernels) const {
  constexpr int kFrames = 2;  // see surface_contacts.h
  if (!crossing_ || crossing_->frames > kFrames) return {};
  const Site& site = crossing_->site;
  const double before_s = std::max(0.0, site.time_s - 1 / scenario.frame_rate_hz());  // no NaN
  const double moved_m = scenario.signed_distance(site.position_W, before_s) -
                         scenario.signed_distance(site.position_W, site.time_s);
  if (!(moved_m > 0)) return {};
  // The true surface may extend beyond the points. A hand beside the points loses nothing there.
  const double reach_m = ball_radius_m + moved_m;
  if (!crossing_->touched && points_in(*site.points, {site.position_W, reach_m}, kernels).empty()) return {};
  const auto [moved, safe] =
      distinct_texts(moved_m / (site.time_s - before_s), ball_radius_m * scenario.frame_rate_hz());
  return {
      {"lost at the first touch",
       formatted(
           "the true surface passed the proxy at %.6g s, %s; it moved at %s m/s towards the proxy, and even "
           "without noise a first touch is safe only up to %s m/s over a point, and less between points",
           site.time_s,
           crossing_->touched ? "before a third frame came after the first contact"
                              : "before the proxy touched a point",
           moved.c_str(), safe.c_str())}};
}

WallWatch::WallWatch(const Scenario& scenario, std::string what)
    : scenario_(scenario), what_(std::move(what)), has_walls_(!scenario.true_meshes(0).empty()) {}

double WallWatch::side_m(const Vec3& position_W, double signed_distance_m, double time_s) {
  constexpr double kTurnedRound = -0.5;  // cosine of the angle; at a corner the normal turns by less
  if (!has_walls_ || std::isnan(signed_distance_m)) return signed_distance_m;
  const bool is_inside = signed_distance_m < 0;
  if (is_inside && !last_normal_ && outside_W_) last_normal_ = scenario_.true_normal(*outside_W_, time_s);
  if (is_inside || last_normal_) {
    const Vec3 normal = scenario_.true_normal(position_W, time_s);
    if (last_normal_ && normal.dot(*last_normal_) < kTurnedRound) {
      if (walls_ == 0) outward_ = *last_normal_;
      walls_ += last_normal_->dot(outward_) > 0 ? 1 : -1;
      if (!has_passed_) has_passed_ = true, first_s_ = time_s, half_m_ = std::abs(signed_distance_m);
    }
    if (normal.allFinite()) last_normal_ = normal;  // else the middle of the wall, or a crease
  }
  if (!is_inside) outside_W_ = position_W, last_normal_.reset();
  return walls_ == 0 ? signed_distance_m : std::nan("");
}

std::vector<Note> WallWatch::notes() const {
  if (!has_passed_) return {};
  return {
      {"thin object",
       formatted(
           "at %.6g s %s passed the middle of a wall, %.2g mm below its surface: on which side of the wall "
           "it is does not show from there on, and measures that need the side leave these ticks out",
           first_s_, what_.c_str(), 1e3 * half_m_)}};
}

std::vector<Note> tool_start_notes(const Trace& trace) {
  const auto has_frame = [](int frame) { return frame >= 0; };
  const auto first = std::ranges::find_if(trace.frame_index, has_frame) - trace.frame_index.begin();
  const auto tick = static_cast<std::size_t>(first);
  if (tick == trace.length() || trace.contact_count[tick] == 0) return {};
  return {
      {"starts in contact",
       formatted(
           "the tool touches points when the first frame arrives, at %.6g s: %d contacts, a force of %.3g N",
           trace.time_s[tick], trace.contact_count[tick], trace.force_N[tick].norm())}};
}

}  // namespace remote_touch
