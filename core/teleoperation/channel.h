// A channel with delay, jitter and loss, through which the two sides of a teleoperation send samples, and
// perceptual dead-bands: samples that differ too little from what the other side has to be felt are not sent.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/noise.h"
#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"

namespace remote_touch {

// The largest time by which a packet may arrive after a tick and still belong to it, because sums of times
// are rounded.
inline constexpr double kSameArrival_s = 5e-7;

struct ChannelSettings {
  double delay_s = 0;
  double jitter_s = 0;
  double loss_probability = 0;
  double mean_burst_packets = 1;
  bool reorders = false;
};

Parameters parameters(ChannelSettings& s);
std::string validate(const ChannelSettings& s);

// The fates of the packets of a channel, in the order of sending.
//
// A packet travels for delay_s + u jitter_s, with u uniform in (0, 1) and independent of other packets.
//
// If mean_burst_packets is 1, each packet is lost by itself, with loss_probability. Otherwise the losses are
// those of a Gilbert model (Gilbert 1960, with all packets lost in the bad state): a chain of two states
// with one step per packet. Its stationary probability of loss is loss_probability, and its bursts of lost
// packets have a geometric length with the mean mean_burst_packets. The first packet has the stationary
// probability. Independent losses have bursts, too, with 1 / (1 - loss_probability) packets in the mean.
//
// The fate of packet n is a function of the settings, the key, the use and n. The random numbers of a packet
// can be computed alone; only the state of the Gilbert model is stepped from packet to packet. They do not
// depend on the settings, so that a packet which is lost by independent losses is also lost with a larger
// loss_probability.
class PacketFates {
 public:
  PacketFates(const ChannelSettings& settings, const NoiseKey& key, NoiseUse use);

  struct Fate {
    bool is_lost = false;
    double travel_s = 0;
  };
  // Returns the fate of the next packet, the first of which has the number 0. There are up to 2^60 packets.
  Fate next();

 private:
  const NoiseKey key_;
  const NoiseUse use_;
  const double delay_s_, jitter_s_;
  double loss_after_loss_, loss_after_arrival_;  // probabilities of loss, given the fate of the packet before
  double next_loss_;
  std::uint64_t number_ = 0;
};

// sent = lost + overtaken + replaced + received + number of packets that are still in transit.
struct ChannelCounts {
  std::uint64_t sent = 0;
  std::uint64_t lost = 0;
  std::uint64_t overtaken = 0;  // arrived after a packet that was sent later, and were dropped
  std::uint64_t replaced = 0;   // arrived, but another packet arrived before the next call of receive()
  std::uint64_t received = 0;   // were returned by receive()
};

// One direction of a connection. Nothing is sent again and nothing is acknowledged, as with UDP.
//
// Without `reorders` a packet is dropped if it arrives after a packet that was sent later, as receivers do
// with sequence numbers. With `reorders` the packet that arrives last is used, whatever its number. Packets
// that arrive at the same time, to the last bit, count as arriving in the order in which they were sent.
//
// Neither call allocates once the buffer has room for the packets in transit, unless copies of a sample do.
template <class Sample>
class Channel {
 public:
  Channel(const ChannelSettings& settings, const NoiseKey& key, NoiseUse use)
      : reorders_(settings.reorders), fates_(settings, key, use) {}

  // Makes room for packets in transit, so that send() does not allocate while there are no more of them.
  void reserve(std::size_t packets) { in_transit_.reserve(packets); }

  // pre: time_s is finite and no smaller than in earlier calls of send() and receive().
  void send(double time_s, Sample sample) {
    const std::uint64_t number = counts_.sent++;
    const PacketFates::Fate fate = fates_.next();
    if (fate.is_lost) {
      ++counts_.lost;
      return;
    }
    in_transit_.push_back({time_s + fate.travel_s, number, std::move(sample)});
    std::push_heap(in_transit_.begin(), in_transit_.end(), arrives_after);
  }

  // Returns the sample that arrived last by time_s + kSameArrival_s. Returns nothing if none has arrived
  // since the last call, or if all that have were dropped. A sample that was sent at time_s without a delay
  // has arrived.
  std::optional<Sample> receive(double time_s) {
    std::optional<Sample> last;
    while (!in_transit_.empty() && in_transit_.front().arrives_s <= time_s + kSameArrival_s) {
      std::pop_heap(in_transit_.begin(), in_transit_.end(), arrives_after);
      Packet& packet = in_transit_.back();
      if (!reorders_ && packet.number < first_usable_) {
        ++counts_.overtaken;
      } else {
        if (last) ++counts_.replaced;
        last = std::move(packet.sample);
        first_usable_ = packet.number + 1;
      }
      in_transit_.pop_back();
    }
    if (last) ++counts_.received;
    return last;
  }

