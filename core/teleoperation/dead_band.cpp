#include "core/teleoperation/dead_band.h"

#include <algorithm>

#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

// Times are sums of ticks and rounded. The same tolerance decides whether a packet has arrived.
constexpr double kSameSilence_s = 5e-7;

// Returns the shortest rotation vector, in the world frame.
Vec3 turn_between(const Eigen::Quaterniond& from_W, const Eigen::Quaterniond& to_W) {
  return rotation_vector(to_W * from_W.conjugate());
}

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

}  // namespace remote_touch
