// Recordings: bags, messages of ROS, and folders of images.
#include <algorithm>
#include <cmath>

#include "scenarios/recordings/bag_file.h"
#include "scenarios/recordings/frames_from_messages.h"
#include "scenarios/recordings/recording.h"
#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::recordings {
namespace {

// Bags of each kind: a file is opened, and its content read as the program does.

// name: of the file, with the ending of its kind.
void read_bag(const std::string& name, std::string_view bytes) {
  // Zeros compress to almost nothing. Such a message is read, but its cloud takes more than 1 s with
  // sanitizers.
  constexpr std::size_t kMaxMessages = 100, kMaxDecoded = 100'000;
  std::size_t longest = 0;
  const auto file = scratch_file(name, bytes);
  accepts(bytes, [&] {
    const auto bag = open_bag(file, [](const BagTopic&) { return true; });
    for (std::size_t t = 0; t < bag->topics().size(); ++t) {
      const auto& places = bag->places(t);
      require(std::is_sorted(places.begin(), places.end(),
                             [](const auto& a, const auto& b) { return a.logged_ns < b.logged_ns; }),
              "messages are in the order of their times");
      for (std::size_t i = 0; i < std::min(places.size(), kMaxMessages); ++i) {
        const std::string start = bag->start(places[i], 16), whole = bag->message(places[i]);
        longest = std::max({longest, whole.size(), places.size() > kMaxMessages ? kMaxDecoded + 1 : 0});
        require(start == whole.substr(0, 16), "the start of a message is that of the message");
      }
    }
  });
  if (longest > kMaxDecoded) return;
  accepts(bytes, [&] {
    BagChoice choice;
    choice.frame_id = bytes.size() % 2 == 0 ? "" : "base";
    const BagFrames frames(file, choice);
    for (std::size_t i = 0; i < std::min<std::size_t>(frames.captured_s().size(), 5); ++i) {
      const PointCloud cloud = frames.cloud(i, 4);
      for (const double z_m : cloud.z) require(!(z_m > 4), "a depth is in range or NaN");
    }
  });
}

const Registered of_sqlite("db3", [](std::string_view bytes) { read_bag("bag.db3", bytes); });
const Registered of_mcap("mcap", [](std::string_view bytes) { read_bag("bag.mcap", bytes); });
const Registered of_ros1("ros1_bag", [](std::string_view bytes) { read_bag("bag.bag", bytes); });

// Messages of ROS. The first byte selects the type, and ROS 1 or 2.

constexpr double kMax_m = 4;

void check_depth(const DepthImage& depth) {
  require(depth.z_m.size() == static_cast<std::size_t>(depth.width) * static_cast<std::size_t>(depth.height),
          "every pixel has a depth");
  for (const double z_m : depth.z_m) require(!(z_m <= 0 || z_m > kMax_m), "a depth is in range or NaN");
}

void check_rays(const MessageCursor& cursor, bool rectified) {
  const CameraInfoMessage info = read_camera_info(cursor);
  constexpr std::uint64_t kMaxPixels = 100'000;  // more pixels take more than 1 s with sanitizers
  if (std::uint64_t{info.width} * info.height > kMaxPixels) return;
  const ImageRays rays(info, rectified, "m");
  const CameraIntrinsics& camera = rays.camera();
  const std::size_t pixels = camera.pixels();
  const PointCloud cloud = rays.cloud({camera.width, camera.height, std::vector<double>(pixels, 1.0)});
  require(cloud.size() == pixels, "every pixel has a point or none");
  for (std::size_t i = 0; i < pixels; ++i)
    require(std::isnan(cloud.z[i]) || std::isfinite(cloud.x[i] + cloud.y[i]), "a ray is finite");
}

void read_ros_message(std::string_view bytes) {
  if (bytes.empty()) return;
  const unsigned kind = static_cast<unsigned char>(bytes[0]);
  accepts(bytes, [&] {
    const MessageCursor cursor(bytes.substr(1), kind & 1 ? WireFormat::ros1 : WireFormat::cdr, "m");
    switch (kind / 2 % 6) {
      case 0: {
        const PointCloudMessage message = read_point_cloud(cursor);
        const PointCloud cloud = cloud_from_message(message, "m");
        require(cloud.size() == std::size_t{message.width} * message.height, "every point is there");
        require(cloud.colour.empty() || cloud.colour.size() == cloud.size(),
                "all points have a colour, or none");
        break;
      }
      case 1:
        check_depth(depth_from_message(read_image(cursor), {}, kMax_m, "m"));
        break;
      case 2:
        check_depth(depth_from_message(read_compressed_image(cursor), {}, kMax_m, "m"));
        break;
      case 3:
        check_rays(cursor, kind & 128);
        break;
      case 4: {
        StaticTransforms transforms;
        transforms.add(read_transforms(cursor));
        require(transforms.between("base", "optical", "m").matrix().allFinite(), "a transform is finite");
        break;
      }
      default:
        read_float32(cursor);
    }
  });
}

const Registered of_ros_message("ros_message", read_ros_message);

// Recordings in folders of images: the file camera.json, and the files depth.txt and rgb.txt of the layout of
// the TUM benchmark, separated by a line "---".

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