  const ChannelCounts& counts() const { return counts_; }

 private:
  struct Packet {
    double arrives_s;
    std::uint64_t number;
    Sample sample;
  };
  static bool arrives_after(const Packet& a, const Packet& b) {
    return a.arrives_s != b.arrives_s ? a.arrives_s > b.arrives_s : a.number > b.number;
  }

  const bool reorders_;
  PacketFates fates_;
  std::vector<Packet> in_transit_;  // a heap; the packet that arrives first is in front
  std::uint64_t first_usable_ = 0;  // packets below this number were overtaken
  ChannelCounts counts_;
};

// A perceptual dead-band. The threshold is max(weber_fraction |x^|, least). If both settings are 0, every
// sample is sent.
//
// A fraction suits forces and velocities. The magnitude of a position depends on the origin, so a signal of
// positions or poses needs weber_fraction 0 and a length as `least`.
struct DeadBandSettings {
  double weber_fraction = 0;
  double least = 0;  // unit of the signal
  bool predicts = false;
  double longest_silence_s = 0;
};

Parameters parameters(DeadBandSettings& s);
std::string validate(const DeadBandSettings& s);

// Returns the longest time between two packets, if none is lost: 0 if every sample is sent; nothing if there
// is no limit.
std::optional<double> longest_silence_s(const DeadBandSettings& s);

// The rest of a signal whose packets no longer arrive, such as a force that would otherwise act for ever.
struct HoldSettings {
  double hold_s = 0.05;
  double fade_s = 0.02;
};

Parameters parameters(HoldSettings& s);

// Returns the share of the value shown last that remains, overdue_s after the next packet was due. It is 1 up
// to hold_s, falls linearly to 0 within the next fade_s, and is then 0. Returns 1 if hold_s is 0, which means
// no limit.
double held_share(const HoldSettings& s, double overdue_s);

// The content of a packet. The receiver needs no other packet to show it, so a lost packet does not change
// how later ones are shown.
struct DeadBandSample {
  Vec3 value = Vec3::Zero();
  Vec3 slope_per_s = Vec3::Zero();  // zero unless the sender predicts
  double sent_s = 0;
  // The rest of a pose, world frame: its orientation, and its angular velocity in rad/s, which is zero unless
  // the sender predicts.
  Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
  Vec3 turn_per_s = Vec3::Zero();
};

// The value x^ that is shown for a sample, at a time after its arrival.
inline Vec3 shown_value(const DeadBandSample& sample, double age_s) {
  return sample.value + age_s * sample.slope_per_s;
}
// The orientation that is shown with it, a unit quaternion.
Eigen::Quaterniond shown_orientation(const DeadBandSample& sample, double age_s);

// Sends a sample x if |x - x^| > max(weber_fraction |x^|, least), where x^ is what a receiver would show now
// that got all packets without a delay (Hinterseer, Hirche, Chaudhuri, Steinbach and Buss 2008; for vectors
// the dead-band is a ball around x^). The first sample is always sent. With longest_silence_s, a sample is
// also sent if the last packet is at least as old. This bounds how long a loss has an effect.
//
// Without prediction x^ is the value sent last. With prediction x^ continues linearly, through the last two
// values sent. The sender computes the slope, and the packet carries it.
//
// A signal of poses has a reach: the largest distance of a point of the moving body from the origin of its
// frame. If the pose that is shown differs from x by the rotation angle a, reach_m a is added to the
// difference |x - x^|. So no point of the body is farther than the threshold from where it is shown. With a
// reach of 0 orientations are not compared.
class DeadBandSender {
 public:
  explicit DeadBandSender(const DeadBandSettings& settings, double reach_m = 0)
      : s_(settings), reach_m_(reach_m) {}

  // Returns the packet to be sent, or nothing. Must be called for every sample, in the order of time.
  // pre: the value is finite, the orientation is a unit quaternion.
  std::optional<DeadBandSample> send(
      const Vec3& value, double time_s,
      const Eigen::Quaterniond& orientation_W = Eigen::Quaterniond::Identity());

  // Return x^ at a time that is not before the last packet; nothing before the first packet.
  std::optional<Vec3> shown(double time_s) const;
  std::optional<Eigen::Quaterniond> shown_orientation(double time_s) const;

  std::uint64_t samples() const { return samples_; }  // number of calls of send()
  std::uint64_t packets() const { return packets_; }  // number of them that returned a packet

