// The tool that an experiment names: a built-in one or a mesh file, made once and then read from the cache.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/beyond/tracked_surface/tracked_renderers.h"
#include "core/dissertation/tool_motion/compared_motions.h"
#include "core/dissertation/tool_motion/sphere_tree.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/mesh/voxel_tool.h"
#include "core/parameters/parameter.h"
#include "core/rivals/inner_sphere_motion.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// The cache of tools on disk, so that the runs of a sweep do not make their tool again.

// Version of the layout of the file, in its first line.
inline constexpr int kToolFormat = 2;

// Returns the key of the tool in the cache: a hash of all that the tool depends on. This is the build of the
// program, a SHA-256 of the mesh (or of the file from which it is read), and the settings, to the last bit.
std::string tool_key(const std::string& mesh_sha256, const VoxelToolSettings& settings);
std::string sha256_of_mesh(const TriangleMesh& mesh);

// The content that is stored under a key: the tool, bit for bit, and the report from when it was made.
struct StoredTool {
  VoxelTool tool;
  std::string report;
};

// Returns nothing if there is no such file, or if it is damaged, cut off, or of another key. The SHA-256 of
// the file is verified.
std::optional<StoredTool> read_tool(const std::filesystem::path& folder, const std::string& key);

// Writes the file under a temporary name and renames it, so that other processes see the whole file or none.
// Creates the folder. Returns false if the file cannot be written, which is not an error.
bool write_tool(const std::filesystem::path& folder, const std::string& key, const StoredTool& stored);

// The cache of the tools' sphere trees on disk, in the folder of the tools' cache.

// Version of the layout of the file, in its first line.
inline constexpr int kSpheresFormat = 1;

// Returns the key of the spheres. It is made from max_leaves and the key of the tool, which has the build.
std::string spheres_key(const std::string& tool_key, int max_leaves);

// These functions do for spheres what read_tool() and write_tool() do for tools.
std::optional<ToolSpheres> read_spheres(const std::filesystem::path& folder, const std::string& key);
bool write_spheres(const std::filesystem::path& folder, const std::string& key, const ToolSpheres& spheres);

// The tool of an experiment as settings.
struct ToolSettings {
  std::string mesh = "husky";
  double size_m = 0;
  double voxel_m = 5e-4;
  bool repair = false;
  bool outer_field = false;  // no parameter: a renderer that needs it sets it
};

Parameters parameters(ToolSettings& settings);  // tool_mesh, tool_size_m, tool_voxel_m, tool_repair
std::string validate(const ToolSettings& settings);

// Returns the mesh file on which the result depends; none for a built-in tool.
std::vector<InputPart> input_files(const ToolSettings& settings);

// Returns the tool. A mesh file is searched for by find_input(). A built-in tool takes precedence over a file
// of its name. Throws MissingInput if there is neither. Throws InputError where read_mesh() and
// make_voxel_tool() do. report: receives text(ToolReport) of the time when the tool was made; may be null.
std::shared_ptr<const VoxelTool> load_tool(const ToolSettings& settings, std::string* report = nullptr);

// The same tool with its sphere tree. The tree is made once for each number of leaves, and stored in the
// cache beside the tool.
struct ToolOfSpheres {
  std::shared_ptr<const VoxelTool> tool;
  std::shared_ptr<const ToolSpheres> spheres;
};
ToolOfSpheres load_tool_of_spheres(const ToolSettings& settings, int max_leaves,
                                   std::string* report = nullptr);

// 6-DOF renderers for experiments: a tool made from a mesh, and one of five motions. These are the motion of
// chapter 6, the same on tracked sheets, and three motions for comparison: penalty, god-object and inner
// spheres.

// MotionSettings: ToolParameters, TrackedToolParameters, ToolPenaltyParameters, ToolGodObjectParameters or
// InnerSphereParameters.
template <class MotionSettings>
struct MovedToolSettings {
  ToolSettings tool;
  MotionSettings motion;
};

// Passes every call on to a renderer of another class.
class LoadedRenderer : public Renderer {
 public:
  void prepare(Frame& frame) const override { renderer_->prepare(frame); }
  void reserve(std::size_t points) override { renderer_->reserve(points); }
  void on_frame(const Frame& frame) override { renderer_->on_frame(frame); }
  Parameters live_parameters() override { return renderer_->live_parameters(); }
  void parameters_changed() override { renderer_->parameters_changed(); }
  RenderOutput step(const DeviceState& device, double time_s) override {
    return renderer_->step(device, time_s);
  }

 protected:
  explicit LoadedRenderer(std::unique_ptr<Renderer> renderer) : renderer_(std::move(renderer)) {}

 private:
  std::unique_ptr<Renderer> renderer_;
};

template <class MotionSettings>
class ToolFromMesh final : public LoadedRenderer {
 public:
  using Settings = MovedToolSettings<MotionSettings>;

  // Throws InputError when the tool cannot be made.
  ToolFromMesh(const Settings& settings, double haptic_rate_hz, const Kernels& kernels);
};

using LoadedTool = ToolFromMesh<ToolParameters>;
using LoadedTrackedTool = ToolFromMesh<TrackedToolParameters>;
using LoadedToolPenalty = ToolFromMesh<ToolPenaltyParameters>;
using LoadedToolGodObject = ToolFromMesh<ToolGodObjectParameters>;
using LoadedToolInnerSpheres = ToolFromMesh<InnerSphereParameters>;

template <class MotionSettings>
Parameters parameters(MovedToolSettings<MotionSettings>& s) {
  return appended(parameters(s.tool), parameters(s.motion));
}
template <class MotionSettings>
std::string validate(const MovedToolSettings<MotionSettings>& s) {
  const std::string tool = validate(s.tool);
  return tool.empty() ? validate(s.motion) : tool;
}
template <class MotionSettings>
std::vector<InputPart> input_files(const MovedToolSettings<MotionSettings>& s) {
  return input_files(s.tool);
}
template <class MotionSettings>
double max_stiffness_N_per_m(const MovedToolSettings<MotionSettings>& s) {
  return max_stiffness_N_per_m(s.motion);
}
template <class MotionSettings>
RenderedContact rendered_contact(const MovedToolSettings<MotionSettings>&) {
  return RenderedContact::unknown();
}

// The 6-DOF fixture renderer for experiments, chapter 7: a tool of spheres made from a mesh, and its motion.
class LoadedSpheres final : public LoadedRenderer {
 public:
  struct Settings {
    ToolSettings tool{.mesh = "key"};
    int leaves = 112;
    // Regions are round, so each step of the motion covers only a fraction of the way to its end. A tick ends
    // when a step is shorter than a hundredth of a millimetre, which is less than a hand can feel. When a
    // frame has enclosed the tool, about ten detections lead out. Ticks that need many more slide along
    // creases, and the motion can continue in the next tick.
    ToolParameters motion{.detections_per_tick = 30, .rest_threshold_m = 1e-5};
  };

  // Throws InputError when the tool cannot be made.
  LoadedSpheres(const Settings& settings, double haptic_rate_hz, const Kernels& kernels);
};

Parameters parameters(LoadedSpheres::Settings& s);
std::string validate(const LoadedSpheres::Settings& s);
std::vector<InputPart> input_files(const LoadedSpheres::Settings& s);
inline double max_stiffness_N_per_m(const LoadedSpheres::Settings& s) {
  return max_stiffness_N_per_m(s.motion);
}
inline RenderedContact rendered_contact(const LoadedSpheres::Settings&) {
  return RenderedContact::unknown();
}

}  // namespace remote_touch
