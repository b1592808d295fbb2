// Positions of a tool at which sheets are tracked, the motion that carries it, and where patches begin.
#include "core/beyond/tracked_surface/sheet_patches.h"

#include <gtest/gtest.h>
#include <cmath>
#include <random>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/points/neighbour_search.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::sheet_patches_test {
namespace {

constexpr double kRadius_m = 0.0325;

TEST(ToolPositions, APlateIsOneGroupAndABarTwo) {
  EXPECT_EQ(ToolPositions(box_mesh({0.04, 0.01, 0.04}), kRadius_m, 4).groups().size(), 1);
  EXPECT_EQ(ToolPositions(box_mesh({0.08, 0.02, 0.01}), kRadius_m, 4).groups().size(), 2);
  EXPECT_EQ(ToolPositions(box_mesh({0.08, 0.02, 0.01}), kRadius_m, 1).groups().size(), 1);
}

TEST(ToolPositions, TheyLieOnTheSurfaceAndCoverIt) {
  const Vec3 half_m(0.02, 0.005, 0.02);
  const TriangleMesh mesh = box_mesh(2 * half_m);
  const ToolPositions positions(mesh, kRadius_m, 4);
  ASSERT_LE(positions.all().size(), ToolPositions::kMax);
  for (const Vec3& p : positions.all()) EXPECT_NEAR(scenes::box_distance(half_m, p), 0, 1e-12);
  const auto distance_m = [&](const Vec3& from) {
    double nearest = 1;
    for (const Vec3& p : positions.all()) nearest = std::min(nearest, (p - from).norm());
    return nearest;
  };
  for (const Vec3& corner : mesh.vertices) EXPECT_LT(distance_m(corner), 0.3 * kRadius_m);
  for (double x = -0.02; x <= 0.02; x += 0.001)
    for (double z = -0.02; z <= 0.02; z += 0.001) EXPECT_LT(distance_m({x, -0.005, z}), 0.3 * kRadius_m);
}

TEST(ToolPositions, EachIsWithinTheRadiusOfItsGroup) {
  for (const GeneratedTool& tool : generated_tools()) {
    const ToolPositions positions(tool.make(), kRadius_m, 16);
    std::size_t count = 0;
    for (const ToolPositions::Group& group : positions.groups()) {
      EXPECT_LE(group.radius_m, kRadius_m) << tool.name;
      EXPECT_EQ(group.first, count) << tool.name;
      for (const Vec3& p : positions.of(group))
        EXPECT_LE((p - group.middle_T).norm(), group.radius_m) << tool.name;
      count += group.count;
    }
    EXPECT_EQ(count, positions.all().size()) << tool.name;
  }
}

// Motion with which a tool is carried: the least-squares solution, tested against known motions.

constexpr double kLever_m = 0.01;
const Vec3 kAbout_W(0.3, -0.1, 0.2);

// A body that turns by w about the origin and moves by t, to first order.
struct Motion {
  Vec3 t, w;
  double along(const Vec3& n_W, const Vec3& p_W) const { return n_W.dot(t + w.cross(p_W)); }
  Vector6 about(const Vec3& p_W) const {
    Vector6 motion;
    motion << t + w.cross(p_W), w;
    return motion;
  }
};

// Adds the four corners of a 40 mm square with centre middle_W, normal n_W and one side along u_W.
void add_face(CarriedMotion& to, const Vec3& middle_W, const Vec3& n_W, const Vec3& u_W, const Motion& motion,
              double error_m = 0) {
  const Vec3 v_W = n_W.cross(u_W);
  for (const double a : {-0.02, 0.02})
    for (const double b : {-0.02, 0.02}) {
      const Vec3 p_W = middle_W + a * u_W + b * v_W;
      to.add({p_W, n_W, motion.along(n_W, p_W), error_m, 1});
    }
}

TEST(CarriedMotion, IsUnknownIfThereAreNoPlaces) {
  EXPECT_TRUE(CarriedMotion(kLever_m).empty());
  const CarriedMotion::Result result = CarriedMotion(kLever_m).about(kAbout_W);
  EXPECT_FALSE(result.known);
  EXPECT_TRUE(result.motion.isZero(0));
}

// A face determines the displacement along its normal and the rotations about two axes within it. Motion
// within the face is not seen.
TEST(CarriedMotion, AFaceDeterminesItsNormalMotionAndTwoRotations) {
  const Vec3 middle_W(0.1, 0.02, -0.05);
  CarriedMotion places(kLever_m);
  const Motion motion{{0, 0.004, 0}, {0.05, 0, -0.03}};
  add_face(places, middle_W, Vec3::UnitY(), Vec3::UnitX(), motion);
  const CarriedMotion::Result result = places.about(middle_W);
  ASSERT_TRUE(result.known);
  EXPECT_NEAR(result.motion[1], motion.about(middle_W)[1], 1e-12);
  EXPECT_NEAR((result.motion.tail<3>() - motion.w).norm(), 0, 1e-12);
  EXPECT_NEAR(std::hypot(result.motion[0], result.motion[2]), 0, 1e-12);
  // The motion about another point of the same body.
  const Vec3 above_W = middle_W + Vec3(0.01, 0.03, 0);
  const Vec3 there = places.about(above_W).motion.head<3>();
  const Vec3 expected = result.motion.head<3>() + motion.w.cross(above_W - middle_W);
  EXPECT_NEAR((there - expected).norm(), 0, 1e-12);
}

// An edge: positions in a row along x determine the rotation about z, but not about x. Positions closer
// together than a third of the lever determine no rotation: noise would turn the tool by any angle.
TEST(CarriedMotion, ARowOfPlacesTurnsAboutOneAxis) {
  CarriedMotion row(kLever_m), close(kLever_m);
  const Motion motion{{0, 0.001, 0}, {0.1, 0, 0.04}};
  for (const double x : {-0.03, -0.01, 0.01, 0.03})
    row.add({{x, 0, 0}, Vec3::UnitY(), motion.along(Vec3::UnitY(), {x, 0, 0}), 0, 1});
  for (const double x : {-0.001, 0.001}) close.add({{x, 0, 0}, Vec3::UnitY(), x, 0, 1});
  const Vector6 found = row.about(Vec3::Zero()).motion;
  EXPECT_NEAR(found[5], 0.04, 1e-12);
  EXPECT_NEAR(found[3], 0, 1e-12);
  EXPECT_NEAR(found[1], 0.001, 1e-12);
  EXPECT_NEAR(close.about(Vec3::Zero()).motion.norm(), 0, 1e-15);
}

TEST(CarriedMotion, OnePositionGivesADisplacementAlongItsNormal) {
  const Vec3 n_W = Vec3(1, 2, -2) / 3;
  CarriedMotion places(kLever_m);
  places.add({kAbout_W + Vec3(0.02, 0, 0), n_W, 0.003, 0, 1});
  Vector6 expected = Vector6::Zero();
  expected.head<3>() = 0.003 * n_W;
  EXPECT_NEAR((places.about(kAbout_W).motion - expected).norm(), 0, 1e-12);
}

// Three faces determine all six components. The least-squares motion equals the one that made the positions,
// to first order.
TEST(CarriedMotion, AnyMotionOfABoxIsFound) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const auto any = [&](double size) {
      return Vec3(size * off(random), size * off(random), size * off(random));
    };
    const Motion motion{any(0.01), any(0.2)};
    CarriedMotion places(kLever_m);
    for (int axis = 0; axis < 3; ++axis)
      add_face(places, -0.03 * Vec3::Unit(axis) + any(0.005), Vec3::Unit(axis), Vec3::Unit((axis + 1) % 3),
               motion);
    const Vec3 about_W = any(0.05);
    EXPECT_NEAR((places.about(about_W).motion - motion.about(about_W)).norm(), 0, 1e-10);
  }
}

