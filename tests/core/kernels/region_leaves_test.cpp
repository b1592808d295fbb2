// The kernels of a leaf among regions, 7.4.1, on every instruction set level.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/dissertation/tool_motion/sphere_tree.h"
#include "core/kernels/kernels.h"
#include "core/kernels/point_kernels.h"
#include "tests/support/scenes.h"

namespace remote_touch::region_leaves_test {
namespace {

// A patch of regions of different sizes, numbered from 500 on, in an order in which neighbours are near each
// other along one axis.
struct Patch {
  std::vector<Sphere> regions;
  SphereTree tree;
  std::vector<double> gap, nx, ny, nz;
  std::vector<std::uint32_t> number;

  explicit Patch(int count) {
    const PointCloud at = scenes::random_cloud(count, 0.05, 21), sizes = scenes::random_cloud(count, 1, 22);
    for (std::uint32_t i = 0; i < at.size(); ++i) regions.push_back({at.point(i), 0.01 * (sizes.x[i] + 1)});
    std::sort(regions.begin(), regions.end(),
              [](const Sphere& a, const Sphere& b) { return a.centre.x() < b.centre.x(); });
    tree.add(regions);
    const std::size_t buffer = regions.size() + 2 * kLanes;
    for (auto* column : {&gap, &nx, &ny, &nz}) column->assign(buffer, -7);
    number.assign(buffer, 7);
  }
  SphereRun run() const {
    SphereRun run = tree.run(0);
    run.first = 500;
    return run;
  }
  NearRegions near() { return {gap.data(), nx.data(), ny.data(), nz.data(), number.data()}; }
};

double gap_m(const double leaf[4], const Sphere& region) {
  return (Vec3(leaf[0], leaf[1], leaf[2]) - region.centre).norm() - leaf[3] - region.radius_m;
}

TEST(NearRegions, AgreeWithAPlainLoopOnEveryLevel) {
  const int regions = 203;
  for (const Kernels* kernels : supported_kernels())
    for (const double margin : {-0.01, 0.0, 0.004, 0.1})
      for (const bool at_a_middle : {false, true}) {
        Patch patch(regions);
        const Vec3 middle = at_a_middle ? patch.regions[3].centre : Vec3(0.01, 0.02, -0.01);
        const double leaf[4] = {middle.x(), middle.y(), middle.z(), 0.005};
        const std::size_t count =
            kernels->regions.append_near_regions(patch.run(), leaf, margin, patch.near(), 2);
        std::size_t n = 2;
        for (std::uint32_t i = 0; i < regions; ++i) {
          const Vec3 displacement = middle - patch.regions[i].centre;
          const double gap = gap_m(leaf, patch.regions[i]);
          if (!(gap <= margin)) continue;
          ASSERT_LT(n, count);
          EXPECT_EQ(patch.number[n], 500 + i);
          EXPECT_EQ(patch.gap[n], gap);
          const Vec3 normal(patch.nx[n], patch.ny[n], patch.nz[n]);
          EXPECT_LT(
              (normal - (displacement.norm() > 0 ? displacement.normalized() : Vec3(Vec3::UnitY()))).norm(),
              1e-15);
          ++n;
        }
        ASSERT_EQ(count, n);
        EXPECT_EQ(patch.gap[1], -7) << "wrote before the end";
      }
}

// A margin equal to the gap of the nearest region must still find that region, from any position around the
// patch.
TEST(NearRegions, TheNearestIsFoundAtItsOwnGap) {
  Patch patch(203);
  const PointCloud places = scenes::random_cloud(2000, 0.2, 23);
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    const double leaf[4] = {places.x[i], places.y[i], places.z[i], 0.005};
    std::size_t nearest = 0;
    for (std::size_t j = 1; j < patch.regions.size(); ++j)
      if (gap_m(leaf, patch.regions[j]) < gap_m(leaf, patch.regions[nearest])) nearest = j;
    for (const Kernels* kernels : supported_kernels()) {
      const double min_m = gap_m(leaf, patch.regions[nearest]);
      ASSERT_EQ(kernels->regions.append_near_regions(patch.run(), leaf, min_m, patch.near(), 0), 1u);
      EXPECT_EQ(patch.number[0], 500 + nearest);
      EXPECT_EQ(patch.gap[0], min_m);
    }
  }
}

TEST(NearRegions, NoneAreNearNanOrANegativeRadius) {
  for (const Kernels* kernels : supported_kernels()) {
    Patch patch(20);
    const double nowhere[4] = {std::nan(""), 0, 0, 0.01}, inverted[4] = {0, 0, 0, -0.5};
    EXPECT_EQ(kernels->regions.append_near_regions(patch.run(), nowhere, 1, patch.near(), 0), 0u);
    EXPECT_EQ(kernels->regions.append_near_regions(patch.run(), inverted, 0, patch.near(), 0), 0u);
    EXPECT_EQ(kernels->regions.deepest_region(patch.near(), 0), 0u);
  }
}

// The choice among the regions near a leaf by plain loops over all of them, without moving any of them.
struct PlainChoice {
  struct Region {
    double gap;
    Vec3 n;
    bool removed = false;
  };
  std::vector<Region> regions;
  std::size_t count = 0;  // number of regions that were not removed

