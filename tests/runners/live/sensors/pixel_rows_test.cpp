// Rows of pixels from drivers.
#include "runners/live/sensors/pixel_rows.h"

#include <gtest/gtest.h>

namespace remote_touch::pixel_rows_test {
namespace {

using Depth = std::vector<std::uint16_t>;
using Colour = std::vector<std::uint32_t>;

const CameraIntrinsics kCamera{3, 2, 1, 1, 1, 0.5};
// Two rows of three pixels, each followed by a pixel that does not belong to the image.
const Depth kDriver{1, 2, 3, 99, 4, 5, 6, 99};

TEST(PixelRows, ReadDepthWithGapsAndMirrored) {
  Depth depth{7};
  ASSERT_TRUE(copy_depth({kDriver.data(), 16, 3, 2, 8}, kCamera, depth));
  EXPECT_EQ(depth, (Depth{1, 2, 3, 4, 5, 6}));
  ASSERT_TRUE(copy_depth({kDriver.data(), 16, 3, 2, 8, true}, kCamera, depth));
  EXPECT_EQ(depth, (Depth{3, 2, 1, 6, 5, 4}));
}

TEST(PixelRows, ColourIsPacked) {
  const std::vector<std::uint8_t> bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 255, 0, 128, 0, 255, 0, 10, 11, 12};
  Colour colour;
  ASSERT_TRUE(copy_rgb({bytes.data(), 18, 3, 2, 9}, kCamera, colour));
  EXPECT_EQ(colour, (Colour{0x010203, 0x040506, 0x070809, 0xff0080, 0x00ff00, 0x0a0b0c}));
  ASSERT_TRUE(copy_rgb({bytes.data(), 18, 3, 2, 9, true}, kCamera, colour));
  EXPECT_EQ(colour, (Colour{0x070809, 0x040506, 0x010203, 0x0a0b0c, 0x00ff00, 0xff0080}));
}

// The last row needs no gap behind it.
TEST(PixelRows, AcceptTheLeastNumberOfBytes) {
  Depth depth;
  EXPECT_TRUE(copy_depth({kDriver.data(), 14, 3, 2, 8}, kCamera, depth));
  EXPECT_FALSE(copy_depth({kDriver.data(), 13, 3, 2, 8}, kCamera, depth));
}

TEST(PixelRows, OtherSizesAreRefused) {
  Depth depth{7};
  for (const PixelRows& rows :
       {PixelRows{kDriver.data(), 16, 2, 2, 8}, PixelRows{kDriver.data(), 16, 3, 1, 8},
        PixelRows{kDriver.data(), 16, -3, 2, 8}, PixelRows{kDriver.data(), 16, 3, 2, 5},
        PixelRows{kDriver.data(), 16, 3, 2, 0}, PixelRows{kDriver.data(), 0, 3, 2, 8},
        PixelRows{nullptr, 16, 3, 2, 8}, PixelRows{}})
    EXPECT_FALSE(copy_depth(rows, kCamera, depth));
  EXPECT_EQ(depth, Depth{7});
  EXPECT_FALSE(copy_depth(PixelRows{}, CameraIntrinsics{}, depth));
}

}  // namespace
}  // namespace remote_touch::pixel_rows_test
