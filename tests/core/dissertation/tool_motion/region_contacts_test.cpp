// The choice of contacts with regions, the motion that they allow, what is touched, and the renderer of
// chapter 7.
#include "core/dissertation/tool_motion/sphere_tree_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/dissertation/tool_motion/look_ahead_motion.h"
#include "core/dissertation/tool_motion/sphere_tree.h"
#include "core/kernels/point_kernels.h"
#include "core/points/vector.h"
#include "runners/evaluation/contract/allocation_counter.h"
#include "tests/support/box_tool.h"
#include "tests/support/cloud_form.h"
#include "tests/support/scenes.h"

namespace remote_touch::region_contacts_test {
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

constexpr double kRadius_m = 0.04;   // radius of the regions, as in 7.5.1
constexpr double kSettled_m = 1e-4;  // largest depth at which a tool may end a tick

std::shared_ptr<const SphereTree> one_leaf(double radius_m) {
  auto tree = std::make_shared<SphereTree>();
  const Sphere leaf{Vec3::Zero(), radius_m};
  tree->add({&leaf, 1});
  tree->finish();
  return tree;
}

PointCloud regions_at(const std::vector<Vec3>& places, double radius_m = kRadius_m) {
  PointCloud cloud = scenes::cloud_of(places);
  cloud.fixture_radius_m.assign(cloud.size(), radius_m);
  return cloud;
}

ToolPose at(const Vec3& p_W) {
  return {p_W, Eigen::Quaterniond::Identity()};
}

// Points of a handwheel of 45 mm radius, a tube of 5 mm, 3 mm apart: what a camera could see of it.
PointCloud wheel() {
  std::vector<Vec3> places;
  for (int i = 0; i < 96; ++i)
    for (int j = 0; j < 8; ++j) {
      const double a = 2 * M_PI * i / 96, b = 2 * M_PI * j / 8;
      places.emplace_back((0.045 + 0.005 * std::cos(b)) * std::cos(a), 0.005 * std::sin(b),
                          (0.045 + 0.005 * std::cos(b)) * std::sin(a));
    }
  return regions_at(places);
}

// Largest depth of any leaf in any region, computed pair by pair.
double deepest_m(const SphereTree& tool, const ToolPose& pose, const PointCloud& cloud) {
  double deepest = -1;
  for (const Sphere& leaf : tool.leaves())
    for (std::size_t i = 0; i < cloud.size(); ++i)
      deepest = std::max(deepest, leaf.radius_m + cloud.fixture_radius_m[i] -
                                      (pose.p_W + pose.q_WT * leaf.centre - cloud.point(i)).norm());
  return deepest;
}

struct Held {
  std::shared_ptr<const VoxelTool> tool;
  std::shared_ptr<const SphereTree> leaves;
  RegionContacts contacts;
  LookAheadMotion motion;
  ToolPose pose;

