#include "scenarios/simulated/grid_scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace remote_touch {

Parameters parameters(Grid& grid) {
  return {
      {"columns", &grid.columns, 1, 4096, "points along x"},
      {"rows", &grid.rows, 1, 4096, "points along z"},
      {"spacing_m", &grid.spacing_m, 1e-5, 1, "distance between neighbouring points, s_xz of Table 4.2"},
      {"phase_x", &grid.phase_x, -1, 1, "shift of the grid along x, in units of the spacing"},
      {"phase_z", &grid.phase_z, -1, 1, "shift of the grid along z, in units of the spacing"},
  };
}

void add_noise(PointCloud& cloud, double sigma_m, const NoiseStream& stream, const Kernels& kernels) {
  if (sigma_m == 0) return;
  std::vector<std::uint32_t> index(cloud.size());
  std::iota(index.begin(), index.end(), 0u);
  std::vector<double> nx(cloud.size()), ny(cloud.size()), nz(cloud.size());
  kernels.noise.normals(stream, index.data(), index.size(), nx.data(), ny.data(), nz.data());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.x[i] += sigma_m * nx[i], cloud.y[i] += sigma_m * ny[i], cloud.z[i] += sigma_m * nz[i];
}

namespace {

// Points are made within a margin around a query, so that the next queries of a moving proxy find their
// points ready. A query larger than a proxy's gets no margin: such queries come once a frame.
constexpr double kSpareMargin_m = 0.010, kMaxOfProxy_m = 0.025;
// The same for the near ones of these points, which are copied again more often.
constexpr double kNearMargin_m = 0.004;
// Tolerance that is far above the rounding of sums of metres.
constexpr double kRounding_m = 1e-9;

// Returns the nearest update if it is within 1e-6, else the time itself, in updates. Quotients of times are
// rounded, so a time that is meant to be at an update may be slightly off.
double at_update_if_near(double updates) {
  const double nearest = std::round(updates);
  return std::abs(updates - nearest) < 1e-6 ? nearest : updates;
}

}  // namespace

NoisyGridSearch::NoisyGridSearch(const Grid& grid, double height_m, double sigma_m, const NoiseStream& stream)
    : grid_(grid), height_m_(height_m), sigma_m_(sigma_m), stream_(stream) {
  // There is capacity for the points and for a copy of the near ones behind them.
  const std::size_t capacity = 2 * (size() + kLanes);
  index_.grow(capacity), x_bounds_.grow(static_cast<std::size_t>(grid.columns) + kLanes);
  z_bounds_.grow(static_cast<std::size_t>(grid.rows));
  x_.grow(capacity), y_.grow(capacity), z_.grow(capacity);
}

double NoisyGridSearch::Cylinder::margin_m(const Vec3& p) const {
  return radius_m - kRounding_m - std::hypot(p.x() - x, p.z() - z);
}

// Returns the columns or rows whose coordinate without noise lies within reach of the centre.
NoisyGridSearch::Range NoisyGridSearch::within(double centre, double reach, double start, double spacing,
                                               int count) {
  const auto clamped = [count](double place) {
    return static_cast<int>(std::clamp(place, -1.0, static_cast<double>(count)));
  };
  return {std::max(0, clamped(std::ceil((centre - reach - start) / spacing))),
          std::min(count - 1, clamped(std::floor((centre + reach - start) / spacing)))};
}

// Selects the points that can move into the cylinder, by their random words, and then computes their noise.
void NoisyGridSearch::make(const Cylinder& cylinder, const Kernels& kernels) const {
  const double inner = cylinder.radius_m + kRounding_m, reach = inner + kMaxNormal * sigma_m_;
  const Range columns = within(cylinder.x, reach, grid_.x(0), grid_.spacing_m, grid_.columns);
  const Range rows = within(cylinder.z, reach, grid_.z(0), grid_.spacing_m, grid_.rows);
  // A point at this offset from the axis must be moved towards the axis by its noise, by `outside` or more.
  const auto bounds = [&](double offset) {
    const double outside = std::abs(offset) - inner;
    return outside > 0 ? word_bounds(outside / sigma_m_, -offset) : word_bounds(0, 0);
  };
  const auto width = static_cast<std::size_t>(std::max(0, columns.last - columns.first + 1)),
             height = static_cast<std::size_t>(std::max(0, rows.last - rows.first + 1));
  for (std::size_t i = 0; i < width; ++i)
    x_bounds_[i] = bounds(grid_.x(columns.first + static_cast<int>(i)) - cylinder.x);
  for (std::size_t i = 0; i < height; ++i)
    z_bounds_[i] = bounds(grid_.z(rows.first + static_cast<int>(i)) - cylinder.z);
  const auto stride = static_cast<std::uint32_t>(grid_.columns),
             first =
                 static_cast<std::uint32_t>(rows.first) * stride + static_cast<std::uint32_t>(columns.first);
  const std::size_t candidates = kernels.noise.candidates(stream_, {first, stride, width, height},
                                                          x_bounds_.data(), z_bounds_.data(), index_.data());
  make_points(candidates, cylinder, kernels);
  cached_cylinder_ = cylinder;
  near_ball_.radius = -1;
}

