// The collision list compared with the collision detection of Bullet and FCL.
// There are 2500 points, and the tool touches them and is pressed in. Other libraries find the points that
// the surface passes through, and ours finds those in shell and interior voxels, so there is no one right
// list. Each is judged by the exact distance of the points to the mesh, in poses that are raised, lowered and
// shifted:
// - ours has every point that is more than half a voxel's diagonal inside and none that is as far outside,
//   and is the list of the plain loop over all points;
// - others find every body with corners on both sides of the surface, and none whose point is farther from
//   the surface than ToolPeer states;
// - all find nothing away from the points.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/tool_motion/touch_finder.h"
#include "core/kernels/kernels.h"
#include "core/mesh/triangle_tree.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/peers/peer_tool.h"
#include "tests/benchmarks/tool_scene.h"
#include "tests/support/cloud_form.h"

namespace remote_touch::benchmarks {
namespace {

constexpr double kUndecided_m = 1e-5;  // others compute in float, or iterate up to 1e-6
constexpr double kPressed_m = 2e-3;
constexpr int kMinCrossing = 100;  // bodies in all poses; the comparison shows too little with fewer

peers::Coordinates coordinates(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

peers::Pose plain(const ToolPose& pose) {
  const Eigen::Matrix3d R = pose.q_WT.toRotationMatrix();
  return {coordinates(pose.p_W),
          {R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)}};
}

peers::MeshAndPoints plain(const ToolScene& scene) {
  peers::MeshAndPoints all{{}, scene.tool->mesh.triangles, {}, {}};
  for (const Vec3& v : scene.tool->mesh.vertices) all.vertices.push_back(coordinates(v));
  for (std::size_t i = 0; i < scene.cloud.size(); ++i) {
    all.points_W.push_back(coordinates(scene.cloud.point(i)));
    all.normals_W.push_back(coordinates(scene.cloud.normal(i)));
  }
  return all;
}

ToolPose lowered(ToolPose pose, double by_m) {
  pose.p_W.y() -= by_m;
  return pose;
}

// --- references ---

// The reference: distances to the mesh itself, without voxels and without the distance field.
class Surface {
 public:
  explicit Surface(const ToolScene& scene) : scene_(scene), tree_(scene.tool->mesh) {}

  double signed_m(const ToolPose& pose, const Vec3& p_W) const {
    const Vec3 p_T = pose.q_WT.conjugate() * (p_W - pose.p_W);
    const double distance = std::sqrt(tree_.nearest(p_T, 0).squared_m2);
    return tree_.winding_number(p_T) > 0.5 ? -distance : distance;
  }
  bool crosses(const ToolPose& pose, const std::vector<peers::Coordinates>& corners_W) const {
    bool inside = false, outside = false;
    for (const peers::Coordinates& corner : corners_W) {
      const double d = signed_m(pose, {corner[0], corner[1], corner[2]});
      inside = inside || d < -kUndecided_m, outside = outside || d > kUndecided_m;
    }
    return inside && outside;
  }
  const ToolScene& scene() const { return scene_; }

  // Poses from slightly above the points to 4 mm into them, each over other points.
  std::vector<ToolPose> poses() const {
    std::vector<ToolPose> all;
    for (int i = 0; i < 12; ++i) {
      all.push_back(lowered(scene_.in_contact, 4e-4 * i - 1e-3));
      all.back().p_W.x() += 7e-4 * i;
    }
    return all;
  }

 private:
  const ToolScene& scene_;
  TriangleTree tree_;
};

bool ours_right(const TouchFinder& finder, const Surface& surface) {
  const ToolScene& scene = surface.scene();
  // A voxel is on one side or the other by the field in its centre, which is exact to a tenth of a voxel.
  const double undecided = (std::sqrt(3.0) / 2 + 0.1) * scene.tool->grid.size_m;
  for (const ToolPose& pose : surface.poses()) {
    if (!list_right(finder, scene, pose)) return false;
    // These are the same points by their numbers in the cloud, which the finder does not keep.
    const std::vector<std::uint32_t> list = naive_list(*scene.tool, scene.cloud, pose);
    const std::set<std::uint32_t> found(list.begin(), list.end());
    for (std::uint32_t i = 0; i < scene.cloud.size(); ++i) {
      const double d = surface.signed_m(pose, scene.cloud.point(i));
      if (found.contains(i) ? d > undecided : d < -undecided) return false;
    }
  }
  return finder.in_tool(scene.separated).empty();
}

bool right(const peers::ToolPeer& peer, const Surface& surface) {
  int crossing = 0;
  for (const ToolPose& pose : surface.poses()) {
    peer.touch(plain(pose));
    const std::vector<std::size_t> touched = peer.touched();
    const std::set<std::size_t> found(touched.begin(), touched.end());
    for (std::size_t i = 0; i < peer.bodies_W.size(); ++i) {
      const double d = surface.signed_m(pose, surface.scene().cloud.point(i));
      const bool in_reach = d <= peer.max_outside_m + kUndecided_m && -d <= peer.max_inside_m + kUndecided_m;
      if (found.contains(i) && !in_reach) return false;
      if (!in_reach || !surface.crosses(pose, peer.bodies_W[i])) continue;
      if (!found.contains(i)) return false;
      ++crossing;
    }
  }
  return crossing >= kMinCrossing && peer.touch(plain(surface.scene().separated)) == 0;
}

// --- time ---

void add_ours(const Surface& surface, const std::string& where, const ToolPose& pose) {
  for (const Kernels* kernels : supported_kernels()) {
    const auto finder = std::make_shared<TouchFinder>(surface.scene().tool, *kernels);
    finder->on_frame(in_form<TiledCloud>(surface.scene().cloud));
    add(
        "list/" + where + "/ours/" + kernels->isa, [=, &surface] { return ours_right(*finder, surface); },
        [=](benchmark::State& state) {
          int i = 0;
          for (auto _ : state) {
            finder->in_tool(shaken(pose, i++));
            benchmark::ClobberMemory();
          }
        });
  }
}

void add_peer(const peers::ToolPeer& peer, const Surface& surface, const std::string& where,
              const ToolPose& pose) {
  add(
      "list/" + where + "/" + peer.name, [&] { return right(peer, surface); },
      [=, &peer](benchmark::State& state) {
        int i = 0;
        for (auto _ : state) benchmark::DoNotOptimize(peer.touch(plain(shaken(pose, i++))));
      });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const ToolScene scene = tool_scene("2500", generated_tool("husky"), 50, 2e-3);
  const Surface surface(scene);
  const std::vector<peers::ToolPeer> others = peers::tool_peers(plain(scene));
  const std::vector<std::pair<std::string, ToolPose>> poses = {
      {"contact", scene.in_contact}, {"pressed", lowered(scene.in_contact, kPressed_m)}};
  for (const auto& [where, pose] : poses) {
    add_ours(surface, where, pose);
    for (const peers::ToolPeer& peer : others) add_peer(peer, surface, where, pose);
  }
  return run_benchmarks(argc, argv);
}
