// Clouds and images in files.
#include "scenarios/files/depth_images.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::images {
namespace {

// PNG files, read as a depth image and as a colour image, and depth images in NumPy files.

void require_depths(const DepthImage& depth) {
  require(depth.z_m.size() == static_cast<std::size_t>(depth.width) * static_cast<std::size_t>(depth.height),
          "every pixel has a depth");
  for (const double z_m : depth.z_m) require(!(z_m <= 0 || z_m > 4), "a depth is in range or NaN");
}

void read_npy(std::string_view bytes) {
  const auto file = scratch_file("image.npy", bytes);
  accepts(bytes, [&] { require_depths(read_depth_npy(file, 0.001, 4)); });
}

void read_png(std::string_view bytes) {
  const auto file = scratch_file("image.png", bytes);
  accepts(bytes, [&] { require_depths(read_depth_png(file, 0.001, 4)); });
  accepts(bytes, [&] {
    int width = 0, height = 0;
    const auto colour = read_colour_png(file, width, height);
    require(colour.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
            "every pixel has a colour");
  });
}

const Registered npy("npy", read_npy), png("png", read_png);

// PCD files: ascii, binary, binary_compressed.

void read_cloud(std::string_view bytes) {
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

const Registered of_pcd("pcd", read_cloud);

}  // namespace
}  // namespace remote_touch::fuzz::images
