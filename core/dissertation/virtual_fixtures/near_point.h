// A rule that selects the points around a centre: a position in the world, or the point that a pixel has in
// each frame.
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
  // Throws InputError if a pixel is set and the cloud is not an image that contains it.
  void require(const PointCloud& cloud) const override;
  // The weight is 1 up to inner_radius_m from the centre, and then falls linearly to 0 over falloff_m. If the
  // selected pixel has no depth, the nearest pixel (in the image) that has one replaces it. If no pixel has a
  // depth, all weights are 0.
  std::vector<double> weights(const PointCloud& cloud) const override;

 private:
  Vec3 picked(const PointCloud& cloud) const;

  const Settings settings_;
};

Parameters parameters(NearPoint::Settings& s);
std::string validate(const NearPoint::Settings& s);

}  // namespace remote_touch
