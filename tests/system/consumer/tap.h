// A hand that taps the scene from above, once a second.
#pragma once

#include <core/parameters/parameter.h>
#include <runners/experiment/hand/trajectory.h>
#include <scenarios/simulated/scenario.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lab {

struct TapSettings {
  double high_m = 0.02, low_m = -0.002;
};

inline remote_touch::Parameters parameters(TapSettings& settings) {
  return {{"high_m", &settings.high_m, -1, 1, "highest position"},
          {"low_m", &settings.low_m, -1, 1, "lowest position"}};
}
inline std::string validate(const TapSettings& settings) {
  return settings.low_m < settings.high_m ? "" : "low_m: expected below high_m";
}

class Tap final : public remote_touch::Trajectory {
 public:
  using Settings = TapSettings;
  Tap(const Settings& settings, const remote_touch::Scenario&) : settings_(settings) {}
  double duration_s() const override { return 3; }
  remote_touch::DeviceState at(double time_s) const override {
    const double phase = std::cos(2 * std::numbers::pi * std::min(time_s, duration_s()));
    const double middle_m = 0.5 * (settings_.high_m + settings_.low_m);
    return {remote_touch::Vec3(0, middle_m + phase * (settings_.high_m - middle_m), 0)};
  }

 private:
  Settings settings_;
};

}  // namespace lab
