// A scene of one box from a file, with its true distance in closed form.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::box_scene {

using Settings = MeshSceneFromFiles::Settings;

// A box in the middle of nowhere. Its coordinates have single precision.
inline const Vec3 kSides_m(0.25, 0.125, 0.5), kCentre_m(1, 2, -3);

inline std::string obj_of(const TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3& v : mesh.vertices) text << "v " << v.x() << " " << v.y() << " " << v.z() << "\n";
  for (const auto& [a, b, c] : mesh.triangles) text << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  return text.str();
}

inline TriangleMesh sheet() {  // faces +y
  return {{{-0.25, 0, 0.25}, {0.25, 0, 0.25}, {0.25, 0, -0.25}, {-0.25, 0, -0.25}}, {{0, 1, 2}, {0, 2, 3}}};
}

inline TriangleMesh sphere(double radius_m) {
  constexpr int kRings = 47, kSectors = 96;
  TriangleMesh mesh{{Vec3(0, radius_m, 0), Vec3(0, -radius_m, 0)}, {}};
  for (int i = 1; i <= kRings; ++i)
    for (int j = 0; j < kSectors; ++j) {
      const double u = std::numbers::pi * i / (kRings + 1), v = 2 * std::numbers::pi * j / kSectors;
      mesh.vertices.push_back(radius_m *
                              Vec3(std::sin(u) * std::sin(v), std::cos(u), std::sin(u) * std::cos(v)));
    }
  const auto at = [](int i, int j) { return 2 + (i - 1) * kSectors + j % kSectors; };
  for (int j = 0; j < kSectors; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({1, at(kRings, j + 1), at(kRings, j)});
    for (int i = 1; i < kRings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

inline double distance_to_box(const Vec3& p, const Vec3& centre, const Vec3& sides) {
  const Vec3 beyond = (p - centre).cwiseAbs() - 0.5 * sides;
  return beyond.cwiseMax(0.0).norm() + std::min(0.0, beyond.maxCoeff());
}

// Positions around the box, inside of it, and at its corners.
inline std::vector<Vec3> positions_around(const Vec3& centre, const Vec3& sides) {
  std::vector<Vec3> positions;
  for (const double x : {-0.62, -0.3, 0.1, 0.7})
    for (const double y : {-0.6, 0.05, 0.45, 0.9})
      for (const double z : {-0.55, -0.4, 0.2, 0.53})
        positions.push_back(centre + sides.cwiseProduct(Vec3(x, y, z)));
  return positions;
}

inline RigidTransform turned(const Vec3& rotation_deg, const Vec3& position_m = Vec3::Zero()) {
  return Eigen::Translation3d(position_m) * rotation(kRadiansPerDegree * rotation_deg);
}

inline std::string names_of(const std::vector<InputPart>& parts) {
  std::string names;
  for (const InputPart& part : parts)
    for (const InputFile& file : files_of(part)) names += file.name + " ";
  return names;
}

class BoxScene : public testing::Test {
 protected:
  std::string write(const std::string& name, const TriangleMesh& mesh) const {
    return folder_.write(name, obj_of(mesh)).string();
  }
  // The box without a table and without errors of the sensor, in a small image.
  Settings box_alone() const {
    Settings s;
    s.objects[0] = {.mesh = write("box.obj", box_mesh(kSides_m, kCentre_m))};
    s.table = false;
    DepthCameraSettings& camera = s.scene.sensor.camera;
    camera.width = 96, camera.height = 72, camera.focal_px = 80;
    camera.noise_per_m = 0, camera.quantisation_per_m = 0, camera.hole_px = 0;
    return s;
  }
  static MeshSceneFromFiles made(const Settings& s, std::uint64_t seed = 1) {
    EXPECT_EQ(validate(s), "");
    return {s, NoiseKey{seed}, scenes::kernels()};
  }
  // Expects that the scene has the box at a pose X_WB of its middle, and nothing else.
  static void expect_box(const MeshSceneFromFiles& scene, double time_s, const RigidTransform& X_WB,
                         const Vec3& sides = kSides_m) {
    for (const Vec3& p_B : positions_around(Vec3::Zero(), sides))
      EXPECT_NEAR(scene.signed_distance(X_WB * p_B, time_s), distance_to_box(p_B, Vec3::Zero(), sides), 1e-9)
          << time_s << " s: " << p_B.transpose();
  }
  std::string refused(const Settings& s) const {
    return refusal([&] { made(s); });
  }
  // Returns the reason for which a mesh is refused as the second object.
  std::string refused(const std::string& name, const TriangleMesh& mesh) const {
    Settings s = box_alone();
    s.objects[1].mesh = write(name, mesh);
    return refused(s);
  }

  TestFolder folder_{"mesh_scene_from_files"};
};

}  // namespace remote_touch::box_scene
