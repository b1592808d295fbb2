#include "runners/experiment/catalog/catalog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/camera.h"
#include "runners/evaluation/figures/figures.h"
#include "scenarios/synthetic/flat_grid.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::catalog_test {
namespace {

TEST(Catalog, NamesAreUniqueAndDescribed) {
  const auto check = [](const auto& entries) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      EXPECT_GT(std::string(entries[i].summary).size(), 10u) << entries[i].name;
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_NE(std::string(entries[i].name), std::string(entries[j].name));
    }
  };
  check(scenarios()), check(fixtures()), check(renderers()), check(trajectories()), check(figures());
}

TEST(Catalog, OtherSeedsGiveOtherNoise) {
  for (const char* name : {"moving-lift", "camera-scene", "beating-heart", "valve-tank"}) {
    const auto entry = find_entry(scenarios(), name, "scenario");
    const PointCloud a = entry.make()->build(NoiseKey{1}, scenes::kernels())->cloud(0);
    const PointCloud b = entry.make()->build(NoiseKey{2}, scenes::kernels())->cloud(0);
    std::size_t other = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      other += std::abs(a.y[i] - b.y[i]) > 0 ? 1 : 0;  // false for a pixel that saw nothing
    EXPECT_GT(other, a.size() / 10) << name;
  }
}

// A wall of all colours, 0.6 m away: too far from the point that near-point has by default.
TEST(Catalog, FixtureRulesPickPointsWithTheirDefaults) {
  PointCloud cloud;
  cloud.image = ImageLayout{{8, 6, 10, 10, 3.5, 2.5}, RigidTransform::Identity(), 0};
  for (int i = 0; i < 48; ++i) {
    cloud.append(unproject(cloud.image->camera, i % 8, i / 8, 0.6));
    cloud.colour.push_back(static_cast<std::uint32_t>(i * 349525));
  }
  for (const char* name : {"everywhere", "half-space", "near-point", "hue-range"}) {
    double sum = 0;
    for (const double weight : find_entry(fixtures(), name, "fixture").make()->build()->weights(cloud))
      sum += weight;
    EXPECT_EQ(sum > 0, name != std::string("near-point")) << name;
  }
}

TEST(Catalog, HasTheDirectionOfEveryMeasure) {
  EXPECT_EQ(directions().size(), measures().size());
  EXPECT_EQ(directions().at("popped_through"), Better::smaller);
  EXPECT_EQ(directions().at("max_force"), Better::neither);
}

TEST(Catalog, AnEntryNeedsAFreeAndPlainName) {
  Catalog catalog = built_in_catalog();
  const auto add = [&](const char* name) {
    catalog.add(scenario_entry<FlatGrid>(name, "one point at rest, for a test"));
  };
  EXPECT_TRUE(own_entries(catalog).is_empty());
  add("mine");
  EXPECT_EQ(own_entries(catalog).scenarios().size(), 1u);
  EXPECT_EQ(refusal([&] { add("mine"); }), "scenario \"mine\": is in the catalog already");
  EXPECT_HAS(refusal([&] { add("flat-grid"); }), "is in the catalog already");
  EXPECT_EQ(refusal([&] { add("sheet"); }),
            "scenario \"sheet\": is the name of panel in results of version 0.2: expected another name");
  EXPECT_HAS(refusal([&] {
               catalog.add(Measure{"empty", "N", "no function", MeasuredRuns::all, {}});
             }),
             "has no function");
  for (const char* name : {"", "My scene", "a/b", "a=b"})
    EXPECT_HAS(refusal([&] { add(name); }), "expected a name of lower case letters");
}

}  // namespace
}  // namespace remote_touch::catalog_test
