// Recordings in folders of images: the file camera.json, and the files depth.txt and rgb.txt of the layout of
// the TUM benchmark, separated by a line "---".
#include "scenarios/recordings/recording.h"

#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/scratch_file.h"

namespace remote_touch::fuzz::recordings {
namespace {

void read_camera(std::string_view bytes) {
  static const auto image = scratch_file("camera/depth/0.png", "");
  const auto folder = scratch_file("camera/camera.json", bytes).parent_path();
  accepts(bytes, [&] {
    const RecordingIndex index = index_recording(folder);
    require(index.camera.width > 0 && index.camera.height > 0 && index.camera.fx > 0 &&
                index.metres_per_unit > 0 && index.frame_rate_hz > 0,
            "a camera has pixels, a focal length and a rate");
    require(index.frames.size() == 1 && index.frames[0].depth == image, "the image is found");
  });
}

void read_lists(std::string_view bytes) {
  static const auto image = scratch_file("tum/a.png", "");
  const auto [depth, colour] = two_parts(bytes);
  scratch_file("tum/rgb.txt", colour);
  const auto folder = scratch_file("tum/depth.txt", depth).parent_path();
  accepts(bytes, [&] {
    const RecordingIndex index = index_recording(folder);
    for (std::size_t i = 1; i < index.frames.size(); ++i)
      require(index.frames[i].captured_s >= index.frames[i - 1].captured_s, "frames are in order");
    require(index.frame_rate_hz > 0, "a recording has a rate");
  });
}

const Registered of_camera("camera_file", read_camera);
const Registered of_lists("tum_lists", read_lists);

}  // namespace
}  // namespace remote_touch::fuzz::recordings