  Held(std::shared_ptr<const VoxelTool> tool_, std::shared_ptr<const SphereTree> leaves_)
      : tool(tool_),
        leaves(leaves_),
        contacts(leaves, ToolParameters{}.look_ahead_m, scenes::kernels()),
        motion({}, *tool, 0.05) {}
  void frame(const PointCloud& cloud) { contacts.on_frame(in_form<RegionTree>(cloud)), updated = true; }
  // Renders ticks until the tool rests. Fails if it does not within 200.
  void move_to(const ToolPose& device) {
    for (int tick = 0; tick < 200; ++tick)
      if (motion.move(pose, device, contacts, std::exchange(updated, false)).at_rest) return;
    FAIL() << "does not come to rest";
  }
  bool updated = false;
};

const auto kBox = scenes::box_tool({0.02, 0.005, 0.01});

std::shared_ptr<const SphereTree> spheres_of_box() {
  static const auto spheres = std::make_shared<const SphereTree>(make_tool_spheres(*kBox, 112).spheres);
  return spheres;
}

// A ball against one region stops where the line from the region to the device leaves it, (7.4). In the
// crease of two regions its distance to both is the sum of the radii, a triangle of 30, 40 and 50 mm. In a
// more obtuse crease, neither of the two contacts may hide the other.
TEST(RegionContacts, ABallStopsAtTheNearestPlaceOfRegionsAndInTheirCrease) {
  const Vec3 device = Vec3(0.005, 0.01, 0.002), a = Vec3(1, 0.05, 0.05).normalized(),
             b = Vec3(1, 0.85, 0.85).normalized();
  const struct {
    std::vector<Vec3> regions;
    Vec3 start, device, expected;
    double tolerance_m;
  } cases[] = {{{{0, 0, 0}}, {0, 0.1, 0}, device, 0.05 * device.normalized(), 2.25e-4},
               {{{-0.03, 0, 0}, {0.03, 0, 0}}, {0.01, 0.1, 0}, {0.002, 0, 0}, {0, 0.04, 0}, 1e-4},
               {{-0.05 * a, -0.05 * b}, 0.05 * (a + b), -0.005 * (a + b), {0, 0, 0}, 2e-4}};
  for (const auto& c : cases) {
    Held held(kBox, one_leaf(0.01));
    held.frame(regions_at(c.regions));
    held.pose.p_W = c.start;
    held.move_to(at(c.device));
    EXPECT_LT((held.pose.p_W - c.expected).norm(), c.tolerance_m) << c.expected.transpose();
  }
}

// No leaf ends a tick inside a region, wherever the device goes. The depth is computed over all pairs, one by
// one.
TEST(RegionContacts, NoLeafEndsInsideARegion) {
  const PointCloud cloud = wheel();
  Held held(kBox, spheres_of_box());
  held.frame(cloud);
  held.pose.p_W = {0, 0.15, 0};
  const PointCloud directions = scenes::random_cloud(60, 0.08, 4), turns = scenes::random_cloud(60, 1.5, 5);
  double touching = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    held.move_to({directions.point(i), rotation(turns.point(i))});
    const double deep_m = deepest_m(*held.leaves, held.pose, cloud);
    EXPECT_LT(deep_m, kSettled_m) << i;
    touching += deep_m > -kSettled_m ? 1 : 0;
  }
  EXPECT_GT(touching, 20);
}

// A frame whose regions enclose the tool pushes it out, to a pose outside all regions.
TEST(RegionContacts, AFrameThatSwallowsTheToolPushesItOut) {
  const PointCloud cloud = wheel();
  for (const double y_m : {0.03, 0.02, 0.01, -0.02}) {
    Held held(kBox, spheres_of_box());
    held.pose = {{0.04, y_m, 0.01}, rotation({0.3, 0.2, 0.1})};
    const ToolPose device = held.pose;
    held.frame(cloud);
    EXPECT_GT(deepest_m(*held.leaves, held.pose, cloud), 0.015);
    held.move_to(device);
    EXPECT_LT(deepest_m(*held.leaves, held.pose, cloud), kSettled_m) << y_m;
  }
}

// Regions 8 mm apart form creases so obtuse that both normals are within ten degrees of each other. A leaf
// that kept only one of them would move to and fro.
TEST(RegionContacts, ComesToRestInAnObtuseCrease) {
  for (const double apart_m : {0.001, 0.003, 0.008, 0.02}) {
    std::vector<Vec3> places;
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j) places.emplace_back((i + 0.5) * apart_m, 0, (j + 0.5) * apart_m);
    const PointCloud cloud = regions_at(places);
    for (const auto& leaves : {one_leaf(0.005), spheres_of_box()}) {
      Held held(kBox, leaves);
      held.frame(cloud);
      held.pose.p_W = {0.001, 0.08, 0.0005};
      // 20 mm deep, beside the middle of the crease of four.
      const ToolPose device{{1e-4, 0.025, -2e-4}, rotation({0.02, 0.3, -0.01})};
      held.move_to(device);
      const ToolPose rest = held.pose;
      double displacement = 0;
      for (int tick = 0; tick < 50; ++tick) {
        held.motion.move(held.pose, device, held.contacts, false);
        displacement = std::max(displacement, (held.pose.p_W - rest.p_W).norm());
      }
      EXPECT_LT(displacement, 1e-5) << apart_m;
      EXPECT_LT(deepest_m(*held.leaves, held.pose, cloud), kSettled_m) << apart_m;
    }
  }
}

