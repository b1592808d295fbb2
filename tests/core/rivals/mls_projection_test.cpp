// The moving least squares surface against a quadric, and against sums and solvers written without the
// product's code.
#include "core/rivals/mls_surface_renderer.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/points/vector.h"
#include "tests/support/scenes.h"

namespace remote_touch::mls_projection_test {
namespace {

constexpr double kH = 0.0045;
const Vec3 kNone = Vec3::Zero(), kUp = Vec3::UnitY();

Neighbourhood near_of(const PointCloud& cloud, double h = kH) {
  return scenes::neighbourhood(make_search(cloud), MlsProjection::kSupportInWidths * h);
}

// Normally distributed numbers; their bits need not be the same everywhere.
class Normals {
 public:
  explicit Normals(unsigned seed) : random_(seed) {}
  double next() { return distribution_(random_); }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> distribution_;
};

// A smooth surface over an irregular sample of x and z, with noise along y.
PointCloud bumps(unsigned seed, double noise_m = 0) {
  PointCloud cloud = scenes::random_cloud(4000, 0.04, seed);
  Normals noise(seed);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.y[i] = 0.002 * std::sin(cloud.x[i] / 0.012) * std::cos(cloud.z[i] / 0.015) + noise_m * noise.next();
  return cloud;
}

// Positions up to height_m from the plane y = 0, away from the border of bumps().
std::vector<Vec3> positions(int count, double height_m, unsigned seed) {
  const PointCloud cloud = scenes::random_cloud(count, 1, seed);
  std::vector<Vec3> list;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    list.push_back(cloud.point(i).cwiseProduct(Vec3(0.02, height_m, 0.02)));
  return list;
}

double brute_weight(double distance_m) {
  const double R = 2.5 * kH;
  return distance_m < R ? std::exp(-distance_m * distance_m / (kH * kH)) - std::exp(-6.25) : 0;
}

// e(n, t), in m^2.
double energy(const PointCloud& cloud, const Vec3& r, const Vec3& n, double t_m) {
  const Vec3 q = r + t_m * n;
  double sum = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 e = cloud.point(i) - q;
    sum += brute_weight(e.norm()) * n.dot(e) * n.dot(e);
  }
  return sum;
}

// q + g(0, 0) n by a QR decomposition of the weighted equations.
Vec3 foot_by_qr(const PointCloud& cloud, const MlsPlane& plane, int degree) {
  const Vec3 u = plane.normal_W.unitOrthogonal(), v = plane.normal_W.cross(u);
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (brute_weight((cloud.point(i) - plane.q_W).norm()) > 0) used.push_back(i);
  const auto rows = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd columns(rows, degree == 2 ? 6 : 3);
  Eigen::VectorXd heights(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const Vec3 e = (cloud.point(used[static_cast<std::size_t>(k)]) - plane.q_W) / kH;
    const double root = std::sqrt(brute_weight(kH * e.norm())), a = u.dot(e), b = v.dot(e);
    columns.row(k).head<3>() = root * Eigen::RowVector3d(1, a, b);
    if (degree == 2) columns.row(k).tail<3>() = root * Eigen::RowVector3d(a * a, a * b, b * b);
    heights[k] = root * plane.normal_W.dot(e);
  }
  const Eigen::VectorXd solution = columns.colPivHouseholderQr().solve(heights);
  return plane.q_W + kH * solution[0] * plane.normal_W;
}

TEST(MlsProjection, NegativeExponentialIsExp) {
  for (int i = 0; i <= 800; ++i) {
    const double x = 0.01 * i;
    EXPECT_NEAR(negative_exponential(x) / std::exp(-x), 1, 3e-14) << x;
  }
}

TEST(MlsProjection, SampleIsThatOfBruteForceSums) {
  const MlsProjection surface(kH, 2);
  int compared = 0;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const PointCloud cloud = bumps(seed, 0.0005);
    Neighbourhood near = near_of(cloud);
    for (const Vec3& x : positions(40, 0.008, seed + 10)) {
      double weight = 0;
      Vec3 mean = kNone;
      Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vec3 e = cloud.point(i) - x;
        const double w = brute_weight(e.norm());
        weight += w, mean += w * e, squares += w * e * e.transpose();
      }
      mean /= weight;
      const Eigen::Matrix3d covariance = squares / weight - mean * mean.transpose();
      const Vec3 axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
      const Vec3 n = axis.y() < 0 ? Vec3(-axis) : axis;
      const MlsSample here = surface.sample(near, x, kUp);
      EXPECT_NEAR(here.weight, weight, 1e-10);
      if (!here.supported) continue;
      ++compared;
      EXPECT_NEAR(here.value_m, -n.dot(mean), 1e-10);
      EXPECT_NEAR((here.normal_W - n).norm(), 0, 1e-8);
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(MlsProjection, WithoutASideFIsNotNegative) {
  const PointCloud cloud = scenes::flat_grid(40);
  Neighbourhood near = near_of(cloud);
  const MlsProjection surface(kH, 2);
  for (const double y : {-0.004, 0.004}) {
    EXPECT_NEAR(surface.sample(near, {0, y, 0}, kNone).value_m, 0.004, 1e-12);
    EXPECT_NEAR(surface.sample(near, {0, y, 0}, kUp).value_m, y, 1e-12);
    EXPECT_NEAR(surface.sample(near, {0, y, 0}, -kUp).value_m, -y, 1e-12);
  }
}

// A quadric over a plane, sampled symmetrically about its vertex: the reference plane is tangential there, so
// the polynomial of degree 2 is the quadric itself. A plane misses the vertex by the sag of the points.
TEST(MlsProjection, AQuadricIsExactAtItsVertex) {
  const Eigen::Quaterniond turn = rotation(Vec3(0.4, -0.7, 0.5));
  for (const Vec3& curvature : {Vec3(10, 3, 6), Vec3(-8, 4, 8), Vec3(6, -5, 0)}) {
    PointCloud cloud;
    for (int i = -20; i <= 20; ++i)
      for (int j = -20; j <= 20; ++j) {
        const double x = 0.001 * i, z = 0.0012 * j;
        const double y = curvature.x() * x * x + curvature.y() * x * z + curvature.z() * z * z;
        cloud.append(turn * Vec3(x, y, z));
      }
    Neighbourhood near = near_of(cloud);
    const Vec3 up = turn * kUp, start = turn * Vec3(0.1, 1, -0.15).normalized();
    for (const double height : {-0.003, 0.0, 0.004}) {
      const MlsFoot foot = MlsProjection(kH, 2).project(near, height * up, start);
      ASSERT_TRUE(foot.found);
      EXPECT_NEAR(foot.p_W.dot(up), 0, 1e-14) << curvature.transpose() << ", " << height;
      EXPECT_NEAR(foot.p_W.norm(), 0, 1e-9) << "beside the vertex: the plane has converged to 1e-6";
      EXPECT_NEAR((foot.normal_W - up).norm(), 0, 1e-7) << curvature.transpose() << ", " << height;
    }
    const MlsFoot flat = MlsProjection(kH, 1).project(near, 0.001 * up, start);
    const double mean_sag_m = 0.5 * (curvature.x() + curvature.z()) * kH * kH;
    EXPECT_NEAR(flat.p_W.dot(up), mean_sag_m, 0.1 * std::abs(mean_sag_m) + 2e-6) << curvature.transpose();
  }
}

// The mean of the points of a half plane, seen from s h beyond its edge, is at exp(-s^2) / (sqrt(pi) erfc(s))
// in units of h, without the cut at R. It is 0.75 at s = 0.27.
TEST(MlsProjection, TheSurfaceEndsBeyondTheLastPoints) {
  PointCloud cloud;
  for (int i = -40; i <= 0; ++i)
    for (int j = -40; j <= 40; ++j) cloud.append({0.0004 * (i - 0.5), 0, 0.0004 * j});
  Neighbourhood near = near_of(cloud);
  const MlsProjection surface(kH, 2);
  for (const double s : {-2.0, -0.5, 0.0, 0.1, 0.2}) {
    EXPECT_TRUE(surface.project(near, {s * kH, 0.001, 0}, kUp).found) << s;
    EXPECT_TRUE(surface.sample(near, {s * kH, 0.001, 0}, kUp).supported) << s;
  }
  for (const double s : {0.4, 0.5, 1.0, 2.0, 3.0}) {
    const Vec3 x(s * kH, 0.001, 0);
    EXPECT_FALSE(surface.project(near, x, kUp).found) << s;
    EXPECT_EQ(surface.project(near, x, kUp).p_W, x) << s;
    EXPECT_FALSE(surface.sample(near, x, kUp).supported) << s;
  }
}

// The derivatives of e along n, and for turns of n about r, vanish at the reference plane.
TEST(MlsProjection, TheReferencePlaneIsALocalMinimum) {
  const PointCloud cloud = bumps(4, 0.0003);
  Neighbourhood near = near_of(cloud);
  const MlsProjection surface(kH, 2);
  constexpr double kStep = 1e-4;
  for (const Vec3& r : positions(20, 0.004, 6)) {
    const MlsPlane plane = surface.reference_plane(near, r, kUp);
    ASSERT_TRUE(plane.found);
    const Vec3 n = plane.normal_W, u = n.unitOrthogonal();
    const double t = n.dot(plane.q_W - r), least = energy(cloud, r, n, t);
    EXPECT_NEAR((plane.q_W - r - t * n).norm(), 0, 1e-15);
    const auto expect_minimum = [&](double less, double more, const char* what) {
      const double curvature = less + more - 2 * least;  // e'' step^2
      EXPECT_GT(curvature, 0) << what;
      EXPECT_NEAR(0.5 * (more - less), 0, 1e-3 * curvature) << what;  // the minimum is within step / 1000
    };
    expect_minimum(energy(cloud, r, n, t - kStep * kH), energy(cloud, r, n, t + kStep * kH), "along n");
    for (const Vec3& axis : {u, Vec3(n.cross(u))})
      expect_minimum(energy(cloud, r, rotation(-kStep * axis) * n, t),
                     energy(cloud, r, rotation(kStep * axis) * n, t), "turned");
  }
}

TEST(MlsProjection, TheFootIsAFixedPointOfTheProjectionByQr) {
  for (const int degree : {1, 2}) {
    const MlsProjection surface(kH, degree);
    const PointCloud cloud = bumps(7, 0.0002);
    Neighbourhood near = near_of(cloud);
    for (const Vec3& x : positions(20, 0.004, 8)) {
      const MlsFoot foot = surface.project(near, x, kUp);
      ASSERT_TRUE(foot.found);
      const MlsPlane plane = surface.reference_plane(near, foot.p_W, kUp);
      EXPECT_NEAR((foot_by_qr(cloud, plane, degree) - foot.p_W).norm(), 0, 1e-9) << degree;
    }
  }
}

// Noise as large as h leaves no minimum of e. The plane of the weighted mean is used, and found.
TEST(MlsProjection, MuchNoiseStillHasASurface) {
  PointCloud cloud = scenes::flat_grid(100);
  Normals noise(3);
  for (double& y : cloud.y) y = kH * noise.next();
  Neighbourhood near = near_of(cloud);
  int found = 0;
  double sum = 0;
  for (const Vec3& x : positions(100, 0.0, 11)) {
    const MlsFoot foot = MlsProjection(kH, 1).project(near, x, kUp);
    if (foot.found) ++found, sum += std::abs(foot.p_W.y());
  }
  EXPECT_GE(found, 97);
  EXPECT_LT(sum / found, 0.5 * kH);
}

TEST(MlsProjection, PointsThatSpanNoPlaneHaveNoSurface) {
  const MlsProjection surface(kH, 2);
  PointCloud cloud;
  const auto expect_none = [&] {
    Neighbourhood near = near_of(cloud);
    const Vec3 x(0.0001, 0.001, 0);
    EXPECT_FALSE(surface.project(near, x, kUp).found) << cloud.size();
    EXPECT_FALSE(surface.project(near, x, kNone).found) << cloud.size();
    EXPECT_EQ(surface.project(near, x, kUp).p_W, x) << cloud.size();
    EXPECT_FALSE(surface.sample(near, x, kUp).supported) << cloud.size();
  };
  expect_none();
  for (const double x : {0.0, 0.003, -0.003}) {
    cloud.append({x, 0, 0});
    expect_none();
  }
  cloud = scenes::cloud_of({Vec3::Constant(std::nan(""))});
  expect_none();
}

// Four points have a plane but no polynomial of degree 2: degree 1 replaces it.
TEST(MlsProjection, TooFewPointsLowerTheDegree) {
  const PointCloud cloud = scenes::cloud_of({{0.002, 0, 0}, {-0.002, 0, 0}, {0, 0, 0.002}, {0, 0, -0.002}});
  Neighbourhood near = near_of(cloud);
  const MlsFoot foot = MlsProjection(kH, 2).project(near, {0.0003, 0.002, -0.0004}, kUp);
  ASSERT_TRUE(foot.found);
  EXPECT_NEAR((foot.p_W - Vec3(0.0003, 0, -0.0004)).norm(), 0, 1e-11);
}

}  // namespace
}  // namespace remote_touch::mls_projection_test