 private:
  bool must_send(const Vec3& value, const Eigen::Quaterniond& orientation_W, double time_s) const;

  const DeadBandSettings s_;
  const double reach_m_;
  std::optional<DeadBandSample> last_;
  std::uint64_t samples_ = 0, packets_ = 0;
};

// Shows the sample that was received last. With a slope it predicts from the arrival of the sample, not from
// the time when it was sent. After a constant delay it therefore shows x^ of the sender, delayed, and the
// dead-band bounds its error relative to the delayed signal. It does not extrapolate over the delay, which
// would amplify noise and is a method of its own.
class DeadBandReceiver {
 public:
  // pre: time_s is not smaller than in earlier calls.
  void receive(const DeadBandSample& sample, double time_s);

  // Return what is shown at a time that is not before the last arrival; nothing before the first.
  std::optional<Vec3> shown(double time_s) const;
  std::optional<Eigen::Quaterniond> shown_orientation(double time_s) const;
  // Returns the time since the last arrival. pre: there was one.
  double silence_s(double time_s) const { return time_s - arrived_s_; }

 private:
  std::optional<DeadBandSample> last_;
  double arrived_s_ = 0;
};

// A dead-band for frames: a frame is sent to the operator only if the surface near the slave has moved, or if
// values of its points have changed.
//
// This is the part of model-mediated teleoperation that decides about updates of the model: X. Xu, B.
// Cizmeci, A. Al-Nuaimi, E. Steinbach, "Point cloud-based model-mediated teleoperation with dynamic and
// perception-based model updating", IEEE Trans. Instrum. Meas. 63, 2014. Only its abstract was available; the
// rule is this project's. Stiffness and friction of the object are not estimated.

struct FrameDeadBandSettings {
  double least_motion_m = 0;
  double near_m = 0.04;
};

Parameters parameters(FrameDeadBandSettings& s);
inline std::string validate(const FrameDeadBandSettings&) {
  return {};
}

// Returns the largest motion of the surface near a position from one frame to another, m, not negative. A
// first plane is fitted to the points of `before` within R = near_m + r_f of near_W, where r_f is the largest
// radius of a forbidden region in the two frames; f is the foot of near_W on it. A plane is then fitted to
// the points of each frame within near_m of f. The result is the largest distance of the new plane, along the
// normal of the old one, from the disc of radius near_m on the old plane: |h| + near_m tan(a), with the
// height h of the new plane over the foot of f on the old one, and the angle a of the two planes. A point at
// the distance r from near_W has the weight (1 - (r / R)^2)^2, and one at the distance r from f has
// (1 - (r / near_m)^2)^2. Returns 0 if neither frame has 3 points there, and infinity if only one has, or if
// the planes are perpendicular. So a surface that stays farther than R from near_W does not count as moved.
double surface_motion_m(const NeighbourSearch& before, const NeighbourSearch& now, const Vec3& near_W,
                        double near_m, const Kernels& kernels);

class FrameDeadBand {
 public:
  explicit FrameDeadBand(const FrameDeadBandSettings& settings) : s_(settings) {}

  // Returns true if a frame has to be sent, and then keeps it as the newest that was sent. slave_W: position
  // of the slave, world frame, when the frame was captured; nothing if it is not known, because the slave had
  // not started or its positions were lost. The frame is sent if
  // - it is the first, or least_motion_m is 0;
  // - slave_W is not known;
  // - the surface near slave_W has moved by more than least_motion_m since the last frame that was sent;
  // - the radius of a region, the stiffness of a point or a guidance target differs from that frame. Points
  //   with the same index are compared, if both were measured. If the frames have different sizes, they
  //   differ unless all points of both have the same values.
  // If least_motion_m is above 0, a frame is never sent in two cases, because renderers drop it: if a frame
  // that was captured later has already come, sent or not; or if it was not captured after the last one that
  // was sent.
  bool sends(const Frame& frame, const std::optional<Vec3>& slave_W, const Kernels& kernels);
  // Returns the number of frames that had to be sent.
  int sent() const { return sent_; }

 private:
  // The radius of the region and the stiffness of every point, at its index; nothing: it is not measured.
  using PointValues = std::vector<std::optional<std::array<double, 2>>>;
  static PointValues values_of(const NeighbourSearch& points, const Kernels& kernels);
  static bool differ(const PointValues& before, const PointValues& now);

  const FrameDeadBandSettings s_;
  std::optional<Frame> last_;       // the newest frame that was sent
  std::optional<double> newest_s_;  // the latest time of capture of all frames
  PointValues last_values_;
  int sent_ = 0;
};

}  // namespace remote_touch
