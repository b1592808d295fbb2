// A room with boxes in it, whose normals are known exactly, and of what kind each pixel is: for the error of
// normals in planes, at creases and at limbs apart.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/support/depth_scenes.h"

namespace remote_touch::benchmarks {

// A limb is where one surface hides another, a crease where two planes meet.
enum class PixelKind : std::uint8_t { plane, crease, limb, rim };
inline constexpr int kNearPixels = 6;  // distance of the last pixel that still counts as crease or limb
inline constexpr int kRimPixels = 16;  // width of the border of the image, whose pixels are not judged

struct TradeScene {
  scenes::DepthScene seen;
  std::vector<PixelKind> kinds;
};

TradeScene room_with_boxes();

}  // namespace remote_touch::benchmarks
