// The statistics of a sensor's frames.
#include "runners/experiment/sessions/sensed_points.h"

#include <gtest/gtest.h>

#include <cmath>

namespace remote_touch::sensed_points_test {
namespace {

TEST(SensedPoints, CountTheMeasuredPixelsOfImages) {
  SensorView view{{4, 1, 100, 100, 2, 0.5}, 0.0005, 30, true, RigidTransform::Identity()};
  SensedPoints points;
  EXPECT_EQ(points.text(), "0 % of 0 points measured, without colours");
  points.add({0, 0, {0, 0, 0, 0}, {}}, view);
  EXPECT_EQ(points.text(), "0 % of 4 points measured, with colours");
  points.add({1, 0.1, {1000, 0, 2400, 65535}, {}}, view);
  EXPECT_EQ(points.frames(), 2);
  EXPECT_EQ(points.text(), "37.5 % of 8 points measured, depth 0.5 to 32.8 m, with colours");
  EXPECT_EQ(layout_text(view), "4 x 1 pixels");
}

TEST(SensedPoints, CountTheFinitePointsOfClouds) {
  SensorView view;
  view.cloud = CloudLayout{true, 0, 3};
  SensorFrame frame;
  frame.points = {0, 0, -0.25f, 0, 0, 1, NAN, NAN,      NAN, 0, 0, 1,
                  1, 1, 0.75f,  0, 0, 1, 1,   INFINITY, 9,   0, 0, 1};
  SensedPoints points;
  points.add(frame, view);
  EXPECT_EQ(points.text(), "50 % of 4 points measured, z -0.25 to 0.75 m, without colours");
  EXPECT_EQ(layout_text(view), "clouds of points");
}

}  // namespace
}  // namespace remote_touch::sensed_points_test