PointRun NoisyGridSearch::run(std::size_t first, std::size_t count) const {
  return {x_.data() + first,
          y_.data() + first,
          z_.data() + first,
          nullptr,
          nullptr,
          index_.data() + first,
          0,
          count};
}

// Returns the points of the cylinder that are near the ball, the ball's own points included. pre: the
// cylinder holds the ball.
PointRun NoisyGridSearch::near(const Ball& ball, const Kernels& kernels) const {
  if ((ball.centre - near_ball_.centre).norm() + ball.radius + kRounding_m > near_ball_.radius) {
    near_ball_ = {ball.centre, std::min(ball.radius + kNearMargin_m, cached_cylinder_.margin_m(ball.centre))};
    const PointSink behind{x_.data() + count_,    y_.data() + count_, z_.data() + count_, nullptr, nullptr,
                           index_.data() + count_};
    near_count_ =
        kernels.gather.append_within(run(0, count_), near_ball_.centre.data(), near_ball_.radius, behind, 0);
  }
  return run(count_, near_count_);
}

// Computes the noisy points of the first `candidates` indices and keeps those inside the cylinder.
void NoisyGridSearch::make_points(std::size_t candidates, const Cylinder& cylinder,
                                  const Kernels& kernels) const {
  constexpr std::size_t kChunk = 256;
  double nx[kChunk] = {}, ny[kChunk] = {}, nz[kChunk] = {};
  const double squared = cylinder.radius_m * cylinder.radius_m;
  const auto columns = static_cast<std::uint32_t>(grid_.columns);
  std::uint32_t row_start = 0;  // indices increase, so that a new row is rare
  double row_z = 0;
  count_ = 0;
  for (std::size_t done = 0; done < candidates; done += kChunk) {
    const std::size_t chunk = std::min(kChunk, candidates - done);
    if (sigma_m_ > 0) kernels.noise.normals(stream_, index_.data() + done, chunk, nx, ny, nz);
    for (std::size_t i = 0; i < chunk; ++i) {
      const std::uint32_t point = index_[done + i];
      if (point - row_start >= columns || (done == 0 && i == 0)) {
        row_start = point / columns * columns;
        row_z = grid_.z(static_cast<int>(point / columns));
      }
      const double x = grid_.x(static_cast<int>(point - row_start)) + sigma_m_ * nx[i];
      const double z = row_z + sigma_m_ * nz[i];
      const double dx = x - cylinder.x, dz = z - cylinder.z;
      // Every candidate is stored at the end of the list. The end advances only for those inside.
      x_[count_] = x, y_[count_] = height_m_ + sigma_m_ * ny[i], z_[count_] = z;
      index_[count_] = point;
      count_ += dx * dx + dz * dz <= squared ? 1 : 0;
    }
  }
}

void NoisyGridSearch::gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const {
  const double reach = ball.radius + kMaxNormal * sigma_m_ + kRounding_m;
  if (!ball.centre.allFinite() || std::abs(ball.centre.y() - height_m_) > reach) return;
  const bool is_of_proxy = ball.radius <= kMaxOfProxy_m;
  if (cached_cylinder_.margin_m(ball.centre) < ball.radius)
    make({ball.centre.x(), ball.centre.z(), ball.radius + (is_of_proxy ? kSpareMargin_m : 0)}, kernels);
  out.add(is_of_proxy ? near(ball, kernels) : run(0, count_), ball, kernels);
}

