// The depth image of a ball with 70 000 triangles, seen by a camera of 640 x 480 pixels, on one thread; and
// the same with a table that fills the image. Before it is timed, the image is compared with a ray cast over
// all triangles, at one pixel in a thousand.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/geometry/rotation.h"
#include "core/mesh/triangle_mesh.h"
#include "scenarios/meshes/mesh_scene.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/support/depth_scenes.h"

namespace remote_touch::benchmarks {
namespace {

// A dented ball of rings, counter-clockwise seen from outside.
TriangleMesh dented_ball(double radius, int rings, int columns) {
  TriangleMesh ball;
  for (int ring = 0; ring <= rings; ++ring)
    for (int column = 0; column < columns; ++column) {
      const auto [s, c] = sin_cos(3.14159265358979 * ring / rings);
      const auto [t, d] = sin_cos(2 * 3.14159265358979 * column / columns);
      const double dent = 1 - 0.1 * s * sin_cos(9 * 2 * 3.14159265358979 * column / columns).first;
      ball.vertices.push_back(radius * dent * Vec3(s * d, c, s * t));
    }
  const auto vertex = [columns](int ring, int column) { return ring * columns + column % columns; };
  for (int ring = 0; ring < rings; ++ring)
    for (int column = 0; column < columns; ++column) {
      const int a = vertex(ring, column), b = vertex(ring, column + 1), c = vertex(ring + 1, column),
                d = vertex(ring + 1, column + 1);
      if (ring > 0) ball.triangles.push_back({a, b, d});
      if (ring + 1 < rings) ball.triangles.push_back({a, d, c});
    }
  return ball;
}

// Depth of the first triangle on a ray whose z is 1.
double cast(const std::vector<RasterMesh>& meshes, const Vec3& ray_C) {
  double first = std::numeric_limits<double>::infinity();
  for (const RasterMesh& mesh : meshes)
    for (const auto& [i, j, k] : mesh.triangles) {
      const Vec3 a = mesh.X_CO * mesh.vertices_O[i], ab = mesh.X_CO * mesh.vertices_O[j] - a,
                 ac = mesh.X_CO * mesh.vertices_O[k] - a;
      const double determinant = ab.dot(ray_C.cross(ac));
      if (determinant == 0 || (mesh.is_closed && determinant < 0)) continue;
      const Vec3 q = Vec3(-a).cross(ab);
      const double u = (-a).dot(ray_C.cross(ac)) / determinant, v = ray_C.dot(q) / determinant;
      const double depth = ac.dot(q) / determinant;
      if (u >= 0 && v >= 0 && u + v <= 1 && depth > 0 && depth < first) first = depth;
    }
  return first;
}

bool is_that_of_casting(const CameraIntrinsics& camera, const std::vector<RasterMesh>& meshes) {
  const RasterImage image = depth_raster(camera, meshes);
  for (std::size_t i = 0; i < image.mesh.size(); i += 997) {
    const int u = static_cast<int>(i) % camera.width, v = static_cast<int>(i) / camera.width;
    const double expected = cast(meshes, scenes::ray(camera, u, v)), z = image.depth.z_m[i];
    if (std::isnan(z) != std::isinf(expected) || std::abs(z - expected) > 1e-6) return false;
  }
  return true;
}

void add_raster(const std::string& name, const std::vector<RasterMesh>& meshes) {
  const CameraIntrinsics camera = scenes::kinect();
  add(
      name, [=] { return is_that_of_casting(camera, meshes); },
      [=](benchmark::State& state) {
        omp_set_num_threads(1);
        for (auto _ : state) benchmark::DoNotOptimize(depth_raster(camera, meshes));
      });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  const TriangleMesh ball = benchmarks::dented_ball(0.12, 140, 252);  // 70 056 triangles
  const TriangleMesh table = {{{-3, 0.15, 3}, {3, 0.15, 3}, {3, 0.15, -3}, {-3, 0.15, -3}},
                              {{0, 1, 2}, {0, 2, 3}}};
  RigidTransform X_CO = RigidTransform::Identity();
  X_CO.linear() = rotation({0.9, 0.2, 0.1}).toRotationMatrix();
  X_CO.translation() = Vec3(0, 0, 0.45);
  const RasterMesh body{ball.vertices, ball.triangles, X_CO, true};
  benchmarks::add_raster("raster/ball", {body});
  benchmarks::add_raster("raster/ball_and_table", {body, {table.vertices, table.triangles, X_CO, false}});
  return benchmarks::run_benchmarks(argc, argv);
}
