// The points near a given position in the world, or near the point that a pixel sees in each frame.
#pragma once

#include "core/virtual_fixtures/fixture_rule.h"

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
  // 1 up to inner_radius_m, then falling evenly to 0 over falloff_m. A picked pixel that saw nothing is
  // replaced by the nearest one, in pixels, that did; where none did nothing is picked. Throws InputError for
  // a pixel of a cloud that is no image, or outside it.
  std::vector<double> weights(const PointCloud& cloud) const override;

 private:
  Vec3 picked(const PointCloud& cloud) const;

  const Settings settings_;
};

Parameters parameters(NearPoint::Settings& s);
std::string validate(const NearPoint::Settings& s);

}  // namespace remote_touch
