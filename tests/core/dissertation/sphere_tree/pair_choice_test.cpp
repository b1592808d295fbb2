#include "core/dissertation/sphere_tree/pair_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/kernels/region_kernels.h"
#include "tests/support/scenes.h"

namespace remote_touch::pair_choice_test {
namespace {

constexpr double kLookAhead_m = 1e-4;

struct Region {
  double gap_m;
  Vec3 n_W;
};

// Chooses among the regions of leaf 7. Returns the kept pairs with their motions.
std::vector<ChosenPair> chosen_of(std::vector<Region> regions, std::size_t max = PairChoice::kCapacity) {
  // The kernels read and write whole vectors.
  constexpr std::size_t kRoom = 8 + 2 * kLanes;
  std::vector<double> gap(kRoom), nx(kRoom), ny(kRoom), nz(kRoom);
  std::vector<std::uint32_t> number(kRoom);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    gap[i] = regions[i].gap_m;
    nx[i] = regions[i].n_W.x(), ny[i] = regions[i].n_W.y(), nz[i] = regions[i].n_W.z();
    number[i] = static_cast<std::uint32_t>(i);
  }
  PairChoice choice(kLookAhead_m, scenes::kernels());
  choice.begin();
  choice.choose({7, 0, 0, {Vec3::Zero(), 0.001}},
                {{gap.data(), nx.data(), ny.data(), nz.data(), number.data()}, regions.size()});
  choice.keep_shortest_motions(max);
  return {choice.chosen().begin(), choice.chosen().end()};
}

Vec3 inclined(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return {std::sin(angle), 0, std::cos(angle)};
}

// The shortest motion in the plane of both normals that violates the second region and obeys the first.
double shortest_violation_m(const Region& obeyed, const Region& violated) {
  double shortest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 36000; ++i) {
    const Vec3 direction = inclined(0.01 * i);
    const double towards = -violated.n_W.dot(direction), into = -obeyed.n_W.dot(direction);
    if (towards <= 0) continue;
    const double length = violated.gap_m / towards;
    if (into * length <= obeyed.gap_m * (1 + 1e-9)) shortest = std::min(shortest, length);
  }
  return shortest;
}

TEST(PairChoice, RatesAPairByTheShortestMotionThatViolatesIt) {
  for (const double degrees : {10.0, 20.0, 35.0, 60.0, 90.0, 150.0}) {
    const Region deepest{0, inclined(0)}, other{1.5e-5, inclined(degrees)};
    const std::vector<ChosenPair> pairs = chosen_of({deepest, other});
    // A pair that no motion within a step can violate is not kept.
    const double shortest_m = shortest_violation_m(deepest, other);
    if (degrees == 10) {
      EXPECT_GT(shortest_m, 0.5 * kLookAhead_m);
      EXPECT_EQ(pairs.size(), 1U);
      continue;
    }
    ASSERT_EQ(pairs.size(), 2U) << degrees;
    EXPECT_LE(pairs[1].motion_m, shortest_m * 1.0001) << degrees;
    EXPECT_GE(pairs[1].motion_m, other.gap_m) << degrees;
    // The rated motion is a lower bound. It is close to the shortest motion if the normals are close.
    if (degrees <= 35) {
      EXPECT_GE(pairs[1].motion_m, 0.95 * shortest_m) << degrees;
    }
  }
}

TEST(PairChoice, KeepsThePairsThatShortMotionsViolate) {
  // The first gap is smaller, but a motion has to go far to the side to violate it.
  const std::vector<Region> regions{{0, inclined(0)}, {1.5e-5, inclined(20)}, {2e-5, inclined(150)}};
  const double to_first_m = shortest_violation_m(regions[0], regions[1]),
               to_second_m = shortest_violation_m(regions[0], regions[2]);
  ASSERT_GT(to_first_m, 1.5 * to_second_m);
  const std::vector<ChosenPair> pairs = chosen_of(regions, 2);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].gap_m, 0);
  EXPECT_EQ(pairs[1].gap_m, 2e-5);
}

TEST(PairChoice, KeepsEveryDirectionOfADeepLeaf) {
  const std::vector<ChosenPair> pairs =
      chosen_of({{-3e-4, inclined(0)}, {-2.5e-4, inclined(10)}, {-2.4e-4, inclined(90)}});
  ASSERT_EQ(pairs.size(), 2U) << "the second is nearly the first";
  for (const ChosenPair& pair : pairs)
    EXPECT_EQ(pair.motion_m, pair.gap_m) << "pairs of a deep leaf count by their gaps";
}

}  // namespace
}  // namespace remote_touch::pair_choice_test
