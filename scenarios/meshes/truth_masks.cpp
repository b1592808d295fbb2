#include "scenarios/meshes/truth_masks.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/geometry/camera.h"
#include "core/geometry/colour.h"
#include "scenarios/meshes/object_view.h"
#include "scenarios/recordings/images_and_clouds/depth_png.h"
#include "scenarios/text_files/file_order.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxCached = 8;  // the number that RecordedScene keeps frames

// Returns the masks of each frame.
std::vector<std::vector<fs::path>> masks_of_frames(const TruthFolder& truth,
                                                   const std::vector<std::string>& frames) {
  const std::map<std::vector<std::string>, std::size_t> frame_of = frames_by_numbers(truth.masks, frames);
  std::vector<std::vector<fs::path>> of_frames(frames.size());
  std::set<std::size_t> whole;  // frames with a mask of the whole image
  for (const fs::path& mask : mask_files(truth)) {
    std::vector<std::string> numbers = numbers_in_name(mask.stem().string());
    auto frame = frame_of.find(numbers);
    const bool is_whole = frame != frame_of.end();
    if (!is_whole && !numbers.empty()) {
      numbers.pop_back();
      frame = frame_of.find(numbers);
    }
    if (frame == frame_of.end())
      refuse(mask,
             "its name has the number of no frame: expected names with the numbers of the depth images, such "
             "as those of ",
             frames.front(), ", and perhaps the number of an object");
    std::vector<fs::path>& masks = of_frames[frame->second];
    if (is_whole ? !masks.empty() : whole.contains(frame->second))
      refuse(mask, "frame ", frame->second, " has another mask, ", masks.front().string(), ": expected one");
    if (is_whole) whole.insert(frame->second);
    masks.push_back(mask);
  }
  return of_frames;
}

}  // namespace

TruthMasks::TruthMasks(const TruthFolder& truth, const std::vector<std::string>& frames,
                       const CameraIntrinsics& camera)
    : camera_(camera) {
  if (truth.masks.empty()) return;
  if (camera.pixels() == 0) refuse(truth.masks, "the frames are not images: expected no masks");
  files_ = masks_of_frames(truth, frames);
}

bool TruthMasks::holds_at(std::size_t frame, const Vec3& p_C) const {
  if (files_.empty()) return true;
  const std::optional<std::size_t> pixel = pixel_of(camera_, p_C);
  return pixel && !files_[frame].empty() && mask_of(frame)[*pixel];
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
  std::vector<bool> holds(camera_.pixels(), false);
  for (const fs::path& file : files_[frame]) {
    int width = 0, height = 0;
    const std::vector<std::uint32_t> colours = read_colour_png(file, width, height);
    if (width != camera_.width || height != camera_.height)
      refuse(file, "has ", width, " x ", height, " pixels: expected ", size_text(camera_),
             ", as the camera has");
    for (std::size_t i = 0; i < colours.size(); ++i)
      if (colours[i] != kNoColour && (colours[i] & 0xFFFFFF) != 0) holds[i] = true;
  }
  return holds;
}

}  // namespace remote_touch