// `shrunk` is the fraction x^2 / (x^2 + 4 e^2) of a motion x that is measured with the error e.
TEST(CarriedMotion, IsLessSureTheMoreNoiseMayExplainIt) {
  for (const double error_m : {0.0, 0.001, 0.01}) {
    CarriedMotion places(kLever_m);
    add_face(places, kAbout_W, Vec3::UnitY(), Vec3::UnitX(), {{0, 0.004, 0}, {0, 0, 0}}, error_m);
    const CarriedMotion::Result result = places.about(kAbout_W);
    EXPECT_NEAR(result.motion[1], 0.004, 1e-12);
    EXPECT_NEAR(result.shrunk[1], 0.004 * 16e-6 / (16e-6 + 4 * error_m * error_m), 1e-12) << error_m;
  }
}

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

// Two contacts with a wall may belong to an edge, so they begin no patch.
TEST(SheetPatches, AnotherPatchBeginsAtTheDeepestOfManyContactsThatNoneExplains) {
  const auto tool = scenes::box_tool(kHalf_m);
  const auto frame = floor_and_wall();
  for (const std::size_t count : {2u, 5u})
    for (std::size_t deepest = 0; deepest < count; deepest += 2) {
      SheetPatches patches({}, kUnit_m, 3, *tool, scenes::kernels());
      patches.keep(frame, 0);
      patches.requery({}, false);
      std::vector<ToolContact> contacts = wall_contacts(deepest);
      contacts.resize(count);
      patches.on_frame(frame, {{}, true, contacts}, 1.0 / 30);
      int walls = 0;
      for (std::size_t i = 0; i < patches.size(); ++i) {
        if (!patches.tracks(i)) continue;
        const PatchFrame& of = patches.tracker(i).region().frame;
        if (of.normal_W().dot(contacts[deepest].n_T) < 0.9) {
          EXPECT_TRUE(count > 2 || of.normal_W().y() > 0.9) << "the floor";
          continue;
        }
        ++walls;
        const PatchPlace place = of.place(contacts[deepest].r_T);
        EXPECT_NEAR(std::hypot(place.u, place.v), 0, 1e-3) << deepest;
      }
      EXPECT_EQ(walls, count > 2 ? 1 : 0) << deepest;
    }
}

}  // namespace
}  // namespace remote_touch::sheet_patches_test
