// The file camera.json of a folder of depth images.
#include "scenarios/recordings/recording.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/scratch_file.h"

namespace remote_touch::fuzz::camera_file {
namespace {

void read(std::string_view bytes) {
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

const Registered registered("camera_file", read);

}  // namespace
}  // namespace remote_touch::fuzz::camera_file
