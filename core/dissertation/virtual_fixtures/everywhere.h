// A rule that selects every measured point of a frame, as in 5.3.3.
#pragma once

#include "core/dissertation/virtual_fixtures/fixture_rule.h"

namespace remote_touch {

class Everywhere final : public FixtureRule {
 public:
  struct Settings {
    FixtureValues values;
  };
  explicit Everywhere(const Settings& settings) : FixtureRule(settings.values) {}
  std::vector<double> weights(const PointCloud& cloud) const override;
};

Parameters parameters(Everywhere::Settings& s);
std::string validate(const Everywhere::Settings& s);

}  // namespace remote_touch
