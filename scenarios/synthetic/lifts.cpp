#include "scenarios/synthetic/lifts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/synthetic/grid_scene.h"

namespace remote_touch {
namespace {

// Returns the nearest update if it is within 1e-6, else the time itself, in updates. Quotients of times are
// rounded, so a time that is meant to be at an update may be slightly off.
double at_update_if_near(double updates) {
  const double nearest = std::round(updates);
  return std::abs(updates - nearest) < 1e-6 ? nearest : updates;
}

}  // namespace

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
