#include "core/teleoperation/channel.h"

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

}  // namespace remote_touch
