// The points around a selected one: a position in the world, or the point of a pixel in each frame.
#pragma once

#include "core/dissertation/virtual_fixtures/fixture_rule.h"

namespace remote_touch {

class NearPoint final : public FixtureRule {
 public:
  struct Settings {
    FixtureValues values;
    Vec3 point_m{0, 0, 0};
    int row = -1;
    int column = -1;
    double inner_radius_m = 0.05;
    double falloff_m = 0;
  };
  explicit NearPoint(const Settings& settings) : FixtureRule(settings.values), settings_(settings) {}
  // If a pixel is set, the cloud must be an image that contains it.
  void require(const PointCloud& cloud) const override;
  // The weight is 1 up to inner_radius_m, then falls linearly to 0 over falloff_m. A selected pixel without a
  // depth is replaced by the nearest one, in pixels, that has a depth. If there is none, all weights are 0.
  std::vector<double> weights(const PointCloud& cloud) const override;

 private:
  Vec3 picked(const PointCloud& cloud) const;

  const Settings settings_;
};

Parameters parameters(NearPoint::Settings& s);
std::string validate(const NearPoint::Settings& s);

}  // namespace remote_touch
