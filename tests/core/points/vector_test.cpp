#include "core/points/vector.h"

#include <gtest/gtest.h>

#include <vector>

namespace remote_touch::vector_test {
namespace {

TEST(BoundingBox, IsAroundEveryPosition) {
  const BoundingBox box = bounding_box(std::vector<Vec3>{{1, -2, 3}, {-1, 5, 3}, {0, 0, 4}});
  EXPECT_EQ(box.min(), Vec3(-1, -2, 3));
  EXPECT_EQ(box.max(), Vec3(1, 5, 4));
  EXPECT_TRUE(bounding_box(std::vector<Vec3>{}).isEmpty());
}

TEST(LimitedLength, OnlyWhatIsLongerIsShortened) {
  EXPECT_EQ(limited_length({3, 0, 4}, 5), Vec3(3, 0, 4));
  EXPECT_EQ(limited_length({3, 0, 4}, 2.5), Vec3(1.5, 0, 2));
  EXPECT_EQ(limited_length({3, 0, 4}, 0), Vec3(0, 0, 0));
  EXPECT_EQ(limited_length({0, 0, 0}, 0), Vec3(0, 0, 0));
}

}  // namespace
}  // namespace remote_touch::vector_test
