// Tests which points a mask selects, and which masks and frames the rule refuses.
#include "scenarios/recordings/image_mask.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::image_mask_test {
namespace {

namespace fs = std::filesystem;
using Shares = std::vector<double>;

PointCloud image(int width, int height) {
  PointCloud cloud;
  cloud.image = ImageLayout{{width, height, 10, 10, 0, 0}, RigidTransform::Identity(), 0};
  for (int i = 0; i < width * height; ++i) cloud.append({0.1 * i, 0, 1});
  return cloud;
}

ImageMask::Settings settings(const fs::path& file) {
  ImageMask::Settings settings;
  settings.path = file.string();
  return settings;
}

class ImageMasks : public testing::Test {
 protected:
  Shares weights(const fs::path& file, const PointCloud& cloud) const {
    return ImageMask(settings(file)).weights(cloud);
  }
  fs::path grey(const std::vector<std::uint8_t>& samples, int width) const {
    const int height = static_cast<int>(samples.size()) / width;
    return folder_.write_png("grey.png", width, height, PNG_FORMAT_GRAY, samples.data());
  }

  const TestFolder folder_{"image_mask_test"};
};

TEST_F(ImageMasks, SelectPixelsThatAreNotBlackRowByRow) {
  EXPECT_EQ(weights(grey({0, 255, 0, 1, 0, 128}, 3), image(3, 2)), (Shares{0, 1, 0, 1, 0, 1}));
  EXPECT_EQ(weights(grey({0, 255, 0, 1, 0, 128}, 2), image(2, 3)), (Shares{0, 1, 0, 1, 0, 1}));
}

TEST_F(ImageMasks, MayHaveColours) {
  const std::uint8_t rgb[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_EQ(weights(folder_.write_png("rgb.png", 2, 2, PNG_FORMAT_RGB, rgb), image(2, 2)),
            (Shares{0, 1, 1, 1}));
}

// A fully transparent pixel selects nothing. A partly transparent one selects by its colour, like an opaque
// one.
TEST_F(ImageMasks, SelectNothingWhereAPixelIsTransparent) {
  const std::uint8_t rgba[12] = {0, 0, 0, 255, 9, 0, 0, 0, 9, 0, 0, 1};
  EXPECT_EQ(weights(folder_.write_png("rgba.png", 3, 1, PNG_FORMAT_RGBA, rgba), image(3, 1)),
            (Shares{0, 0, 1}));
}

TEST_F(ImageMasks, PickNothingThatWasNotMeasured) {
  PointCloud cloud = image(2, 1);
  cloud.x[0] = cloud.y[0] = cloud.z[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(weights(grey({255, 255}, 2), cloud), (Shares{0, 1}));
}

TEST_F(ImageMasks, AnotherSizeIsRefused) {
  const fs::path file = grey({0, 1, 2, 3, 4, 5}, 3);
  for (const std::pair<int, int>& size : {std::pair{2, 3}, {6, 1}, {3, 3}, {4, 2}}) {
    const std::string why = refusal([&] { weights(file, image(size.first, size.second)); });
    EXPECT_EQ(why, file.string() + ": 3 x 2 pixels: expected as many as the frames: " +
                       std::to_string(size.first) + " x " + std::to_string(size.second));
  }
  PointCloud no_image = image(3, 2);
  no_image.image.reset();
  EXPECT_HAS(refusal([&] { weights(file, no_image); }), "image-mask: the frame is not an image");
}

TEST_F(ImageMasks, AreRefusedIfTheyCannotBeRead) {
  const auto why = [&](const fs::path& file) { return refusal([&] { ImageMask mask(settings(file)); }); };
  const fs::path missing = folder_ / "missing.png";
  EXPECT_HAS(why(missing), missing.string() + ": no such recording");
  EXPECT_THROW(ImageMask mask(settings(missing)), MissingInput);
  const fs::path text = folder_.write("text.png", "no image at all");
  EXPECT_HAS(why(text), text.string() + ": ");
  const std::uint16_t deep[2] = {0, 1};
  const fs::path depth = folder_.write_png("depth.png", 2, 1, PNG_FORMAT_LINEAR_Y, deep);
  EXPECT_HAS(why(depth), depth.string() + ": ");
}

TEST_F(ImageMasks, AreListedAsInputFiles) {
  ImageMask::Settings settings;
  EXPECT_HAS(validate(settings), "path = \"\": expected a PNG file");
  settings.path = grey({1}, 1).string();
  EXPECT_EQ(validate(settings), "");
  EXPECT_EQ(input_files(settings), InputPart{settings.path});
  const auto files = files_of(input_files(settings));
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(files[0].name, "grey.png");
  EXPECT_EQ(files[0].file, settings.path);
}

}  // namespace
}  // namespace remote_touch::image_mask_test
