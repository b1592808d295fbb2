#include "core/dissertation/tool/contact/continuous_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "core/dissertation/tool/contact/contact_list.h"
#include "tests/support/box_tool.h"
#include "tests/support/formatted.h"
#include "tests/support/scenes.h"

namespace remote_touch::continuous_contacts_test {
namespace {

constexpr double kLength_m = 0.006, kShorter_m = 3e-4, kApart_m = 1e-3;

// Two pins of half a millimetre side by side, one of them shorter at its lower end.
std::shared_ptr<const VoxelTool> two_pins() {
  auto tool = std::make_shared<VoxelTool>(*scenes::box_tool({1.25e-3, kLength_m, 2.5e-4}, 1.25e-4));
  const VoxelGrid& grid = tool->grid;
  std::size_t node = 0;
  for (int k = 0; k <= grid.cells[2]; ++k)
    for (int j = 0; j <= grid.cells[1]; ++j)
      for (int i = 0; i <= grid.cells[0]; ++i) {
        const Vec3 p_T = grid.origin_T + grid.size_m * Vec3(i, j, k), half_m(2.5e-4, kLength_m, 2.5e-4);
        const double longer_m = scenes::box_distance(half_m, p_T),
                     shorter_m = scenes::box_distance(half_m, p_T - Vec3(kApart_m, kShorter_m, 0));
        tool->distance_m[node++] = static_cast<float>(std::min(longer_m, shorter_m));
      }
  return tool;
}

// One merged disk replaces many points of a dense flat surface. Its search finds only the pin towards which
// the field falls. Points in the other pin are found all the same.
TEST(ContinuousContacts, PointsInThePartThatADiskDoesNotFindAreFound) {
  constexpr double kDepth_m = 2e-4;
  const auto pin = two_pins();
  const PointCloud cloud = scenes::dense_plane();
  ToolParameters p;
  p.contact_rule = ContactRule::continuous;
  ContactList points(pin, p, scenes::kernels());
  points.on_frame(formatted<TiledCloud>(cloud, used_merged_disk_m(p)));
  ContinuousContacts contacts(p, *pin);
  contacts.begin(points);
  int not_told = 0;
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 10; ++i) {
      ToolPose pose{{2e-4 * i, kLength_m - kDepth_m, 2e-4 * j}, Eigen::Quaterniond::Identity()};
      not_told += contacts.near(pose, 0).deepest_m <= ContinuousContacts::kGap_m ? 1 : 0;
      EXPECT_TRUE(contacts.has_points_inside(pose)) << i << " " << j;
      pose.p_W.y() = kLength_m + kDepth_m;
      EXPECT_FALSE(contacts.has_points_inside(pose)) << i << " " << j;
    }
  EXPECT_GT(not_told, 0);
}

// A motion away from one surface stops where the tool meets another surface ahead. A surface inside the tool
// stops it at once. A surface that the tool only slides along does not stop it.
TEST(ContinuousContacts, ASurfaceAheadStopsAMotionUnlessItOnlyTouches) {
  const Vec3 half_m(0.005, 0.003, 0.004);
  const auto tool = scenes::box_tool(half_m, 2.5e-4);
  ToolParameters p;
  p.contact_rule = ContactRule::continuous;
  ContactList points(tool, p, scenes::kernels());
  points.on_frame(formatted<TiledCloud>(scenes::dense_plane(), 0.0));
  ContinuousContacts contacts(p, *tool);
  contacts.begin(points);
  const auto fraction = [&](double height_m, const Vec3& shift_W, double side) {
    Vector6 a_g = Vector6::Zero();
    a_g.head<3>() = shift_W;
    return contacts.fraction_ahead({{0, half_m.y() + height_m, 0}, Eigen::Quaterniond::Identity()}, a_g,
                                   side);
  };
  EXPECT_NEAR(fraction(2e-4, {0, -4e-4, 0}, 1), (2e-4 - ClearWay::kTouch_m) / 4e-4, 1e-3);
  EXPECT_EQ(fraction(2e-4, {0, -1e-4, 0}, 1), 1);
  EXPECT_EQ(fraction(1.5e-6, {3e-4, -3e-7, 0}, 1), 1) << "along it";
  EXPECT_EQ(fraction(-1e-4, {3e-4, -3e-7, 0}, 1), 0) << "in it";
  for (const double height_m : {2e-4, -1e-4}) {
    EXPECT_EQ(fraction(height_m, {0, 4e-4, 0}, 1), 1) << "away from it";
    EXPECT_EQ(fraction(height_m, {0, -4e-4, 0}, -1), 1) << "its back";
  }
}

}  // namespace
}  // namespace remote_touch::continuous_contacts_test
