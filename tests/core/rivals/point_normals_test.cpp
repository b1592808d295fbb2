// Nearest points, spacing and normals of points against brute force and closed forms.
#include "core/rivals/point_normals.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/scenes.h"

namespace remote_touch::point_normals_test {
namespace {

std::vector<double> found_by(NearestPoints& nearest) {
  std::vector<double> distances;
  nearest.for_each([&](const Vec3& e) { distances.push_back(e.norm()); });
  std::sort(distances.begin(), distances.end());
  return distances;
}

TEST(NearestPoints, AreThoseOfBruteForceWhateverWasAskedBefore) {
  const PointCloud cloud = scenes::random_cloud(500, 0.05, 3), places = scenes::random_cloud(40, 0.08, 5);
  const auto search = make_search(cloud);
  NearestPoints nearest(scenes::kernels());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const int count = 1 + static_cast<int>(i * 7 % 23);
    std::vector<double> distances;
    for (std::size_t k = 0; k < cloud.size(); ++k)
      distances.push_back((cloud.point(k) - places.point(i)).norm());
    std::sort(distances.begin(), distances.end());
    EXPECT_NEAR(nearest.find(*search, places.point(i), count), distances[count - 1], 1e-15);
    EXPECT_EQ(found_by(nearest).size(), static_cast<std::size_t>(count));
    EXPECT_NEAR(found_by(nearest).back(), distances[count - 1], 1e-15);
  }
}

TEST(NearestPoints, PointsAtTheSameDistanceBelongTogether) {
  const auto search = make_search(scenes::flat_grid(21, 0.002));
  NearestPoints nearest(scenes::kernels());
  EXPECT_NEAR(nearest.find(*search, Vec3::Zero(), 3), 0.002, 1e-12);
  EXPECT_EQ(found_by(nearest).size(), 5u) << "the node and its four neighbours";
}

// Whatever was found before, a point beyond half a metre does not count.
TEST(NearestPoints, AreThoseWithinHalfAMetre) {
  const auto search = make_search(scenes::cloud_of({{0, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}}));
  for (const double before_m : {0.001, 0.1, 0.2, 0.45}) {
    NearestPoints nearest(scenes::kernels());
    nearest.find(*make_search(scenes::cloud_of({{0, 0, 0}, {before_m, 0, 0}})), Vec3::Zero(), 2);
    EXPECT_NEAR(nearest.find(*search, Vec3::Zero(), 3), 0.3, 1e-15) << before_m;
    EXPECT_EQ(found_by(nearest).size(), 2u) << before_m;
  }
}

TEST(NearestPoints, AreAllIfThereAreFewPoints) {
  const PointCloud two = scenes::cloud_of({{0, 0, 0}, {0.01, 0, 0}});
  NearestPoints nearest(scenes::kernels());
  EXPECT_NEAR(nearest.find(*make_search(two), Vec3::Zero(), 9), 0.01, 1e-15);
  EXPECT_EQ(nearest.find(*make_search(PointCloud{}), Vec3::Zero(), 9), 0);
  EXPECT_TRUE(found_by(nearest).empty());
}

// A corner node of a grid has its third neighbour across the square, a node of a side at one spacing.
TEST(MeanSpacing, IsThatOfASquareGridExceptForTheCorners) {
  constexpr int kSide = 20;
  constexpr double kSpacing_m = 0.003;
  const auto search = make_search(scenes::flat_grid(kSide, kSpacing_m));
  NearestPoints nearest(scenes::kernels());
  PointCloud buffer;
  const double corners = 4 * (std::sqrt(2) - 1) / 3 / (kSide * kSide);
  EXPECT_NEAR(mean_spacing_m(*search, nearest, scenes::kernels(), buffer), kSpacing_m * (1 + corners), 2e-9);
  PointCloud three = scenes::flat_grid(1);
  three.append({0.001, 0, 0}), three.append({0, 0.001, 0});
  EXPECT_EQ(mean_spacing_m(*make_search(three), nearest, scenes::kernels(), buffer), 0);
}

// A cloud of that many points is sampled.
TEST(MeanSpacing, DoesNotDependOnTheOrderOfThePoints) {
  const PointCloud cloud = scenes::random_cloud(50000, 0.1, 4);
  PointCloud reversed;
  for (std::size_t i = cloud.size(); i-- > 0;) reversed.append(cloud.point(i));
  NearestPoints nearest(scenes::kernels());
  PointCloud buffer;
  const double spacing_m = mean_spacing_m(*make_search(cloud), nearest, scenes::kernels(), buffer);
  EXPECT_GT(spacing_m, 0);
  EXPECT_EQ(mean_spacing_m(*make_search(reversed), nearest, scenes::kernels(), buffer), spacing_m);
}

TEST(PointNormals, AreThoseOfAnEigenvalueSolverTurnedToTheSensor) {
  const PointCloud cloud = scenes::random_cloud(400, 0.02, 9);
  const BruteForceSearch search(cloud);
  ViewPoint view;
  view.has_position = true, view.position_W = {0.3, -0.2, 0.5};
  PointNormals normals(9, scenes::kernels());
  normals.set_points(search, view);
  NearestPoints nearest(scenes::kernels());
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Vec3 x = cloud.point(i), n = normals.of(i, x);
    nearest.find(search, x, 9);
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    Vec3 first = Vec3::Zero();
    nearest.for_each([&](const Vec3& e) { first += e, second += e * e.transpose(); });
    const Eigen::Matrix3d covariance = second / 9 - first * first.transpose() / 81;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    EXPECT_NEAR(std::abs(n.dot(solver.eigenvectors().col(0))), 1, 1e-9);
    EXPECT_LT(n.dot(x - view.position_W), 0);
    EXPECT_EQ(normals.of(i, x), n) << "kept";
  }
}

TEST(PointNormals, DoNotDependOnTheOrderAndPointsOnALineHaveNone) {
  const PointCloud cloud = scenes::random_cloud(300, 0.01, 8);
  PointCloud turned;
  for (std::size_t i = cloud.size(); i-- > 0;) turned.append(cloud.point(i));
  const BruteForceSearch a(cloud), b(turned);
  PointNormals of_a(9, scenes::kernels()), of_b(9, scenes::kernels());
  of_a.set_points(a, {}), of_b.set_points(b, {});
  for (std::uint32_t i = 0; i < 300; ++i)
    EXPECT_EQ(of_a.of(i, cloud.point(i)), of_b.of(299 - i, cloud.point(i)));
  PointCloud line;
  for (int i = 0; i < 20; ++i) line.append({0.001 * i, 0, 0});
  const BruteForceSearch on_a_line(line);
  of_a.set_points(on_a_line, {});
  EXPECT_TRUE(of_a.of(3, line.point(3)).isZero(0));
}

}  // namespace
}  // namespace remote_touch::point_normals_test
