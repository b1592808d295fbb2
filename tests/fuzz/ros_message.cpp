// Messages of ROS. The first byte selects the type, and ROS 1 or 2.
#include <cmath>

#include "scenarios/recordings/bag_file.h"
#include "scenarios/recordings/frames_from_messages.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::ros_message {
namespace {

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

void read(std::string_view bytes) {
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

const Registered registered("ros_message", read);

}  // namespace
}  // namespace remote_touch::fuzz::ros_message