Parameters parameters(FlatGrid::Settings& s) {
  return appended(
      parameters(s.grid),
      {{"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
       {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1, "standard deviation of the noise on x, y and z", kLive},
       {"redraw_noise", &s.redraw_noise, 0, 1,
        "true: new noise in every frame; false: the same noise in all"}});
}

PointCloud FlatGrid::cloud(int frame) const {
  return sampled(redraw_noise_ ? frame : 0, [](double x, double z) { return Vec3(x, 0, z); });
}

Parameters parameters(ListedPoints::Settings& s) {
  return {
      {"points", Rows{{"x_m", "y_m", "z_m"}, &s.points}, -100, 100, "the points, world frame"},
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames per second, when fixtures change with time"},
  };
}

std::string validate(const ListedPoints::Settings& s) {
  return s.points.empty() ? "points: expected one or more" : "";
}

PointCloud ListedPoints::cloud(int) const {
  PointCloud cloud;
  const std::vector<double>& p = settings_.points;
  for (std::size_t i = 0; i + 2 < p.size(); i += 3) cloud.append({p[i], p[i + 1], p[i + 2]});
  return cloud;
}

Parameters parameters(TriangleWave::Settings& s) {
  const Parameters more = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
      {"period_m", &s.period_m, 1e-3, 10, "length of one wave along x"},
      {"max_height_m", &s.max_height_m, 0, 10, "peak-to-peak height at the end of the grid; 0 at its start"},
      {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1,
       "standard deviation of the noise on x, y and z, the same in all frames", kLive},
  };
  return appended(parameters(s.grid), more);
}

// A grid of one column has no length along x, so its wave has no flank.
std::string validate(const TriangleWave::Settings& s) {
  return s.grid.columns >= 2 ? "" : "columns = 1: expected 2 or more, because the wave runs along x";
}

// The corners are at every half period from the grid's start, at the envelope's height there: 0, +, -, +, ...
// The wave is straight between them.
double TriangleWave::surface_height(double x, double, double) const {
  const double start = grid_.x(0), length = grid_.x(grid_.columns - 1) - start;
  const double half = 0.5 * settings_.period_m;
  const double place = std::clamp(x - start, 0.0, length) / half;
  const auto corner = [&](double k) {
    const double amplitude = 0.5 * settings_.max_height_m * std::min(1.0, k * half / length);
    return std::fmod(k, 2) == 1 ? amplitude : -amplitude;
  };
  const double k = std::floor(place);
  return corner(k) + (place - k) * (corner(k + 1) - corner(k));
}

// Exact distance to the polyline across x; the wave does not change along z.
double TriangleWave::signed_distance(const Vec3& p_W, double time_s) const {
  constexpr double kAtEnd_m = 1e-9;
  const double start = grid_.x(0), end = grid_.x(grid_.columns - 1);
  const double half = 0.5 * settings_.period_m;
  const int corners = static_cast<int>(std::ceil((end - start) / half)) + 1;
  const double height_m = surface_height(p_W.x(), 0, time_s);
  // A flank beyond this along x is farther away than the surface at the point's x, or at the end beside it.
  const double reach_m =
      std::abs(p_W.y() - height_m) + std::max({start - p_W.x(), p_W.x() - end, 0.0}) + half;
  double nearest = std::numeric_limits<double>::infinity();
  bool is_at_end = false;
  for (int k = 0; k + 1 < corners; ++k) {
    const double x0 = start + k * half, x1 = std::min(x0 + half, end);
    if (x0 - p_W.x() > reach_m || p_W.x() - x1 > reach_m) continue;
    const double y0 = surface_height(x0, 0, time_s), y1 = surface_height(x1, 0, time_s);
    const double ex = x1 - x0, ey = y1 - y0, px = p_W.x() - x0, py = p_W.y() - y0;
    const double t = std::clamp((px * ex + py * ey) / (ex * ex + ey * ey), 0.0, 1.0);
    const double dx = px - t * ex, dy = py - t * ey;
    const double distance = std::sqrt(dx * dx + dy * dy);  // not hypot: its bits depend on the machine
    if (!(distance < nearest)) continue;
    const double foot_x = x0 + t * ex;
    nearest = distance, is_at_end = foot_x <= start + kAtEnd_m || foot_x >= end - kAtEnd_m;
  }
  if (p_W.y() >= height_m) return nearest;
  // Beyond the ends of the grid in x the foot may still be on a flank.
  const double x_m = is_at_end ? p_W.x() : grid_.x(0);
  return grid_.covers(x_m, p_W.z()) ? -nearest : std::numeric_limits<double>::quiet_NaN();
}

