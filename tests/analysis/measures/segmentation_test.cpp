#include "analysis/measures/segmentation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "analysis/statistics/proportion.h"

namespace remote_touch::segmentation_test {
namespace {

// Every combination, except a selected pixel of another class without depth.
const std::vector<char> kPicked{1, 1, 1, 0, 1, 0, 0, 0};
const std::vector<char> kOfClass{1, 1, 0, 1, 1, 1, 0, 0};
const std::vector<char> kDepth{1, 1, 1, 1, 0, 0, 1, 0};

TEST(Segmentation, CountsPixelsWithoutDepthSeparately) {
  const SegmentationScore score = score_segmentation(kPicked, kOfClass, kDepth);
  EXPECT_EQ(score.found, 2);
  EXPECT_EQ(score.missed, 1);
  EXPECT_EQ(score.wrong, 1);
  EXPECT_EQ(score.of_class_without_depth, 2);
  EXPECT_DOUBLE_EQ(score.recall(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(score.precision(), 2.0 / 3);
  EXPECT_DOUBLE_EQ(score.depth_fraction(), 3.0 / 5);
  EXPECT_EQ(score.recall_interval(), exact_interval(2, 3));
  EXPECT_EQ(score.precision_interval(), exact_interval(2, 3));
}

TEST(Segmentation, FramesAddUp) {
  SegmentationScore sum = score_segmentation(kPicked, kOfClass, kDepth);
  sum += score_segmentation({1, 0}, {1, 1}, {1, 1});
  EXPECT_EQ(sum.found, 3);
  EXPECT_EQ(sum.missed, 2);
  EXPECT_EQ(sum.wrong, 1);
  EXPECT_EQ(sum.of_class_without_depth, 2);
}

TEST(Segmentation, FractionsOfNoPixelsAreNan) {
  const SegmentationScore none = score_segmentation({}, {}, {});
  EXPECT_TRUE(std::isnan(none.recall()) && std::isnan(none.precision()) && std::isnan(none.depth_fraction()));
  const SegmentationScore unpicked = score_segmentation({0, 0}, {1, 0}, {1, 1});
  EXPECT_EQ(unpicked.recall(), 0);
  EXPECT_TRUE(std::isnan(unpicked.precision()));
  EXPECT_EQ(unpicked.precision_interval(), (std::pair(0.0, 1.0)));
}

TEST(Segmentation, ColumnsOfOtherLengthsAreRefused) {
  EXPECT_THROW(score_segmentation({1}, {1, 0}, {1, 1}), std::invalid_argument);
  EXPECT_THROW(score_segmentation({1, 0}, {1, 0}, {1}), std::invalid_argument);
}

}  // namespace
}  // namespace remote_touch::segmentation_test