// Regions all around leave a hole that is too small for the tool. No motion leads out, but the tool comes to
// rest.
TEST(RegionContacts, ComesToRestInAWedge) {
  std::vector<Vec3> places;
  for (int i = 0; i < 600; ++i) {
    const double y = 1 - (2 * i + 1) / 600.0, a = 2.399963 * i, around = std::sqrt(1 - y * y);
    places.emplace_back(0.045 * around * std::cos(a), 0.045 * y, 0.045 * around * std::sin(a));
  }
  for (const double turn : {0.0, 0.7, 1.4}) {
    Held held(kBox, spheres_of_box());
    held.frame(regions_at(places));
    held.pose = {{0.01, 0.005, 0.002}, rotation({0.2, turn, 0.3})};
    const ToolPose device = held.pose;
    for (int tick = 0; tick < 50; ++tick)
      held.motion.move(held.pose, device, held.contacts, std::exchange(held.updated, false));
    EXPECT_GT(held.contacts.near(held.pose, 0).deepest_m, 0.005);
    const ToolPose rest = held.pose;
    for (int tick = 0; tick < 20; ++tick) held.motion.move(held.pose, device, held.contacts, false);
    EXPECT_LT((held.pose.p_W - rest.p_W).norm(), 1e-5) << turn;
  }
}

// The chosen contacts are checked against all pairs: no motion of half the look-ahead that obeys the contacts
// of a leaf violates any of its pairs.
TEST(RegionContacts, TheContactsOfALeafRepresentAllItsPairs) {
  const PointCloud cloud = wheel(), motions = scenes::random_cloud(300, 1, 7);
  const double look_ahead_m = ToolParameters{}.look_ahead_m;
  RegionContacts contacts(one_leaf(0.006), look_ahead_m, scenes::kernels());
  contacts.on_frame(in_form<RegionTree>(cloud));
  int pairs = 0, kept = 0;
  for (int i = 0; i < 100; ++i) {
    const double a = 0.0628 * i, out_m = 0.0505 - 1e-5 * i;
    const Vec3 p_W(0.045 * std::cos(a), out_m, 0.045 * std::sin(a));
    const NearContacts near = contacts.near(at(p_W), 0);
    kept += static_cast<int>(near.contacts.size());
    for (std::size_t m = 0; m < motions.size(); ++m) {
      const Vec3 u = 0.5 * look_ahead_m * motions.point(m).normalized();
      bool obeys = true;
      for (const ToolContact& c : near.contacts) obeys = obeys && c.n_T.dot(u) >= c.depth_m;
      for (std::size_t j = 0; obeys && j < cloud.size(); ++j) {
        const Vec3 displacement = p_W - cloud.point(j);
        const double gap_m = displacement.norm() - 0.006 - kRadius_m;
        if (gap_m > look_ahead_m) continue;
        ++pairs;
        EXPECT_GE(displacement.normalized().dot(u), -gap_m - 1e-12);
      }
    }
  }
  EXPECT_GT(kept, 100);
  EXPECT_GT(pairs, 10000);
}

