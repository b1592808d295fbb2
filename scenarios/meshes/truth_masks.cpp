#include "scenarios/meshes/truth_masks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/geometry/camera.h"
#include "core/geometry/colour.h"
#include "scenarios/recordings/images_and_clouds/depth_png.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxCached = 8;  // the number that RecordedScene keeps frames

// Returns the number in a name, if there is exactly one: 7 for mask_0007.png.
std::optional<std::size_t> number_in(const fs::path& file) {
  constexpr const char* kDigits = "0123456789";
  const std::string name = file.stem().string();
  const std::size_t first = name.find_first_of(kDigits);
  if (first == name.npos) return {};
  const std::size_t end = std::min(name.find_first_not_of(kDigits, first), name.size());
  if (name.find_first_of(kDigits, end) != name.npos) return {};
  std::size_t number = 0;
  const auto result = std::from_chars(name.data() + first, name.data() + end, number);
  return result.ec == std::errc() ? std::optional(number) : std::nullopt;
}

// Returns the mask of each frame, or an empty path.
std::vector<fs::path> masks_of_frames(const TruthFolder& truth, std::size_t frame_count) {
  std::vector<fs::path> masks = mask_files(truth);
  if (masks.size() == frame_count) return masks;
  if (masks.size() > frame_count)
    refuse(truth.masks, masks.size(), " masks for ", frame_count,
           " frames: expected one mask for each frame");
  std::vector<fs::path> of_frames(frame_count);
  for (const fs::path& mask : masks) {
    const std::optional<std::size_t> frame = number_in(mask);
    if (!frame || *frame >= frame_count)
      refuse(mask, "its name is not the number of a frame: expected 0 to ", frame_count - 1);
    if (!of_frames[*frame].empty())
      refuse(mask, "frame ", *frame, " has another mask, ", of_frames[*frame].string(), ": expected one");
    of_frames[*frame] = mask;
  }
  return of_frames;
}

}  // namespace

TruthMasks::TruthMasks(const TruthFolder& truth, std::size_t frame_count, const CameraIntrinsics& camera)
    : camera_(camera) {
  if (truth.masks.empty()) return;
  if (camera.pixels() == 0) refuse(truth.masks, "the frames are not images: expected no masks");
  files_ = masks_of_frames(truth, frame_count);
}

// The pixel is rounded as RecordedScene does for the measured surface.
bool TruthMasks::holds_at(std::size_t frame, const Vec3& p_C) const {
  if (files_.empty()) return true;
  if (!p_C.allFinite() || !(p_C.z() > 0) || files_[frame].empty()) return false;
  const double u = std::floor(camera_.fx * p_C.x() / p_C.z() + camera_.cx + 0.5);
  const double v = std::floor(camera_.fy * p_C.y() / p_C.z() + camera_.cy + 0.5);
  if (!(u >= 0 && v >= 0 && u < camera_.width && v < camera_.height)) return false;
  return mask_of(frame)[static_cast<std::size_t>(v) * camera_.width + static_cast<std::size_t>(u)];
}

const std::vector<bool>& TruthMasks::mask_of(std::size_t frame) const {
  const auto found =
      std::find_if(cache_.begin(), cache_.end(), [&](const Mask& mask) { return mask.frame == frame; });
  if (found != cache_.end()) {
    std::rotate(cache_.begin(), found, found + 1);
  } else {
    std::vector<bool> mask = read(frame);
    if (cache_.size() == kMaxCached) cache_.pop_back();
    cache_.insert(cache_.begin(), {frame, std::move(mask)});
  }
  return cache_.front().holds;
}

std::vector<bool> TruthMasks::read(std::size_t frame) const {
  const fs::path& file = files_[frame];
  int width = 0, height = 0;
  const std::vector<std::uint32_t> colours = read_colour_png(file, width, height);
  if (width != camera_.width || height != camera_.height)
    refuse(file, "has ", width, " x ", height, " pixels: expected ", size_text(camera_),
           ", as the camera has");
  std::vector<bool> holds(colours.size());
  for (std::size_t i = 0; i < colours.size(); ++i)
    holds[i] = colours[i] != kNoColour && (colours[i] & 0xFFFFFF) != 0;
  return holds;
}

}  // namespace remote_touch
