// The channel: delays to the tick, statistics of loss and jitter, and a second implementation of reordering.
#include "core/teleoperation/channel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "runners/evaluation/contract/allocation_counter.h"

namespace remote_touch::channel_test {
namespace {

constexpr double kTick_s = 0.001;
constexpr auto kUse = NoiseUse::command_channel;

std::vector<PacketFates::Fate> fates_of(const ChannelSettings& s, int count, const NoiseKey& key = {},
                                        NoiseUse use = kUse) {
  PacketFates fates(s, key, use);
  std::vector<PacketFates::Fate> list;
  for (int n = 0; n < count; ++n) list.push_back(fates.next());
  return list;
}

std::vector<bool> losses_of(const ChannelSettings& s, int count, const NoiseKey& key = {},
                            NoiseUse use = kUse) {
  std::vector<bool> lost;
  for (const PacketFates::Fate& fate : fates_of(s, count, key, use)) lost.push_back(fate.is_lost);
  return lost;
}

TEST(ChannelSettings, RefusesBurstsThatAreTooShortForTheLoss) {
  for (const ChannelSettings& s : {ChannelSettings{}, ChannelSettings{.loss_probability = 1},
                                   ChannelSettings{.mean_burst_packets = 1000},
                                   ChannelSettings{.loss_probability = 0.5, .mean_burst_packets = 1.5},
                                   ChannelSettings{.loss_probability = 0.9, .mean_burst_packets = 9}})
    EXPECT_EQ(validate(s), "") << s.loss_probability;
  EXPECT_EQ(validate(ChannelSettings{.loss_probability = 0.8, .mean_burst_packets = 3}),
            "mean_burst_packets = 3.000000: expected 1, or at least 4.000000, for this loss_probability");
  EXPECT_EQ(validate(ChannelSettings{.loss_probability = 1, .mean_burst_packets = 1000}),
            "mean_burst_packets = 1000.000000: expected 1, for this loss_probability");
}

// The packet of tick k arrives at tick k + 37, also if the delay is a little less than 37 ticks, and with
// times that are sums of ticks.
TEST(Channel, DelaysToTheTick) {
  for (const double delay_s : {0.037, 0.0365, 0.036 + 2 * kSameArrival_s}) {
    Channel<int> channel({.delay_s = delay_s}, {}, kUse);
    double time_s = 0;
    for (int k = 0; k < 100000; ++k, time_s += kTick_s) {
      channel.send(time_s, k);
      ASSERT_EQ(channel.receive(time_s), k < 37 ? std::nullopt : std::optional(k - 37)) << k;
    }
    EXPECT_EQ(channel.counts().received, 100000u - 37u);
  }
}

double fraction(const std::vector<bool>& lost) {
  return static_cast<double>(std::count(lost.begin(), lost.end(), true)) / static_cast<double>(lost.size());
}

struct Bursts {
  double count = 0, packets = 0, of_one = 0;
};

Bursts bursts_of(const std::vector<bool>& lost) {
  Bursts bursts;
  int length = 0;
  for (const bool is_lost : lost) {
    if (is_lost) {
      ++length;
      continue;
    }
    if (length > 0) bursts.count += 1, bursts.packets += length, bursts.of_one += length == 1 ? 1 : 0;
    length = 0;
  }
  return bursts;
}

constexpr int kMany = 400000;
constexpr double kSigmas = 5;  // a chance of 6e-7 per comparison; the numbers are the same in every run

// The variance of the lost fraction is that of a chain whose correlation falls by lambda per packet. Packets
// that are lost one by one come in bursts of 1 / (1 - p), and lambda is 0.
TEST(PacketFates, LosesAsManyAsItShouldInBursts) {
  for (const double p : {0.01, 0.1, 0.5})
    for (const double setting : {1.0, 2.0, 5.0, 20.0}) {
      SCOPED_TRACE(testing::Message() << p << " in bursts of " << setting);
      const double mean = setting == 1 ? 1 / (1 - p) : setting;
      const std::vector<bool> lost = losses_of({.loss_probability = p, .mean_burst_packets = setting}, kMany);
      const double lambda = 1 - 1 / mean - p / (mean * (1 - p));
      EXPECT_NEAR(fraction(lost), p, kSigmas * std::sqrt(p * (1 - p) / kMany * (1 + lambda) / (1 - lambda)));
      const Bursts bursts = bursts_of(lost);
      ASSERT_GT(bursts.count, 100);
      EXPECT_NEAR(bursts.packets / bursts.count, mean, kSigmas * std::sqrt(mean * (mean - 1) / bursts.count));
      const double of_one = 1 / mean;  // a geometric length
      EXPECT_NEAR(bursts.of_one / bursts.count, of_one,
                  kSigmas * std::sqrt(of_one * (1 - of_one) / bursts.count));
    }
  EXPECT_EQ(fraction(losses_of({}, 1000)), 0);
  EXPECT_EQ(fraction(losses_of({.loss_probability = 1}, 1000)), 1);
  EXPECT_EQ(losses_of({.loss_probability = 0.5, .mean_burst_packets = 2}, kMany),
            losses_of({.loss_probability = 0.5}, kMany));
}

TEST(PacketFates, AlternatesWhereTheBurstsAreAsShortAsPossible) {
  const std::vector<bool> lost = losses_of({.loss_probability = 0.6, .mean_burst_packets = 1.5}, kMany);
  EXPECT_NEAR(fraction(lost), 0.6, 1e-2);
  for (int n = 1; n < kMany; ++n) ASSERT_TRUE(lost[n] || lost[n - 1]) << "every burst ends with one packet";
}

// The first packet is lost as often as any other: the chain starts in its stationary state.
TEST(PacketFates, LosesTheFirstPacketAsOftenAsOthers) {
  constexpr int kRuns = 20000;
  constexpr double kLoss = 0.2;
  std::vector<bool> first, tenth;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const std::vector<bool> lost =
        losses_of({.loss_probability = kLoss, .mean_burst_packets = 10}, 10, {1, 0, run});
    first.push_back(lost.front()), tenth.push_back(lost.back());
  }
  const double interval = kSigmas * std::sqrt(kLoss * (1 - kLoss) / kRuns);
  EXPECT_NEAR(fraction(first), kLoss, interval);
  EXPECT_NEAR(fraction(tenth), kLoss, interval);
}

// The time is independent of the packet before, and of the losses.
TEST(PacketFates, TravelsForAUniformTime) {
  std::vector<double> late;
  double product = 0, arrived_late = 0, arrived = 0;
  for (const PacketFates::Fate& fate :
       fates_of({.delay_s = 0.05, .jitter_s = 0.02, .loss_probability = 0.5}, kMany)) {
    const double u = (fate.travel_s - 0.05) / 0.02;
    product += late.empty() ? 0 : (u - 0.5) * (late.back() - 0.5) / kMany;
    if (!fate.is_lost) arrived_late += u, arrived += 1;
    late.push_back(u);
  }
  EXPECT_NEAR(product, 0, kSigmas / (12 * std::sqrt(1.0 * kMany))) << "of neighbours";
  EXPECT_NEAR(arrived_late / arrived, 0.5, kSigmas / std::sqrt(12 * arrived)) << "of packets that arrive";
  std::sort(late.begin(), late.end());
  EXPECT_GT(late.front(), -1e-12);
  EXPECT_LT(late.back(), 1 + 1e-12);
  double distance = 0;  // Kolmogorov-Smirnov; 2.5 / sqrt(n) has a chance of 7e-6
  for (int n = 0; n < kMany; ++n) distance = std::max(distance, std::abs(late[n] - (n + 0.5) / kMany));
  EXPECT_LT(distance, 2.5 / std::sqrt(1.0 * kMany));
}

TEST(PacketFates, BelongsToTheKeyTheUseAndTheNumber) {
  const ChannelSettings s{.loss_probability = 0.5};
  const std::vector<bool> lost = losses_of(s, 1000, {1, 2, 3});
  EXPECT_EQ(losses_of(s, 1000, {1, 2, 3}), lost);
  const std::vector<std::vector<bool>> others{losses_of(s, 1000, {2, 2, 3}), losses_of(s, 1000, {1, 3, 3}),
                                              losses_of(s, 1000, {1, 2, 4}),
                                              losses_of(s, 1000, {1, 2, 3}, NoiseUse::force_channel)};
  for (const std::vector<bool>& other : others) {
    int equal = 0;
    for (int n = 0; n < 1000; ++n) equal += lost[n] == other[n] ? 1 : 0;
    EXPECT_NEAR(equal, 500, kSigmas * std::sqrt(250.0));
  }
}

TEST(PacketFates, SharesItsNoiseBetweenSettings) {
  const auto few = fates_of({.jitter_s = 1, .loss_probability = 0.1}, 10000),
             many = fates_of({.delay_s = 1, .jitter_s = 2, .loss_probability = 0.3}, 10000),
             bursts = fates_of({.jitter_s = 1, .loss_probability = 0.1, .mean_burst_packets = 9}, 10000);
  for (int n = 0; n < 10000; ++n) {
    ASSERT_TRUE(!few[n].is_lost || many[n].is_lost) << "lost packets stay lost";
    ASSERT_NEAR(many[n].travel_s, 1 + 2 * few[n].travel_s, 1e-15);
    ASSERT_EQ(bursts[n].travel_s, few[n].travel_s);
  }
}

struct Outcome {
  std::vector<int> received;  // -1: nothing
  ChannelCounts counts;
};

Outcome run_channel(const ChannelSettings& s, int ticks, const NoiseKey& key) {
  Channel<int> channel(s, key, kUse);
  Outcome outcome;
  for (int k = 0; k < ticks; ++k) {
    channel.send(k * kTick_s, k);
    outcome.received.push_back(channel.receive(k * kTick_s).value_or(-1));
  }
  outcome.received.push_back(channel.receive(1e9).value_or(-1));
  outcome.counts = channel.counts();
  return outcome;
}

// The same from the list of all packets, with the definitions of the header.
Outcome run_list(const ChannelSettings& s, int ticks, const NoiseKey& key) {
  const auto fates = fates_of(s, ticks, key);
  struct Arrival {
    double time_s;
    int number;
    bool is_dropped;
  };
  std::vector<Arrival> arrivals;
  Outcome outcome;
  outcome.counts.sent = static_cast<std::uint64_t>(ticks);
  for (int n = 0; n < ticks; ++n) {
    if (fates[n].is_lost)
      ++outcome.counts.lost;
    else
      arrivals.push_back({n * kTick_s + fates[n].travel_s, n, false});
  }
  for (Arrival& a : arrivals)
    a.is_dropped = !s.reorders && std::any_of(arrivals.begin(), arrivals.end(), [&](const Arrival& b) {
      return b.number > a.number && b.time_s < a.time_s;
    });
  for (int k = 0; k <= ticks; ++k) {
    const double after_s = k == 0 ? -1 : (k - 1) * kTick_s + kSameArrival_s;
    const double until_s = k == ticks ? 1e9 : k * kTick_s + kSameArrival_s;
    const Arrival* last = nullptr;
    for (const Arrival& a : arrivals) {
      if (a.time_s <= after_s || a.time_s > until_s) continue;
      if (a.is_dropped) {
        ++outcome.counts.overtaken;
        continue;
      }
      if (last) ++outcome.counts.replaced;
      if (!last || a.time_s >= last->time_s) last = &a;
    }
    outcome.received.push_back(last ? last->number : -1);
    outcome.counts.received += last ? 1 : 0;
  }
  return outcome;
}

TEST(Channel, AgreesWithAListOfAllPackets) {
  constexpr int kTicks = 1000;
  for (const bool reorders : {false, true})
    for (const double jitter_s : {0.0, 0.0003, 0.002, 0.03})
      for (const double burst : {1.0, 4.0}) {
        const ChannelSettings s{burst == 1 ? 0 : 0.01, jitter_s, 0.1, burst, reorders};
        const Outcome got = run_channel(s, kTicks, {5, 6, 7}), want = run_list(s, kTicks, {5, 6, 7});
        EXPECT_EQ(got.received, want.received) << reorders << " " << jitter_s;
        EXPECT_EQ(got.counts.lost, want.counts.lost);
        EXPECT_EQ(got.counts.overtaken, want.counts.overtaken);
        EXPECT_EQ(got.counts.replaced, want.counts.replaced);
        EXPECT_EQ(got.counts.received, want.counts.received);
        EXPECT_EQ(got.counts.sent,
                  got.counts.lost + got.counts.overtaken + got.counts.replaced + got.counts.received);
      }
}

TEST(Channel, ReceivesTheSameHoweverOftenItIsAsked) {
  const ChannelSettings s{0.005, 0.004, 0.2, 3, false};
  Channel<int> seldom(s, {}, kUse), often(s, {}, kUse);
  for (int k = 0; k < 5000; ++k) {
    seldom.send(k * kTick_s, k), often.send(k * kTick_s, k);
    if (k % 10 != 9) {
      often.receive(k * kTick_s);
      continue;
    }
    const std::optional<int> a = seldom.receive(k * kTick_s), b = often.receive(k * kTick_s);
    EXPECT_TRUE(!b || a == b) << k;
  }
  EXPECT_EQ(seldom.counts().lost, often.counts().lost);
  EXPECT_EQ(seldom.counts().overtaken, often.counts().overtaken);
}

TEST(Channel, AllocatesNothingWithinItsReserveAndOnceItsBufferHasGrown) {
  Channel<int> reserved({1, 0, 0, 1, false}, {}, kUse), grown({0.05, 0.05, 0.1, 5, false}, {}, kUse);
  const auto run = [&](Channel<int>& channel, int begin, int end) {
    for (int k = begin; k < end; ++k) {
      channel.send(k * kTick_s, k);
      channel.receive(k * kTick_s);
    }
  };
  reserved.reserve(1002);
  run(grown, 0, 1000);
  const std::size_t before = allocation_count();
  run(reserved, 0, 3000);
  run(grown, 1000, 20000);
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace remote_touch::channel_test