// The contacts are the same on every level of the kernels, and they do not depend on earlier queries.
TEST(RegionContacts, DoNotDependOnTheLevelOrOnEarlierQueries) {
  const PointCloud cloud = wheel(), directions = scenes::random_cloud(60, 0.05, 4);
  const double look_ahead_m = ToolParameters{}.look_ahead_m;
  RegionContacts slowest(spheres_of_box(), look_ahead_m, kernels_for(Isa::x86_64));
  slowest.on_frame(in_form<RegionTree>(cloud));
  std::size_t found = 0;
  for (const Kernels* kernels : supported_kernels()) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const ToolPose pose{directions.point(i), rotation(20 * directions.point(i))};
      RegionContacts fresh(spheres_of_box(), look_ahead_m, *kernels);
      fresh.on_frame(in_form<RegionTree>(cloud));
      const NearContacts a = fresh.near(pose, 0), b = slowest.near(pose, 0);
      EXPECT_EQ(a.deepest_m, b.deepest_m);
      ASSERT_EQ(a.contacts.size(), b.contacts.size());
      for (std::size_t k = 0; k < a.contacts.size(); ++k) {
        EXPECT_EQ(a.contacts[k].r_T, b.contacts[k].r_T);
        EXPECT_EQ(a.contacts[k].n_T, b.contacts[k].n_T);
        EXPECT_EQ(a.contacts[k].depth_m, b.contacts[k].depth_m);
      }
      found += a.contacts.size();
    }
  }
  EXPECT_GT(found, 1000u);
}

// The tool is clear, in contact, and deep inside. touched() does not allocate memory either.
TEST(RegionContacts, AllocatesOnlyWithAFrame) {
  Held held(kBox, spheres_of_box());
  const PointCloud cloud = wheel();
  for (const double y_m : {0.15, 0.06, 0.03, 0.01}) {
    held.frame(cloud);
    held.pose = {{0.04, y_m, 0.01}, rotation({0.3, 0.2, 0.1})};
    const ToolPose device = held.pose;
    const std::size_t before = allocation_count();
    for (int tick = 0; tick < 5; ++tick) {
      held.motion.move(held.pose, device, held.contacts, std::exchange(held.updated, false));
      held.contacts.touched(held.pose, 600);
    }
    EXPECT_EQ(allocation_count(), before) << y_m;
  }
}

// --- what is touched ---

TEST(RegionTouch, IsThatOfAllPairs) {
  PointCloud cloud = wheel();
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.stiffness_N_per_m.push_back(i % 5 == 0 ? std::nan("") : 100.0 * static_cast<double>(i % 7 + 1));
  const double look_ahead_m = ToolParameters{}.look_ahead_m, own = 600;
  const auto leaves = spheres_of_box();
  RegionContacts contacts(leaves, look_ahead_m, scenes::kernels());
  contacts.on_frame(in_form<RegionTree>(cloud));
  int touching = 0, clear = 0;
  for (int i = 0; i < 60; ++i) {
    const ToolPose pose{{0.04, 0.0555 - 2e-4 * i + (i % 4 == 0 ? 0.02 : 0), 0.01},
                        rotation({0.02, 0.1 * i, 0})};
    double nearest_distance_m = std::numeric_limits<double>::infinity(), weights = 0, weighted = 0;
    int pairs = 0, touching_leaf_count = 0;
    for (const Sphere& leaf : leaves->leaves()) {
      const int before = pairs;
      for (std::size_t j = 0; j < cloud.size(); ++j) {
        const double gap_m = (pose.p_W + pose.q_WT * leaf.centre - cloud.point(j)).norm() - leaf.radius_m -
                             cloud.fixture_radius_m[j];
        if (gap_m <= look_ahead_m) nearest_distance_m = std::min(nearest_distance_m, gap_m);
        if (gap_m > 1e-4) continue;
        const double k = cloud.stiffness_N_per_m[j], weight = std::clamp((1e-4 - gap_m) / 2e-4, 0.0, 1.0);
        ++pairs, weights += weight, weighted += weight * (std::isnan(k) ? own : k);
      }
      touching_leaf_count += pairs > before ? 1 : 0;
    }
    const RegionTouch touch = contacts.touched(pose, own);
    EXPECT_EQ(touch.leaf_pairs, pairs);
    EXPECT_EQ(touch.touching_leaf_count, touching_leaf_count);
    EXPECT_NEAR(touch.stiffness_N_per_m, pairs > 0 ? weighted / weights : own, 1e-6);
    if (std::isfinite(nearest_distance_m))
      EXPECT_NEAR(touch.nearest_distance_m, nearest_distance_m, 1e-12);
    else
      EXPECT_EQ(touch.nearest_distance_m, nearest_distance_m);
    touching += pairs > 0, clear += std::isinf(nearest_distance_m);
  }
  EXPECT_GT(touching, 20);
  EXPECT_GT(clear, 10);
}

