// Positions at which patches of tracked sheets begin around a tool.
#include "core/beyond/tracked_surface/sheet_patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/points/neighbour_search.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::sheet_patches_test {
namespace {

constexpr double kUnit_m = 0.005;
const Vec3 kHalf_m(0.02, 0.005, 0.02);

// A floor right below the tool and a wall at its side, 1.5 mm between points.
std::shared_ptr<const NeighbourSearch> floor_and_wall() {
  PointCloud cloud;
  for (int j = -40; j <= 40; ++j)
    for (int i = -40; i <= 40; ++i) {
      cloud.append(Vec3(0.0015 * i, -kHalf_m.y(), 0.0015 * j));
      cloud.append(Vec3(kHalf_m.x(), 0.0015 * i, 0.0015 * j));
    }
  return std::make_shared<BruteForceSearch>(cloud);
}

// Contacts with the wall. The one at index `deepest` is deeper than the others.
std::vector<ToolContact> wall_contacts(std::size_t deepest) {
  const Vec3 n_T = -Vec3::UnitX();
  std::vector<ToolContact> contacts;
  for (const double z : {-0.012, -0.01, -0.008, -0.006})
    contacts.push_back({Vec3(kHalf_m.x(), 0, z), n_T, 1e-5, 0});
  contacts.insert(contacts.begin() + static_cast<std::ptrdiff_t>(deepest),
                  {Vec3(kHalf_m.x(), 0.001, 0.01), n_T, 2e-4, 0});
  return contacts;
}

TEST(SheetPatches, AnotherPatchBeginsAtTheDeepestContactThatNoneExplains) {
  const auto tool = scenes::box_tool(kHalf_m);
  const auto frame = floor_and_wall();
  for (const std::size_t deepest : {0u, 2u, 4u}) {
    SheetPatches patches({}, kUnit_m, 3, *tool, scenes::kernels());
    patches.keep(frame, 0);
    patches.requery({}, false);
    const std::vector<ToolContact> contacts = wall_contacts(deepest);
    patches.on_frame(frame, {{}, true, contacts}, 1.0 / 30);
    int walls = 0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (!patches.tracks(i)) continue;
      const PatchFrame& of = patches.tracker(i).region().frame;
      if (of.normal_W().dot(contacts[deepest].n_T) < 0.9) continue;
      ++walls;
      const PatchPlace place = of.place(contacts[deepest].r_T);
      EXPECT_NEAR(std::hypot(place.u, place.v), 0, 1e-3) << deepest;
    }
    EXPECT_EQ(walls, 1) << deepest;
  }
}

// Two contacts with a wall may belong to an edge, so they begin no patch.
TEST(SheetPatches, NoneBeginsAtFewContacts) {
  const auto tool = scenes::box_tool(kHalf_m);
  const auto frame = floor_and_wall();
  SheetPatches patches({}, kUnit_m, 3, *tool, scenes::kernels());
  patches.keep(frame, 0);
  patches.requery({}, false);
  std::vector<ToolContact> contacts = wall_contacts(0);
  contacts.resize(2);
  patches.on_frame(frame, {{}, true, contacts}, 1.0 / 30);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (!patches.tracks(i)) continue;
    EXPECT_GT(patches.tracker(i).region().frame.normal_W().y(), 0.9);
  }
}

}  // namespace
}  // namespace remote_touch::sheet_patches_test
