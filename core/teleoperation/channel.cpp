#include "core/teleoperation/channel.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/points/vector.h"

namespace remote_touch {

Parameters parameters(ChannelSettings& s) {
  return {
      {"delay_s", &s.delay_s, 0, 10, "shortest time that a packet travels"},
      {"jitter_s", &s.jitter_s, 0, 10,
       "the time that a packet travels is longer than the delay by a random time, uniform from 0 to this"},
      {"loss_probability", &s.loss_probability, 0, 1, "fraction of the packets that never arrive"},
      {"mean_burst_packets", &s.mean_burst_packets, 1, 1000,
       "mean number of packets that are lost in a row, Gilbert model; 1: each packet is lost by itself"},
      {"reorders", &s.reorders, 0, 1,
       "a packet is also used if it arrives after one that was sent later; otherwise it is dropped"},
  };
}

// A burst begins, after a packet that arrives, with a probability that makes the lost fraction right. This
// probability must not exceed 1: many losses in short bursts would need bursts without a pause.
std::string validate(const ChannelSettings& s) {
  constexpr double kRounding = 1e-9;
  const double loss = s.loss_probability, burst = s.mean_burst_packets;
  if (burst == 1 || loss <= burst * (1 - loss) * (1 + kRounding)) return {};
  const std::string longer = loss < 1 ? ", or at least " + std::to_string(loss / (1 - loss)) : "";
  return "mean_burst_packets = " + std::to_string(burst) + ": expected 1" + longer +
         ", for this loss_probability";
}

PacketFates::PacketFates(const ChannelSettings& s, const NoiseKey& key, NoiseUse use)
    : key_(key),
      use_(use),
      delay_s_(s.delay_s),
      jitter_s_(s.jitter_s),
      loss_after_loss_(s.loss_probability),
      loss_after_arrival_(s.loss_probability),
      next_loss_(s.loss_probability) {
  assert(validate(s).empty());
  if (s.mean_burst_packets == 1) return;
  loss_after_loss_ = 1 - 1 / s.mean_burst_packets;
  loss_after_arrival_ = s.loss_probability / (s.mean_burst_packets * (1 - s.loss_probability));
}

PacketFates::Fate PacketFates::next() {
  const auto block = static_cast<std::uint32_t>(number_ >> 32), point = static_cast<std::uint32_t>(number_);
  ++number_;
  const auto chance = uniforms(noise_stream(key_, use_, block), point);
  const Fate fate{chance[0] < next_loss_, delay_s_ + chance[1] * jitter_s_};
  next_loss_ = fate.is_lost ? loss_after_loss_ : loss_after_arrival_;
  return fate;
}

namespace {

// Times are sums of ticks and rounded. The same tolerance decides whether a packet has arrived.
constexpr double kSameSilence_s = 5e-7;

// Returns the shortest rotation vector, in the world frame.
Vec3 turn_between(const Eigen::Quaterniond& from_W, const Eigen::Quaterniond& to_W) {
  return rotation_vector(to_W * from_W.conjugate());
}

constexpr std::size_t kFewestPoints = 3;

struct LocalPlane {
  Vec3 centre, normal;
};

double weight(double square_m2, double near_m) {
  const double rest = 1 - square_m2 / (near_m * near_m);
  return rest > 0 ? rest * rest : 0;
}

// The points of a frame around a position, as often as they are asked for.
class NearPoints {
 public:
  NearPoints(const NeighbourSearch& frame, const Ball& ball, const Kernels& kernels) {
    points_.reserve(frame.size(), frame.has_fixture_radius(), frame.has_stiffness());
    frame.gather(ball, kernels, points_);
    points_.finish();
  }
  // Returns the plane fitted with weights around q; none with too few points. gather() also finds points
  // whose regions meet the ball; their weight is 0.
  std::optional<LocalPlane> plane(const Vec3& q, double near_m) const {
    const PointsView view = points_.view();
    Vec3 sum = Vec3::Zero();
    double weights = 0;
    std::size_t count = 0;
    const auto each = [&](auto&& take) {
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const Vec3 p(view.x[i], view.y[i], view.z[i]);
        if (const double w = weight((p - q).squaredNorm(), near_m); w > 0) take(p, w);
      }
    };
    each([&](const Vec3& p, double w) { sum += w * p, weights += w, ++count; });
    if (count < kFewestPoints) return {};
    const Vec3 centre = sum / weights;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    each([&](const Vec3& p, double w) { spread += w * (p - centre) * (p - centre).transpose(); });
    return LocalPlane{centre, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0)};
  }

