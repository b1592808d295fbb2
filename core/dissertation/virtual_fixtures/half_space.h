// A rule that selects the points on one side of a plane, as in 5.3.2.
#pragma once

#include "core/dissertation/virtual_fixtures/fixture_rule.h"

namespace remote_touch {

class HalfSpace final : public FixtureRule {
 public:
  struct Settings {
    FixtureValues values;
    Vec3 point_m{0, 0, 0};
    Vec3 normal{1, 0, 0};
    double transition_m = 0;
  };
  explicit HalfSpace(const Settings& settings);
  // The plane itself belongs to the half-space. If transition_m is above 0, the weight rises linearly from 0
  // at the plane to 1 at that distance.
  std::vector<double> weights(const PointCloud& cloud) const override;

 private:
  Vec3 point_W_, normal_W_;
  double transition_m_;
};

Parameters parameters(HalfSpace::Settings& s);
std::string validate(const HalfSpace::Settings& s);

}  // namespace remote_touch
