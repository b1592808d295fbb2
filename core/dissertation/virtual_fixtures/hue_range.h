// A rule that selects points by their colour, 7.3.2: the hue marks objects to protect or to guide to.
#pragma once

#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rule.h"

namespace remote_touch {

class HueRange final : public FixtureRule {
 public:
  struct Settings {
    FixtureValues values;
    double from_deg = 340;
    double to_deg = 20;
    double min_saturation = 0.3;
    double min_lightness = 0.1;
    double max_lightness = 0.9;
  };
  explicit HueRange(const Settings& settings) : FixtureRule(settings.values), settings_(settings) {}
  // Throws InputError if the cloud has points but no colours.
  void require(const PointCloud& cloud) const override;
  std::vector<double> weights(const PointCloud& cloud) const override;
  const Settings& settings() const { return settings_; }

 private:
  bool contains(std::uint32_t rgb) const;

  const Settings settings_;
};

// A HueRange in the role forbidden, with its strength at one moment. A list of these, applied in order, gives
// the same columns of r_f and k_s as FixtureAssignment::assign().
struct HueStep {
  HueRange::Settings range;
  double strength = 1;
  double first_stiffness_N_per_m = 0;  // k_s from which the rule fades in at a point that has none
};
using HueSteps = std::vector<HueStep>;

Parameters parameters(HueRange::Settings& s);
std::string validate(const HueRange::Settings& s);

}  // namespace remote_touch
