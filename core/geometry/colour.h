// Hue, saturation and lightness of a colour: what colour segmentation uses, 7.3.2.
#pragma once

#include <cstdint>

namespace remote_touch {

// The value in the colour column of a cloud for a point whose colour is unknown.
inline constexpr std::uint32_t kNoColour = 0xFF000000;

// The colour in a float of 32 bits, by which files and messages of clouds pass on 0xAARRGGBB: with A = 0 or,
// where colours are opaque, 255, which makes a NaN of many of them. Other bits are a number that is no
// colour, or the NaN of a point without colour: kNoColour.
std::uint32_t colour_of_float(std::uint32_t bits);

// The double cone (HSL): a grey has saturation 0 and no hue, which is then given as 0.
struct HueSaturationLightness {
  double hue_deg = 0;     // 0 red, 120 green, 240 blue; [0, 360)
  double saturation = 0;  // 0 to 1
  double lightness = 0;   // 0 black to 1 white
};

// rgb = 0xRRGGBB, as the sensor gives it: no gamma or colour profile.
HueSaturationLightness hue_saturation_lightness(std::uint32_t rgb);
// The nearest colour of 8 bits a channel, 0xRRGGBB. pre: values in the ranges above; a hue of 360 counts as
// 0.
std::uint32_t rgb(const HueSaturationLightness& colour);

}  // namespace remote_touch