  PlainChoice(const Patch& patch, std::size_t found) : count(found) {
    for (std::size_t i = 0; i < found; ++i)
      regions.push_back({patch.gap[i], {patch.nx[i], patch.ny[i], patch.nz[i]}});
  }
  const Region* deepest() const {
    const Region* min = nullptr;
    for (const Region& region : regions)
      if (!region.removed && (!min || region.gap < min->gap)) min = &region;
    return min;
  }
  void keep(const Region& kept, double motion, double alike, double max) {
    for (Region& other : regions) {
      if (other.removed) continue;
      const double cosine = other.n.x() * kept.n.x() + (other.n.y() * kept.n.y() + other.n.z() * kept.n.z());
      const double rise = other.gap - kept.gap;
      const bool is_redundant = rise * rise >= motion * motion * (2 - 2 * cosine) && cosine >= alike;
      other.removed = &other == &kept || is_redundant || other.gap > max;
      count -= other.removed ? 1 : 0;
    }
  }
};

// Regions are kept from the deepest to the shallowest, and each kept region removes those that it represents.
// All levels give the same bits while the columns are compacted, for lengths around multiples of the number
// of lanes.
TEST(NearRegions, KeptRegionsRepresentTheRemovedOnes) {
  const double leaf[4] = {0.01, 0.02, -0.01, 0.005};
  std::size_t closed_up = 0;
  for (const Kernels* kernels : supported_kernels())
    for (const int regions : {1, 7, 8, 9, 15, 16, 17, 40, 41, 65, 400})
      for (const double alike : {-2.0, 0.9})
        for (const double motion : {0.0, 0.001, 0.01})
          for (const double max : {-0.004, 0.01, 0.04}) {
            Patch patch(regions);
            const NearRegions near = patch.near();
            std::size_t found = kernels->regions.append_near_regions(patch.run(), leaf, 0.04, near, 0);
            PlainChoice plain(patch, found);
            RemainingRegions left{kernels->regions.deepest_region(near, found), found};
            const PlainChoice::Region* kept = plain.deepest();
            while (kept) {
              const std::size_t at = left.deepest;
              ASSERT_LT(at, left.count) << kernels->isa << ' ' << regions;
              ASSERT_EQ(patch.gap[at], kept->gap) << kernels->isa << ' ' << regions;
              ASSERT_EQ(Vec3(patch.nx[at], patch.ny[at], patch.nz[at]), kept->n);
              plain.keep(*kept, motion, alike, max);
              left = kernels->regions.next_deepest_region(near, left.count, at, motion, alike, max);
              ASSERT_GE(left.count, plain.count);
              closed_up += left.count < found ? 1 : 0;
              found = left.count;
              kept = plain.deepest();
            }
            EXPECT_EQ(left.deepest, left.count);
            EXPECT_EQ(plain.count, 0u);
          }
  EXPECT_GT(closed_up, 100u);
}

// Equally deep regions around a leaf, none of which represents another, are kept in the order in which they
// were found.
TEST(NearRegions, TheFirstOfEquallyDeepOnesIsNext) {
  for (const Kernels* kernels : supported_kernels())
    for (const std::size_t count : {1, 8, 13, 64, 99}) {
      Patch patch(120);
      for (std::size_t i = 0; i < count; ++i) {
        const double a = 0.05 * static_cast<double>(i);
        patch.gap[i] = -0.001, patch.nx[i] = std::cos(a), patch.ny[i] = std::sin(a), patch.nz[i] = 0;
      }
      RemainingRegions left{kernels->regions.deepest_region(patch.near(), count), count};
      for (std::size_t i = 0; i < count; ++i) {
        const double a = 0.05 * static_cast<double>(i);
        ASSERT_LT(left.deepest, left.count) << kernels->isa;
        EXPECT_EQ(patch.nx[left.deepest], std::cos(a)) << kernels->isa << ' ' << i;
        left = kernels->regions.next_deepest_region(patch.near(), left.count, left.deepest, 0.01, -2, 0);
      }
      EXPECT_EQ(left.deepest, left.count);
    }
}

}  // namespace
}  // namespace remote_touch::region_leaves_test