PointCloud TriangleWave::cloud(int frame) const {
  return sampled(frame, [&](double x, double z) { return Vec3(x, surface_height(x, 0, 0), z); });
}

Parameters parameters(LiftMotion::Settings& s) {
  return {
      {"wait_s", &s.wait_s, 0, 10000, "time at rest before the rise"},
      {"start_depth_m", &s.start_depth_m, -10, 10,
       "depth of the first frame below y = 0; negative: above y = 0"},
      {"start_velocity_m_per_s", &s.start_velocity_m_per_s, -10, 10,
       "velocity of the rise, v_0 of (4.20); the cloud recedes where negative"},
      {"rise_s", &s.rise_s, 0, 10000, "time at constant velocity before the acceleration"},
      {"acceleration_m_per_s2", &s.acceleration_m_per_s2, -1000, 1000, "acceleration a after the rise"},
      {"acceleration_s", &s.acceleration_s, 0, 100, "time with acceleration; the lift then rests"},
      {"update_rate_hz", &s.update_rate_hz, 1e-3, 10000,
       "number of heights of 4.3.2 per second through which the motion passes; independent of frame_rate_hz"},
      {"between_updates", choice(s.between_updates, {"parabola", "line"}), 0, 0,
       "motion from one of these heights to the next; parabola: with the acceleration a; line: at constant velocity"},
  };
}

LiftMotion::LiftMotion(const Settings& settings)
    : settings_(settings),
      rise_begin_(at_update_if_near(settings.wait_s * settings.update_rate_hz)),
      rise_end_(rise_begin_ + at_update_if_near(settings.rise_s * settings.update_rate_hz)),
      end_(rise_end_ + at_update_if_near(settings.acceleration_s * settings.update_rate_hz)),
      accelerated_m_{risen_m(rise_end_ - rise_begin_)} {
  double velocity = settings.start_velocity_m_per_s;
  for (int j = 0; j < end_ - rise_end_; ++j) {
    velocity += settings.acceleration_m_per_s2 / settings.update_rate_hz;
    accelerated_m_.push_back(accelerated_m_.back() + velocity / settings.update_rate_hz);
  }
}

int LiftMotion::frame_count(double frame_rate_hz) const {
  return static_cast<int>(std::ceil(end_ * (frame_rate_hz / settings_.update_rate_hz) - 1e-6)) + 1;
}

std::vector<Phase> LiftMotion::phases() const {
  const bool accelerates = settings_.acceleration_m_per_s2 != 0 && end_ > rise_end_;
  const double rate_hz = settings_.update_rate_hz, rise_end = accelerates ? rise_end_ : end_;
  std::vector<Phase> list;
  if (settings_.start_velocity_m_per_s != 0 && rise_end > rise_begin_)
    list.push_back({"the rise", rise_begin_ / rate_hz, rise_end / rate_hz});
  if (accelerates) list.push_back({"the acceleration", rise_end_ / rate_hz, end_ / rate_hz});
  return list;
}

double LiftMotion::risen_m(double updates) const {
  return -settings_.start_depth_m + updates * (settings_.start_velocity_m_per_s / settings_.update_rate_hz);
}

// Returns the height for a motion that is linear from update to update.
double LiftMotion::on_lines_m(double time) const {
  if (time < rise_begin_) return -settings_.start_depth_m;
  const bool rises = time <= rise_end_;
  const double since = time - (rises ? rise_begin_ : rise_end_);
  const double before = std::floor(since);
  const auto update_m = [&](double j) {
    return rises ? risen_m(j)
                 : accelerated_m_[std::min(static_cast<std::size_t>(j), accelerated_m_.size() - 1)];
  };
  return update_m(before) + (since - before) * (update_m(before + 1) - update_m(before));
}

