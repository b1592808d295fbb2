// A few points given in the settings, such as the single point of 5.3.1.
#pragma once

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

  ListedPoints(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  int frame_count() const override { return 1; }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override;
  PointCloud cloud(int frame) const override;
  // To the nearest point: points have no other side.
  double signed_distance(const Vec3& p_W, double time_s) const override;

 private:
  const Settings settings_;
};

Parameters parameters(ListedPoints::Settings& s);
std::string validate(const ListedPoints::Settings& s);

}  // namespace remote_touch
