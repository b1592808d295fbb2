#include "core/dissertation/virtual_fixtures/hue_range.h"

#include "core/geometry/colour.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

Parameters parameters(HueRange::Settings& s) {
  const Parameters own = {
      {"from_deg", &s.from_deg, 0, 360, "first hue: 0 red, 120 green, 240 blue"},
      {"to_deg", &s.to_deg, 0, 360, "last hue; below from_deg the range goes through 0"},
      {"min_saturation", &s.min_saturation, 0, 1, "minimum saturation; grey points have no hue"},
      {"min_lightness", &s.min_lightness, 0, 1, "minimum lightness; the hue of dark points is noise"},
      {"max_lightness", &s.max_lightness, 0, 1, "maximum lightness"},
  };
  return appended(parameters(s.values), own);
}

std::string validate(const HueRange::Settings& s) {
  if (s.min_lightness > s.max_lightness)
    return "min_lightness = " + std::to_string(s.min_lightness) +
           ": expected up to max_lightness = " + std::to_string(s.max_lightness);
  return validate(s.values);
}

bool HueRange::contains(std::uint32_t rgb) const {
  if (rgb == kNoColour) return false;
  const HueSaturationLightness colour = hue_saturation_lightness(rgb);
  if (colour.saturation < settings_.min_saturation || colour.lightness < settings_.min_lightness ||
      colour.lightness > settings_.max_lightness)
    return false;
  const bool above = colour.hue_deg >= settings_.from_deg, below = colour.hue_deg <= settings_.to_deg;
  return settings_.from_deg <= settings_.to_deg ? above && below : above || below;
}

void HueRange::require(const PointCloud& cloud) const {
  if (cloud.colour.empty() && cloud.size() > 0)
    throw InputError("hue-range", "the frame has no colours: expected coloured frames");
}

std::vector<double> HueRange::weights(const PointCloud& cloud) const {
  require(cloud);
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    weights[i] = cloud.point(i).allFinite() && contains(cloud.colour[i]) ? 1 : 0;
  return weights;
}

}  // namespace remote_touch
