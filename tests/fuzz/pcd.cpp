// PCD files: ascii, binary, binary_compressed.
#include "scenarios/files/depth_images.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/scratch_file.h"

namespace remote_touch::fuzz::pcd {
namespace {

void read(std::string_view bytes) {
  const auto file = scratch_file("cloud.pcd", bytes);
  accepts(bytes, [&] {
    const PcdCloud image = read_pcd(file);
    const PointCloud& cloud = image.cloud;
    require(cloud.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
            "a cloud has its width times its height");
    require(cloud.y.size() == cloud.size() && cloud.z.size() == cloud.size(),
            "points have three coordinates");
    require(image.X_FC.matrix().allFinite(), "a camera has a place");
    require(cloud.colour.empty() || cloud.colour.size() == cloud.size(), "all points have a colour, or none");
  });
}

const Registered registered("pcd", read);

}  // namespace
}  // namespace remote_touch::fuzz::pcd
