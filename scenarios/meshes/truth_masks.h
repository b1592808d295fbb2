// Masks of a recording's truth: the pixels at which the truth of a frame holds.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "core/geometry/vector.h"
#include "scenarios/meshes/truth_folder.h"

namespace remote_touch {

// A mask is a PNG file of up to 8 bits a channel and of the size of the camera's image. The truth holds at
// the pixels that are neither black nor fully transparent. Masks are read when they are first needed, and the
// last ones are kept, so that several threads must not use one object at the same time.
class TruthMasks {
 public:
  // frames: the names of the frames' depth images. A mask belongs to the frame whose name has the same
  // numbers, see numbers_in_name(): mask_0007.png to frame-000007.depth.png. It may have one more number,
  // that of an object: the truth holds where one of the masks of the frame holds. It holds nowhere in a frame
  // without a mask. Throws InputError about a mask whose frame is not clear, and about the folder if the
  // camera has no pixels. Without a folder of masks the truth holds everywhere.
  TruthMasks(const TruthFolder& truth, const std::vector<std::string>& frames,
             const CameraIntrinsics& camera);

  // Returns true if the truth holds at the pixel nearest to the projection of p_C (camera frame), and false
  // for positions outside the image or not in front of the camera. Pre: frame < frame_count. Throws
  // InputError if the mask of the frame cannot be read or does not have the size of the camera's image.
  bool holds_at(std::size_t frame, const Vec3& p_C) const;

 private:
  struct Mask {
    std::size_t frame;
    std::vector<bool> holds;  // pixel (u, v) is element v * width + u
  };
  const std::vector<bool>& mask_of(std::size_t frame) const;
  std::vector<bool> read(std::size_t frame) const;

  std::vector<std::vector<std::filesystem::path>> files_;  // the masks of each frame; empty: no masks
  CameraIntrinsics camera_;
  mutable std::vector<Mask> cache_;  // the masks that were used last, the newest in front
};

}  // namespace remote_touch
