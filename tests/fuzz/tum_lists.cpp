// The files depth.txt and rgb.txt of a recording in the layout of the TUM benchmark, separated by a line
// "---".
#include "scenarios/recordings/recording.h"
#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/scratch_file.h"

namespace remote_touch::fuzz::tum_lists {
namespace {

void read(std::string_view bytes) {
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

const Registered registered("tum_lists", read);

}  // namespace
}  // namespace remote_touch::fuzz::tum_lists
