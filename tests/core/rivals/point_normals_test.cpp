// Nearest points, spacing and normals of points, and implicit surfaces, against brute force and closed forms.
#include "core/rivals/point_normals.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/points/neighbour_search.h"
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

// Points at the same distance belong together. If there are few points, they are all.
TEST(NearestPoints, MayBeMoreOrFewerThanAreAskedFor) {
  NearestPoints nearest(scenes::kernels());
  EXPECT_NEAR(nearest.find(*make_search(scenes::flat_grid(21, 0.002)), Vec3::Zero(), 3), 0.002, 1e-12);
  EXPECT_EQ(found_by(nearest).size(), 5u) << "the node and its four neighbours";
  const PointCloud two = scenes::cloud_of({{0, 0, 0}, {0.01, 0, 0}});
  EXPECT_NEAR(nearest.find(*make_search(two), Vec3::Zero(), 9), 0.01, 1e-15);
  EXPECT_EQ(nearest.find(*make_search(PointCloud{}), Vec3::Zero(), 9), 0);
  EXPECT_TRUE(found_by(nearest).empty());
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

// Points on a line have no normal.
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
  PointCloud line;
  for (int i = 0; i < 20; ++i) line.append({0.001 * i, 0, 0});
  const BruteForceSearch on_a_line(line);
  normals.set_points(on_a_line, view);
  EXPECT_TRUE(normals.of(3, line.point(3)).isZero(0));
}

constexpr double kR = 0.01;
const Vec3 kNoSide = Vec3::Zero();

SurfaceSample sample(const PointSurface& surface, const PointCloud& cloud, const Vec3& p,
                     const Vec3& side = kNoSide) {
  Neighbourhood near = scenes::neighbourhood(make_search(cloud), kR);
  const PointsView points = near.around(p).view();
  return surface.at(points, near.sum_grid(), p, side);
}

double wyvill(double q) {
  return 1 - 4.0 / 9 * std::pow(q, 6) + 17.0 / 9 * std::pow(q, 4) - 22.0 / 9 * q * q;
}
double wendland(double q) {
  return std::pow(1 - q, 4) * (4 * q + 1);
}

TEST(PointSurface, AMetaballOfOnePointIsASphereAndTwoAddUp) {
  const PointCloud cloud = scenes::cloud_of({{0.02, -0.01, 0.03}});
  for (const SurfaceWeight weight : {SurfaceWeight::wyvill, SurfaceWeight::wendland}) {
    const auto w = weight == SurfaceWeight::wyvill ? wyvill : wendland;
    const PointSurface surface(SurfaceKind::metaballs, weight, kR, 0.5);
    const Vec3 direction = Vec3(1, 2, -2) / 3;
    for (const double q : {0.05, 0.3, 0.6, 0.95}) {
      const SurfaceSample at = sample(surface, cloud, cloud.point(0) + q * kR * direction);
      EXPECT_NEAR(at.value, 0.5 - w(q), 1e-12) << q;
      EXPECT_NEAR((at.normal() - direction).norm(), 0, 1e-9) << q;
    }
    const SurfaceSample outside = sample(surface, cloud, cloud.point(0) + 1.001 * kR * direction);
    EXPECT_FALSE(outside.supported);
    EXPECT_GT(outside.value, 0);
  }
  const PointCloud two = scenes::cloud_of({{-0.004, 0, 0}, {0.004, 0, 0}});
  const PointSurface surface(SurfaceKind::metaballs, SurfaceWeight::wyvill, kR, 0.5);
  EXPECT_NEAR(sample(surface, two, {0, 0.003, 0}).value, 0.5 - 2 * wyvill(0.5), 1e-12) << "they add up";
}

TEST(PointSurface, GradientsOfMetaballsAreThoseOfFiniteDifferences) {
  const PointCloud cloud = scenes::random_cloud(200, 0.02, 3), places = scenes::random_cloud(60, 0.02, 4);
  for (const SurfaceWeight weight : {SurfaceWeight::wyvill, SurfaceWeight::wendland}) {
    const PointSurface surface(SurfaceKind::metaballs, weight, kR, 0.5);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vec3 p = places.point(i);
      const SurfaceSample at = sample(surface, cloud, p);
      for (int axis = 0; axis < 3; ++axis) {
        constexpr double h = 1e-4;  // units of R
        const Vec3 step = h * kR * Vec3::Unit(axis);
        const double slope =
            (sample(surface, cloud, p + step).value - sample(surface, cloud, p - step).value) / (2 * h);
        EXPECT_NEAR(at.gradient[axis], slope, 1e-6 * std::max(1.0, at.gradient.norm()));
      }
    }
  }
}

