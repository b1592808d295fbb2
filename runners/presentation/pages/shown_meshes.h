// Meshes, tools and cameras as a page shows them, in packed arrays of numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/dissertation/sphere_tree/sphere_tree.h"
#include "core/dissertation/tool_shape/voxel_tool.h"
#include "core/points/vector.h"
#include "scenarios/files/input_files.h"
#include "scenarios/scene/scenario.h"

namespace remote_touch {

// Arrays of numbers one after another, for a page to read: little endian, each at a multiple of eight bytes.
class PackedArrays {
 public:
  // Returns the position (its first byte), the type (f64, f32, i32, u32, u16 or u8) and the length of the
  // array in bytes(): {"at", "type", "length"}.
  template <class Number>
  Json add(const std::vector<Number>& values);
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

Json json_of(const Vec3& v);
// Returns the position, the viewing direction and the upward direction of the image, in the world frame.
Json sensor_json(const RigidTransform& X_WC);

// The tool of a run, as a page shows it.
struct ShownTool {
  std::shared_ptr<const VoxelTool> tool;
  std::shared_ptr<const ToolSpheres> spheres;  // null: its renderer has none
};

// renderer: the section of a resolved configuration, of a renderer with a tool. Throws as load_tool().
ShownTool shown_tool(const Json& renderer);

// Vertices and triangles of the mesh; of spheres, four numbers each: centre and radius.
Json json_of(const ShownTool& tool, PackedArrays& numbers);

// The true surface of a scene of meshes, as a page shows it: each mesh once, and its poses over time.

// A mesh whose vertices are nodes of a grid in the frame O of the object: low + step * number.
struct MeshOnGrid {
  Vec3 low_O = Vec3::Zero();
  double step_m = 0;
  std::vector<std::uint16_t> vertices;  // three numbers for each vertex
  std::vector<std::uint32_t> triangles;
};

// Moves every vertex to the nearest node of a grid, and merges those of one node. The grid is the finest one
// with 65536 nodes along the longest side of the mesh, or with half of that again and again until at most
// max_triangles have three different corners; the others are left out.
MeshOnGrid mesh_on_grid(const PosedMesh& mesh, std::size_t max_triangles);

// The pose of a mesh from one time to the next: position, then the orientation w, x, y, z, in the world
// frame. All are NaN if it is not known.
using ShownPose = std::array<float, 7>;

struct ShownMesh {
  std::string name;
  MeshOnGrid mesh;
  std::vector<double> time_s;  // one for each pose; the first is the first tick
  std::vector<ShownPose> poses;
};

inline constexpr std::size_t kMaxShownTriangles = 200'000;  // limit for all meshes together
inline constexpr std::size_t kMaxShownPoses = 20'000;       // limit for all meshes together

// time_s: the times of the ticks, at least one. A mesh has a pose for each tick at which its pose changes, so
// that the page shows the surface of signed_distance(). If that makes too many, the meshes with the most
// poses keep every nth. Returns nothing if the true surface is not one of meshes.
std::vector<ShownMesh> shown_meshes(const Scenario& scenario, std::span<const double> time_s);

// The same for a live run, whose end is not known: from time 0 to the end of the scene's motion, at ticks of
// this rate or at 2000 times. The last pose holds from then on. Returns nothing for a recording, whose poses
// may be repeated without an end, and which would have to be read as a whole.
std::vector<ShownMesh> shown_meshes_of_live(const Scenario& scenario, double haptic_rate_hz);

Json json_of(const ShownMesh& mesh, PackedArrays& numbers);
// A remark on the meshes that are drawn more coarsely than by 0.2 mm; empty: none is.
std::string note_on(const std::vector<ShownMesh>& meshes);

}  // namespace remote_touch
