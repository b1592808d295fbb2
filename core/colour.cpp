#include "core/colour.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

HueSaturationLightness hue_saturation_lightness(std::uint32_t rgb) {
  const int red = rgb >> 16 & 0xFF, green = rgb >> 8 & 0xFF, blue = rgb & 0xFF;
  const int high = std::max({red, green, blue}), low = std::min({red, green, blue});
  const double chroma = high - low, sum = high + low;
  HueSaturationLightness colour;
  colour.lightness = sum / 510;
  if (high == low) return colour;
  colour.saturation = chroma / (255 - std::abs(sum - 255));
  double sixth = 0;
  if (high == red)
    sixth = (green - blue) / chroma + (green < blue ? 6 : 0);
  else if (high == green)
    sixth = (blue - red) / chroma + 2;
  else
    sixth = (red - green) / chroma + 4;
  colour.hue_deg = 60 * sixth;
  return colour;
}

}  // namespace remote_touch
