// A smooth random motion of six degrees of freedom, for stress tests.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/parameters/parameter.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// Each coordinate of the position and of the rotation vector is a sum of three sines with incommensurable
// frequencies and random phases.
class RandomMotion final : public Trajectory {
 public:
  struct Settings {
    Vec3 centre_m = Vec3::Zero();
    Vec3 extent_m{0.05, 0.05, 0.05};
    double max_rotation_deg = 45;
    double speed_m_per_s = 0.1;
    std::uint64_t seed = 1;
    double duration_s = 10;
  };

  RandomMotion(const Settings& settings, const Scenario& scenario);
  DeviceState at(double time_s) const override;
  double duration_s() const override { return settings_.duration_s; }

 private:
  static constexpr int kSines = 3;
  double coordinate(int axis, double time_s) const;  // within -1 .. 1

  const Settings settings_;
  double rate_;                                        // rate of the first sine of x, rad/s
  std::array<std::array<double, kSines>, 6> phase_{};  // phases of the position, then of the rotation vector
};

Parameters parameters(RandomMotion::Settings& s);
std::string validate(const RandomMotion::Settings& s);

}  // namespace remote_touch
