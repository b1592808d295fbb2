// A channel with delay, jitter and loss, through which the two sides of a teleoperation send samples.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/noise.h"

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

}  // namespace remote_touch