 private:
  GatheredPoints points_;
};

}  // namespace

Parameters parameters(DeadBandSettings& s) {
  return {
      {"weber_fraction", &s.weber_fraction, 0, 1,
       "a sample is sent if it differs from the shown value by more than this fraction of it (Weber)"},
      {"least", &s.least, 0, 100,
       "least difference that is sent, in the unit of the signal; for commanded poses of a tool it is the difference of the positions plus the rotation angle times the distance of the farthest point of the tool from its centre of mass; 0 with weber_fraction 0: all are sent"},
      {"predicts", &s.predicts, 0, 1,
       "the shown value continues linearly between packets; otherwise it is held"},
      {"longest_silence_s", &s.longest_silence_s, 0, 10,
       "a sample is sent at the latest after this time; 0: no limit"},
  };
}

// A fraction of 1 would never send the end of a force: |0 - x^| is not larger than |x^|.
std::string validate(const DeadBandSettings& s) {
  if (s.weber_fraction < 1) return {};
  return "weber_fraction = " + std::to_string(s.weber_fraction) + ": expected less than 1";
}

std::optional<double> longest_silence_s(const DeadBandSettings& s) {
  if (s.weber_fraction == 0 && s.least == 0) return 0;
  return s.longest_silence_s > 0 ? std::optional(s.longest_silence_s) : std::nullopt;
}

Parameters parameters(HoldSettings& s) {
  return {
      {"hold_s", &s.hold_s, 0, 10,
       "a force of the slave is held for this long after a packet with the next one was due, and then fades, so that lost packets leave no force; a dead-band without longest_silence_s never makes a packet due; 0: the force is held until the next packet"},
      {"fade_s", &s.fade_s, 0, 10, "the time in which it fades linearly to zero after hold_s"},
  };
}

double held_share(const HoldSettings& s, double overdue_s) {
  if (s.hold_s == 0 || overdue_s <= s.hold_s + kSameSilence_s) return 1;
  const double left_s = s.hold_s + s.fade_s - overdue_s;
  return left_s > kSameSilence_s ? left_s / s.fade_s : 0;
}

Eigen::Quaterniond shown_orientation(const DeadBandSample& sample, double age_s) {
  if (sample.turn_per_s.isZero(0)) return sample.orientation_W;
  return (rotation(age_s * sample.turn_per_s) * sample.orientation_W).normalized();
}

bool DeadBandSender::must_send(const Vec3& value, const Eigen::Quaterniond& orientation_W,
                               double time_s) const {
  if (!last_ || (s_.weber_fraction == 0 && s_.least == 0)) return true;
  const double silence_s = time_s - last_->sent_s;
  if (s_.longest_silence_s > 0 && silence_s >= s_.longest_silence_s - kSameSilence_s) return true;
  const Vec3 shown = shown_value(*last_, silence_s);
  double difference = (value - shown).norm();
  if (reach_m_ > 0) {
    const Eigen::Quaterniond before_W = remote_touch::shown_orientation(*last_, silence_s);
    difference += reach_m_ * turn_between(before_W, orientation_W).norm();
  }
  return difference > std::max(s_.weber_fraction * shown.norm(), s_.least);
}

std::optional<DeadBandSample> DeadBandSender::send(const Vec3& value, double time_s,
                                                   const Eigen::Quaterniond& orientation_W) {
  ++samples_;
  if (!must_send(value, orientation_W, time_s)) return {};
  DeadBandSample sample{value, Vec3::Zero(), time_s, orientation_W};
  if (s_.predicts && last_ && time_s > last_->sent_s) {
    const double silence_s = time_s - last_->sent_s;
    sample.slope_per_s = (value - last_->value) / silence_s;
    sample.turn_per_s = turn_between(last_->orientation_W, orientation_W) / silence_s;
  }
  last_ = sample;
  ++packets_;
  return sample;
}

std::optional<Vec3> DeadBandSender::shown(double time_s) const {
  if (!last_) return {};
  return shown_value(*last_, time_s - last_->sent_s);
}

std::optional<Eigen::Quaterniond> DeadBandSender::shown_orientation(double time_s) const {
  if (!last_) return {};
  return remote_touch::shown_orientation(*last_, time_s - last_->sent_s);
}

void DeadBandReceiver::receive(const DeadBandSample& sample, double time_s) {
  last_ = sample, arrived_s_ = time_s;
}

std::optional<Vec3> DeadBandReceiver::shown(double time_s) const {
  if (!last_) return {};
  return shown_value(*last_, time_s - arrived_s_);
}

