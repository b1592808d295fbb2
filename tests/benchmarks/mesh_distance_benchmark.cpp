// The signed distance to a mesh, at positions within 10 mm of its surface. Before it is timed, distances are
// compared with those to every triangle, and signs with the sum of all solid angles. Two others are timed at
// the same positions, without a sign: the tree of discs that the tools use (TriangleTree), and a loop over
// all triangles.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/mesh/mesh_distance.h"
#include "core/mesh/triangle_tree.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/support/meshes.h"

namespace remote_touch::benchmarks {
namespace {

constexpr double kNear_m = 0.01;
constexpr int kPositions = 8192, kChecked = 200;

// A ball of 0.1 m radius with waves of 3 mm, in rings x sectors cells of two triangles.
TriangleMesh wavy_ball(int rings, int sectors) {
  const auto at = [&](double u, double v) {
    const double r = 0.1 + 0.003 * std::sin(9 * u) * std::cos(12 * v);
    return Vec3(r * std::sin(u) * std::cos(v), r * std::sin(u) * std::sin(v), r * std::cos(u));
  };
  TriangleMesh mesh{{at(0, 0), at(std::numbers::pi, 0)}, {}};
  for (int i = 1; i <= rings; ++i)
    for (int j = 0; j < sectors; ++j)
      mesh.vertices.push_back(at(std::numbers::pi * i / (rings + 1), 2 * std::numbers::pi * j / sectors));
  const auto number = [=](int i, int j) { return 2 + (i - 1) * sectors + j % sectors; };
  for (int j = 0; j < sectors; ++j) {
    mesh.triangles.push_back({0, number(1, j), number(1, j + 1)});
    mesh.triangles.push_back({1, number(rings, j + 1), number(rings, j)});
    for (int i = 1; i < rings; ++i) {
      mesh.triangles.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      mesh.triangles.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  }
  return mesh;
}

// Positions at random heights of up to kNear_m above and below random triangles, each equally likely.
std::vector<Vec3> positions_near(const TriangleMesh& mesh) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, mesh.triangles.size() - 1);
  std::uniform_real_distribution<double> part(0, 1), height(-kNear_m, kNear_m);
  std::vector<Vec3> positions;
  while (positions.size() < kPositions) {
    const auto& [i, j, k] = mesh.triangles[any(random)];
    const Vec3 &a = mesh.vertices[i], ab = mesh.vertices[j] - a, ac = mesh.vertices[k] - a;
    const double u = part(random), v = part(random) * (1 - u);
    positions.push_back(a + u * ab + v * ac + height(random) * ab.cross(ac).normalized());
  }
  return positions;
}

struct Body {
  Body(std::string name_, const TriangleMesh& mesh_)
      : name(std::move(name_)), mesh(mesh_), positions(positions_near(mesh)), surface(mesh), discs(mesh) {}
  std::string name;
  TriangleMesh mesh;
  std::vector<Vec3> positions;
  MeshDistance surface;
  TriangleTree discs;
};

bool distances_right(const Body& body) {
  for (int i = 0; i < kChecked; ++i) {
    const Vec3& p = body.positions[i];
    const double expected = meshes::distance(body.mesh, p);
    const auto nearest = body.surface.nearest(p, 1);
    if (!nearest || !(std::abs(std::abs(nearest->distance_m) - expected) < 1e-12)) return false;
    if (!(std::abs(std::sqrt(body.discs.nearest(p, 0).squared_m2) - expected) < 1e-12)) return false;
    if (expected > 1e-6 && (nearest->distance_m < 0) != (meshes::winding(body.mesh, p) > 0.5)) return false;
  }
  return true;
}

// reach_m: 0.03 is the default of truth_reach_m.
void add_body(const std::shared_ptr<const Body>& body) {
  const std::string of = body->name + "_" + std::to_string(body->mesh.triangles.size());
  const auto is_right = [=] { return distances_right(*body); };
  add("mesh_distance/" + of, is_right, [=](benchmark::State& state) {
    std::size_t i = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(body->surface.nearest(body->positions[i], 0.03));
      i = (i + 1) % kPositions;
    }
  });
  add("mesh_distance_by_discs/" + of, is_right, [=](benchmark::State& state) {
    std::size_t i = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(body->discs.nearest(body->positions[i], 0));
      i = (i + 1) % kPositions;
    }
  });
  add("mesh_distance_plain/" + of, [=](benchmark::State& state) {
    std::size_t i = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(meshes::distance(body->mesh, body->positions[i]));
      i = (i + 1) % kPositions;
    }
  });
  add("mesh_distance_build/" + of, [=](benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(MeshDistance(body->mesh).vertices().data());
  });
}

// Adds a mesh of the folder of data, if it is there. scale: metres of a unit of the file.
void add_file(const std::string& name, const std::string& file, double scale) {
  const char* named = std::getenv("REMOTE_TOUCH_DATA");
  const auto path = std::filesystem::path(named != nullptr ? named : "../shared/data") / file;
  if (!std::filesystem::exists(path)) return;
  TriangleMesh mesh = read_mesh(path);
  for (Vec3& v : mesh.vertices) v *= scale;
  add_body(std::make_shared<const Body>(name, mesh));
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch::benchmarks;
  add_body(std::make_shared<const Body>("ball", wavy_ball(75, 100)));
  add_body(std::make_shared<const Body>("ball", wavy_ball(140, 250)));
  add_file("dragon", "rgbd/visp_cube_dragon/truth/dragon.obj", 1);
  add_file("hand", "meshes/hand_closed.obj", 0.2);
  add_file("drill", "meshes/ycb_power_drill.obj", 1);
  return run_benchmarks(argc, argv);
}
