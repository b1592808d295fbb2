// The points of a frame around a patch, in the patch's coordinates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/gathered_points.h"
#include "core/tracked_sheet/patch_region.h"

namespace remote_touch {

// Columns are allocated by reserve() alone.
struct PatchPoints {
  std::vector<PatchPlace> place;
  std::vector<std::uint32_t> source;  // of each place, its row in the gathered points
  std::vector<std::uint8_t> member;   // of the sheet
  std::vector<double> residual;       // height above what the map predicts; NaN where it predicts nothing

  void reserve(std::size_t points) {
    place.reserve(points), source.reserve(points), member.reserve(points), residual.reserve(points);
  }
  std::size_t size() const { return place.size(); }
  // Those of the region; no members yet.
  void take(const GatheredPoints& gathered, const PatchRegion& region);
};

}  // namespace remote_touch
