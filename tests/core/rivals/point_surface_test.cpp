// The two implicit surfaces against closed forms and finite differences, and the axis that one of them needs.
#include "core/rivals/point_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/rivals/point_normals.h"
#include "core/search/neighbourhood.h"
#include "tests/support/scenes.h"

namespace remote_touch::point_surface_test {
namespace {

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

TEST(PointSurface, AMetaballOfOnePointIsASphere) {
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
}

TEST(PointSurface, TwoMetaballsAddUp) {
  const PointCloud cloud = scenes::cloud_of({{-0.004, 0, 0}, {0.004, 0, 0}});
  const PointSurface surface(SurfaceKind::metaballs, SurfaceWeight::wyvill, kR, 0.5);
  EXPECT_NEAR(sample(surface, cloud, {0, 0.003, 0}).value, 0.5 - 2 * wyvill(0.5), 1e-12);
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

TEST(ThinnestAxis, IsThatOfAnEigenvalueSolver) {
  const PointCloud numbers = scenes::random_cloud(300, 1, 12);
  for (std::size_t i = 0; i + 3 <= numbers.size(); i += 3) {
    Eigen::Matrix3d half;
    half << numbers.point(i), numbers.point(i + 1), numbers.point(i + 2);
    const Eigen::Matrix3d matrix = half * half.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
    const ThinnestAxis thin = thinnest_axis(matrix);
    EXPECT_NEAR(thin.smallest, solver.eigenvalues()[0], 1e-13);
    EXPECT_NEAR(thin.middle, solver.eigenvalues()[1], 1e-13);
    EXPECT_NEAR((matrix * thin.axis - thin.smallest * thin.axis).norm(), 0, 1e-13);
    EXPECT_NEAR(thin.axis.norm(), 1, 1e-14);
  }
}

TEST(ThinnestAxis, IsFoundForADiagonalMatrixAndForEqualAxes) {
  EXPECT_EQ(thinnest_axis(Vec3(3, 1, 2).asDiagonal()).axis, Vec3(0, 1, 0));
  const ThinnestAxis alike = thinnest_axis(Eigen::Matrix3d::Identity());
  EXPECT_EQ(alike.smallest, alike.middle);
  EXPECT_EQ(alike.axis.norm(), 1);
}

}  // namespace
}  // namespace remote_touch::point_surface_test