// Surfels reproduce a tilted plane exactly, and their gradient is that of f there.
TEST(PointSurface, SurfelsOfAPlaneAreThePlane) {
  const Vec3 normal = Vec3(0.3, 0.9, -0.2).normalized(), u = normal.cross(Vec3::UnitX()).normalized(),
             v = normal.cross(u);
  PointCloud cloud;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j) cloud.append(0.0015 * (i * u + j * v));
  for (const SurfaceWeight weight : {SurfaceWeight::wyvill, SurfaceWeight::wendland}) {
    const PointSurface surface(SurfaceKind::surfels, weight, kR, 0.5);
    for (const double height : {-0.006, -0.001, 0.0, 0.002, 0.007}) {
      const SurfaceSample at = sample(surface, cloud, height * normal + 0.0004 * u + 0.0007 * v, normal);
      EXPECT_NEAR(at.value, height / kR, 1e-9);
      EXPECT_NEAR((at.gradient - normal).norm(), 0, 1e-9);
      EXPECT_NEAR(at.distance(), height / kR, 1e-9);
    }
    EXPECT_GT(sample(surface, cloud, -0.003 * normal).value, 0) << "without a side, the place is outside";
    EXPECT_LT(sample(surface, cloud, -0.003 * normal, normal).value, 0);
  }
}

TEST(PointSurface, PointsThatSpanNoPlaneHoldNothing) {
  PointCloud cloud;
  const PointSurface surface(SurfaceKind::surfels, SurfaceWeight::wyvill, kR, 0.5);
  EXPECT_FALSE(sample(surface, cloud, Vec3::Zero()).supported);
  for (const double x : {0.0, 0.003, -0.003}) {
    cloud.append({x, 0, 0});
    EXPECT_GT(sample(surface, cloud, {0, 0.002, 0}, -Vec3::UnitY()).value, 0) << cloud.size();
  }
}

TEST(PointSurface, TheOrderOfThePointsDoesNotMatter) {
  const PointCloud cloud = scenes::random_cloud(300, 0.01, 8);
  PointCloud turned;
  for (std::size_t i = cloud.size(); i-- > 0;) turned.append(cloud.point(i));
  for (const SurfaceKind kind : {SurfaceKind::metaballs, SurfaceKind::surfels}) {
    const PointSurface surface(kind, SurfaceWeight::wendland, kR, 0.5);
    const Vec3 p(0.001, 0.002, -0.003);
    EXPECT_EQ(sample(surface, cloud, p).value, sample(surface, turned, p).value);
    EXPECT_EQ(sample(surface, cloud, p).gradient, sample(surface, turned, p).gradient);
  }
}

// The last two are a diagonal matrix, and one whose axes are equal.
TEST(ThinnestAxis, IsThatOfAnEigenvalueSolver) {
  const PointCloud numbers = scenes::random_cloud(300, 1, 12);
  std::vector<Eigen::Matrix3d> matrices;
  for (std::size_t i = 0; i + 3 <= numbers.size(); i += 3) {
    Eigen::Matrix3d half;
    half << numbers.point(i), numbers.point(i + 1), numbers.point(i + 2);
    matrices.emplace_back(half * half.transpose());
  }
  matrices.emplace_back(Vec3(3, 1, 2).asDiagonal()), matrices.push_back(Eigen::Matrix3d::Identity());
  for (const Eigen::Matrix3d& matrix : matrices) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
    const ThinnestAxis thin = thinnest_axis(matrix);
    EXPECT_NEAR(thin.smallest, solver.eigenvalues()[0], 1e-13);
    EXPECT_NEAR(thin.middle, solver.eigenvalues()[1], 1e-13);
    EXPECT_NEAR((matrix * thin.axis - thin.smallest * thin.axis).norm(), 0, 1e-13);
    EXPECT_NEAR(thin.axis.norm(), 1, 1e-14);
  }
}

}  // namespace
}  // namespace remote_touch::point_normals_test