double LiftMotion::height_at_update(double time) const {
  const double place = std::clamp(time, 0.0, end_), accelerated = place - rise_end_;
  double height_m = on_lines_m(place);
  const bool is_on_parabola = end_ > rise_end_ && accelerated > -1;
  if (settings_.between_updates == BetweenUpdates::parabola && is_on_parabola) {
    const double since = at_update_if_near(accelerated), part = since - std::floor(since);
    const double rate_hz = settings_.update_rate_hz;
    height_m -= 0.5 * part * (1 - part) * settings_.acceleration_m_per_s2 / rate_hz / rate_hz;
  }
  return height_m;
}

Parameters parameters(MovingLift::Settings& s) {
  Parameters list =
      appended(parameters(s.grid),
               {{"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
                {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1,
                 "standard deviation of the noise on x, y and z, redrawn per frame", kLive}});
  list = appended(std::move(list), parameters(s.lift));
  list.push_back(
      {"truth", choice(s.truth, {"newest-frame", "moving"}), 0, 0,
       "true surface: newest-frame: the plane at the last capture; moving: the plane as it moves between frames"});
  return list;
}

MovingLift::MovingLift(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : GridScene(settings, key, kernels, settings.truth == SurfaceTime::moving), lift_(settings.lift) {}

double MovingLift::signed_distance(const Vec3& p_W, double time_s) const {
  return grid_.signed_distance(p_W,
                               has_moving_truth_ ? lift_.height_m(time_s) : height_m(newest_frame(time_s)));
}

std::shared_ptr<const NeighbourSearch> MovingLift::points(int frame) const {
  return std::make_shared<NoisyGridSearch>(grid_, height_m(frame), noise_sigma_m_, noise(frame));
}

PointCloud MovingLift::cloud(int frame) const {
  return sampled(frame, [y = height_m(frame)](double x, double z) { return Vec3(x, y, z); });
}

Parameters parameters(MovingPlane::Settings& s) {
  const Parameters more = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
      {"start_height_m", &s.start_height_m, -100, 100, "initial height of the plane"},
      {"wait_s", &s.wait_s, 0, 1e4, "waiting time before it rises"},
      {"speed_m_per_s", &s.speed_m_per_s, 0, 100, "initial speed of the rise"},
      {"acceleration_m_per_s2", &s.acceleration_m_per_s2, 0, 1000, "acceleration of the rise"},
      {"rise_height_m", &s.rise_height_m, 0, 100, "height of the rise; the plane then stops"},
      {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1,
       "standard deviation of the noise on x, y and z, redrawn per frame", kLive},
  };
  return appended(parameters(s.grid), more);
}

std::string validate(const MovingPlane::Settings& s) {
  const bool moves = s.speed_m_per_s > 0 || s.acceleration_m_per_s2 > 0;
  return moves || s.rise_height_m == 0
             ? ""
             : "rise_height_m: a plane without speed_m_per_s and acceleration_m_per_s2 does not rise: expected 0";
}

MovingPlane::MovingPlane(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : GridScene(settings, key, kernels), settings_(settings) {
  if (settings.rise_height_m == 0) return;
  // The root of v t + a t^2 / 2 = rise, without cancellation and for a = 0 too.
  const double v = settings.speed_m_per_s, a = settings.acceleration_m_per_s2;
  rising_s_ = 2 * settings.rise_height_m / (v + std::sqrt(v * v + 2 * a * settings.rise_height_m));
  constexpr double kMaxFrames = std::numeric_limits<int>::max() - 1;
  const double moving_frames = std::ceil((settings.wait_s + rising_s_) * settings.frame_rate_hz - 1e-6);
  moving_frames_ += static_cast<int>(std::min(moving_frames, kMaxFrames));
}

double MovingPlane::height(double time_s) const {
  const double t = time_s - settings_.wait_s;
  if (t >= rising_s_) return settings_.start_height_m + settings_.rise_height_m;
  if (t <= 0) return settings_.start_height_m;
  return settings_.start_height_m + t * (settings_.speed_m_per_s + 0.5 * settings_.acceleration_m_per_s2 * t);
}

PointCloud MovingPlane::cloud(int frame) const {
  const double y = height(captured_s(frame));
  PointCloud cloud = sampled(frame, [y](double x, double z) { return Vec3(x, y, z); });
  cloud.nx.assign(cloud.size(), 0), cloud.ny.assign(cloud.size(), 1), cloud.nz = cloud.nx;
  return cloud;
}

}  // namespace remote_touch
