// A room with boxes, whose normals are known exactly, and the kind of each pixel. The error of normals is
// found separately in planes, at creases and at limbs.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/support/depth_scenes.h"

namespace remote_touch::benchmarks {

// A limb is the edge of a surface that hides another. A crease is the line at which two planes meet.
enum class PixelKind : std::uint8_t { plane, crease, limb, rim };
inline constexpr int kNearPixels = 6;  // distance of the last pixel that still counts as crease or limb
inline constexpr int kRimPixels = 16;  // width of the border of the image, whose pixels are not judged

struct TradeScene {
  scenes::DepthScene seen;
  std::vector<PixelKind> kinds;
};

TradeScene room_with_boxes();

}  // namespace remote_touch::benchmarks