// --- the renderer ---

struct Rendered {
  SphereTreeRenderer renderer;
  explicit Rendered(const ToolParameters& p = {}) : renderer(p, kBox, one_leaf(0.01), scenes::kernels()) {}
  // Returns the output after enough ticks for the tool to rest.
  RenderOutput held(const DeviceState& device) {
    RenderOutput out;
    for (int i = 0; i < 20; ++i) out = renderer.step(device, 0.001 * i);
    return out;
  }
};

TEST(SphereTreeRenderer, ABallIsKeptOutByASpringOfTheStiffnessOfTheRegion) {
  for (const double stiffness : {600.0, 150.0}) {
    Rendered r;
    PointCloud cloud = regions_at({{0, 0, 0}});
    cloud.stiffness_N_per_m = {stiffness == 600 ? std::nan("") : stiffness};  // 600: that of the renderer
    r.renderer.on_frame(scenes::frame(cloud));
    r.held({Vec3(0, 0.2, 0)});
    const RenderOutput out = r.held({Vec3(0, 0.03, 0)});
    EXPECT_NEAR(out.proxy_W.y(), 0.05, kSettled_m);
    EXPECT_NEAR(out.force_N.y(), stiffness * (out.proxy_W.y() - 0.03), 1e-9);
    EXPECT_EQ(out.state, ContactState::contact);
    EXPECT_EQ(out.contact_count, 1);
    EXPECT_EQ(out.tool->contact_clusters, 1);
    EXPECT_EQ(out.tool->active_constraints, 1);
    EXPECT_LT(out.tool->tool_penetration_m, kSettled_m);
    EXPECT_NEAR((out.normal_W - Vec3::UnitY()).norm(), 0, 1e-6);
    EXPECT_TRUE(out.converged);
  }
}

TEST(SphereTreeRenderer, FollowsTheDeviceAndReportsTheGapWithinTheLookAhead) {
  Rendered r;
  r.renderer.on_frame(scenes::frame(regions_at({{0, 0, 0}})));
  const DeviceState device{{0, 0.0521, 0}, rotation({0.3, -0.2, 0.9})};
  RenderOutput out = r.held(device);
  EXPECT_EQ(out.proxy_W, device.position_W);
  EXPECT_EQ(out.tool->orientation_W.coeffs(), device.orientation_W.normalized().coeffs());
  EXPECT_TRUE(out.force_N.isZero(0) && out.tool->torque_Nm.isZero(0));
  EXPECT_TRUE(std::isinf(out.nearest_distance_m));
  EXPECT_EQ(out.state, ContactState::free);
  out = r.held({Vec3(0, 0.051, 0)});
  EXPECT_NEAR(out.nearest_distance_m, 0.001, 1e-12);
  EXPECT_EQ(out.contact_count, 0);
  EXPECT_EQ(out.tool->tool_penetration_m, 0);
}

TEST(SphereTreeRenderer, SlaveIsNotSentAnywhereBeforeTheDeviceIsKnown) {
  const Vec3 lost = Vec3::Constant(std::nan("")), away(0, 0.2, 0);
  for (const SlaveCommand command : {SlaveCommand::rendered, SlaveCommand::hip}) {
    ToolParameters p;
    p.slave_command = command;
    Rendered r(p);
    r.renderer.on_frame(scenes::frame(regions_at({{0, 0, 0}})));
    EXPECT_TRUE(r.renderer.step({lost}, 0).slave_W.array().isNaN().all());
    EXPECT_EQ(r.renderer.step({away}, 0.001).slave_W, away);
    EXPECT_EQ(r.renderer.step({lost}, 0.002).slave_W, away);
  }
}

}  // namespace
}  // namespace remote_touch::region_contacts_test