std::optional<Eigen::Quaterniond> DeadBandReceiver::shown_orientation(double time_s) const {
  if (!last_) return {};
  return remote_touch::shown_orientation(*last_, time_s - arrived_s_);
}

Parameters parameters(FrameDeadBandSettings& s) {
  return {
      {"least_motion_m", &s.least_motion_m, 0, 1,
       "a frame is sent only if the surface near the slave has moved by more than this anywhere since the last frame that was sent, by translation or rotation, or if regions or stiffness have changed; 0: every frame is sent"},
      {"near_m", &s.near_m, 0.001, 1,
       "radius around the slave in which the surfaces are compared; the reach of a tool and the radius of the regions are added"},
  };
}

double surface_motion_m(const NeighbourSearch& before, const NeighbourSearch& now, const Vec3& near_W,
                        double near_m, const Kernels& kernels) {
  const double far_m = near_m + std::max(before.max_fixture_radius_m(), now.max_fixture_radius_m());
  const Ball ball{near_W, far_m + near_m};  // the foot is at most far_m away, and the points near_m from it
  const NearPoints old_points(before, ball, kernels), new_points(now, ball, kernels);
  const std::optional<LocalPlane> around = old_points.plane(near_W, far_m);
  if (!around) return new_points.plane(near_W, far_m) ? std::numeric_limits<double>::infinity() : 0;
  const Vec3 foot = near_W - around->normal.dot(near_W - around->centre) * around->normal;
  const std::optional<LocalPlane> from = old_points.plane(foot, near_m), to = new_points.plane(foot, near_m);
  if (!from || !to) return from || to ? std::numeric_limits<double>::infinity() : 0;
  const Vec3 place = foot - from->normal.dot(foot - from->centre) * from->normal;
  const double cosine = std::abs(from->normal.dot(to->normal));
  if (!(cosine > 0)) return std::numeric_limits<double>::infinity();
  const double height_m = std::abs(to->normal.dot(to->centre - place)) / cosine;
  return height_m + near_m * from->normal.cross(to->normal).norm() / cosine;
}

// A frame without such values is a single point with the values that points then have. A stiffness of -1 is
// that of the renderer.
FrameDeadBand::PointValues FrameDeadBand::values_of(const NeighbourSearch& points, const Kernels& kernels) {
  constexpr std::array<double, 2> kNone{0, -1};
  constexpr double kEverywhere_m = 1e6;
  if (!points.has_fixture_radius() && !points.has_stiffness()) return {kNone};
  GatheredPoints all;
  all.reserve(points.size(), points.has_fixture_radius(), points.has_stiffness());
  points.gather({Vec3::Zero(), kEverywhere_m}, kernels, all);
  const PointsView view = all.view();
  PointValues values(points.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::array<double, 2>& value = values[all.index()[i]].emplace(kNone);
    if (view.radius) value[0] = view.radius[i];
    if (view.stiffness && !std::isnan(view.stiffness[i])) value[1] = view.stiffness[i];
  }
  return values;
}

bool FrameDeadBand::differ(const PointValues& before, const PointValues& now) {
  if (before.size() == now.size()) {
    const auto are_equal = [](const auto& a, const auto& b) { return !a || !b || *a == *b; };
    return !std::equal(before.begin(), before.end(), now.begin(), are_equal);
  }
  std::optional<std::array<double, 2>> first;
  const auto is_other = [&](const auto& value) {
    if (value && !first) first = value;
    return value && *value != *first;
  };
  return std::ranges::any_of(before, is_other) || std::ranges::any_of(now, is_other);
}

bool FrameDeadBand::sends(const Frame& frame, const std::optional<Vec3>& slave_W, const Kernels& kernels) {
  if (s_.least_motion_m == 0) return ++sent_, true;
  if (newest_s_ && frame.captured_s < *newest_s_) return false;
  newest_s_ = frame.captured_s;
  if (last_ && !(frame.captured_s > last_->captured_s)) return false;
  PointValues values = values_of(*frame.points, kernels);
  const bool is_needed =
      !last_ || !slave_W || differ(last_values_, values) || frame.guidance != last_->guidance ||
      surface_motion_m(*last_->points, *frame.points, *slave_W, s_.near_m, kernels) > s_.least_motion_m;
  if (!is_needed) return false;
  ++sent_;
  last_ = frame, last_->prepared = nullptr;
  last_values_ = std::move(values);
  return true;
}

}  // namespace remote_touch
