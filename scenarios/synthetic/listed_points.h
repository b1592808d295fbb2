// A few points given in the settings, such as the single point of 5.3.1.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

class ListedPoints final : public Scenario {
 public:
  struct Settings {
    std::vector<double> points{0, 0, 0};  // rows of x, y, z in metres, world frame
    double frame_rate_hz = 30;
  };

  ListedPoints(const Settings& settings, const NoiseKey&, const Kernels&) : settings_(settings) {}

  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  int frame_count() const override { return 1; }
  PointCloud cloud(int frame) const override;
  // NaN: single points are no surface and have no sides.
  double signed_distance(const Vec3&, double) const override {
    return std::numeric_limits<double>::quiet_NaN();
  }

 private:
  const Settings settings_;
};

Parameters parameters(ListedPoints::Settings& s);
std::string validate(const ListedPoints::Settings& s);

}  // namespace remote_touch
