// Pinhole camera, depth image, and the colour of a point, which the segmentation by colour of 7.3.2 uses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

// The value in the colour column of a cloud for a point whose colour is unknown.
inline constexpr std::uint32_t kNoColour = 0xFF000000;
// Returns the colour, 0xRRGGBB, in which a point is shown: a grey if its colour is unknown.
constexpr std::uint32_t shown_colour(std::uint32_t colour) {
  return colour == kNoColour ? 0x808080 : colour;
}

// Converts the bits of a 32-bit float, in which files and messages of clouds store 0xAARRGGBB, to 0xRRGGBB.
// The alpha value A is 0, or 255 where colours are opaque; many opaque colours are a NaN when they are read
// as a float. Another alpha value means that the float holds no colour, or is the NaN of a point without a
// colour: the result is kNoColour. 0xFFC00000 is kNoColour too, although it could be an opaque dark red: it
// is the NaN that an x86 processor computes, for example for 0.0 / 0.0.
std::uint32_t colour_of_float(std::uint32_t bits);

// The double cone (HSL). A grey has saturation 0 and no hue; its hue_deg is 0.
struct HueSaturationLightness {
  double hue_deg = 0;     // 0 red, 120 green, 240 blue; [0, 360)
  double saturation = 0;  // 0 to 1
  double lightness = 0;   // 0 black to 1 white
};

// rgb is 0xRRGGBB as the sensor reports it, without gamma correction or a colour profile.
HueSaturationLightness hue_saturation_lightness(std::uint32_t rgb);
// Returns the nearest colour with 8 bits per channel, 0xRRGGBB. pre: the values are in the ranges above; a
// hue of 360 is allowed and means 0.
std::uint32_t rgb(const HueSaturationLightness& colour);

// Pinhole camera and depth image. Camera frame C: x right, y down, z forward along the optical axis, metres;
// pixel (u, v) = (column, row), the centre of the first pixel is (0, 0).

// z_m[v * width + u] is the distance along the optical axis; NaN where the sensor measured nothing.
struct DepthImage {
  int width = 0;
  int height = 0;
  std::vector<double> z_m;
};

// Returns the point that pixel (u, v) sees at depth z_m: x = (u - cx) z / fx, y = (v - cy) z / fy.
Vec3 unproject(const CameraIntrinsics& camera, double u, double v, double z_m);

// Returns the image size as text, such as "640 x 480 pixels".
std::string size_text(const CameraIntrinsics& camera);

// Returns the organised cloud of a depth image, in the world frame. A pixel without a measurement becomes a
// NaN point, never the origin. Throws std::invalid_argument if the image does not have the camera's size, or
// another number of depths than pixels.
PointCloud cloud_from_depth(const DepthImage& depth, const CameraIntrinsics& camera,
                            const RigidTransform& X_WC);

}  // namespace remote_touch
