#include "analysis/statistics/sinusoid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace remote_touch::sinusoid_test {
namespace {

constexpr double kHz = 1.5, kTurn_rad = 2 * std::numbers::pi;

struct Signal {
  std::vector<double> time_s, values;
};

// Two periods of 3 + amplitude * cos(2 pi f (t - lag)), and of a part with twice the frequency.
Signal signal(double amplitude, double lag_of_signal_s) {
  constexpr int kCount = 400;
  Signal s;
  for (int i = 0; i < kCount; ++i) {
    const double t = 0.7 + 2 / kHz * i / kCount;
    s.time_s.push_back(t);
    s.values.push_back(3 + amplitude * std::cos(kTurn_rad * kHz * (t - lag_of_signal_s)) +
                       0.5 * std::sin(2 * kTurn_rad * kHz * t));
  }
  return s;
}

Sinusoid part_of(const Signal& s) {
  return sinusoid_in(s.time_s, s.values, kHz);
}

TEST(Sinusoid, HasTheAmplitudeOfItsFrequencyAlone) {
  EXPECT_NEAR(part_of(signal(0.2, 0.1)).amplitude, 0.2, 1e-12);
  EXPECT_NEAR(part_of(signal(0, 0)).amplitude, 0, 1e-12);
}

TEST(Sinusoid, LagsByTheDelayOfItsSignal) {
  const Sinusoid first = part_of(signal(1, 0.05));
  EXPECT_NEAR(lag_s(first, part_of(signal(2, 0.13)), kHz), 0.08, 1e-12);
  EXPECT_NEAR(lag_s(part_of(signal(2, 0.13)), first, kHz), -0.08, 1e-12);
}

TEST(Sinusoid, LagIsLessThanHalfAPeriod) {
  const Sinusoid first = part_of(signal(1, 0));
  EXPECT_NEAR(lag_s(first, part_of(signal(1, 0.9 / kHz)), kHz), -0.1 / kHz, 1e-12);
}

TEST(Sinusoid, WithoutValuesIsNan) {
  EXPECT_TRUE(std::isnan(sinusoid_in({}, {}, kHz).amplitude));
}

}  // namespace
}  // namespace remote_touch::sinusoid_test
