#include "runners/experiment/mesh_files/loaded_tool.h"

#include <type_traits>

#include "core/dissertation/sphere_tree/sphere_tree_renderer.h"

namespace remote_touch {
namespace {

using Tool = std::shared_ptr<const VoxelTool>;

std::unique_ptr<Renderer> renderer_of(const ToolParameters& motion, const Tool& tool,
                                      const Kernels& kernels) {
  return std::make_unique<ToolRenderer>(motion, tool, kernels);
}
std::unique_ptr<Renderer> renderer_of(const TrackedToolParameters& motion, const Tool& tool,
                                      const Kernels& kernels) {
  return std::make_unique<TrackedToolRenderer>(motion, tool, kernels);
}

// The rules for comparison have settings of their own, none of which is live.
class ToolToCompare final : public ToolRenderer {
 public:
  using ToolRenderer::ToolRenderer;
  Parameters live_parameters() override { return {}; }
};
std::unique_ptr<Renderer> renderer_of(const ToolPenaltyParameters& motion, const Tool& tool,
                                      const Kernels& kernels) {
  return std::make_unique<ToolToCompare>(tool_parameters(motion), tool, kernels,
                                         make_penalty_motion(motion, *tool));
}
std::unique_ptr<Renderer> renderer_of(const ToolGodObjectParameters& motion, const Tool& tool,
                                      const Kernels& kernels) {
  return std::make_unique<ToolToCompare>(tool_parameters(motion), tool, kernels,
                                         std::make_unique<GodObjectMotion>(motion, *tool));
}
std::unique_ptr<Renderer> renderer_of(const InnerSphereParameters& motion, const Tool& tool,
                                      const Kernels& kernels) {
  return std::make_unique<ToolToCompare>(tool_parameters(motion), tool, kernels,
                                         std::make_unique<InnerSphereMotion>(motion, *tool));
}

template <class MotionSettings>
ToolSettings tool_for(ToolSettings tool, const MotionSettings& motion) {
  if constexpr (std::is_same_v<MotionSettings, TrackedToolParameters>) return tool_for(tool, motion.tool);
  if constexpr (std::is_same_v<MotionSettings, ToolParameters>)
    tool.outer_field = motion.contact_rule == ContactRule::continuous;
  if constexpr (std::is_same_v<MotionSettings, ToolGodObjectParameters>) tool.outer_field = true;
  return tool;
}

std::unique_ptr<Renderer> renderer_of(const ToolParameters& motion, const ToolOfSpheres& loaded,
                                      const Kernels& kernels) {
  const std::shared_ptr<const SphereTree> spheres(loaded.spheres, &loaded.spheres->spheres);
  return std::make_unique<SphereTreeRenderer>(motion, loaded.tool, spheres, kernels);
}

}  // namespace

template <class MotionSettings>
ToolFromMesh<MotionSettings>::ToolFromMesh(const Settings& settings, double, const Kernels& kernels)
    : LoadedRenderer(
          renderer_of(settings.motion, load_tool(tool_for(settings.tool, settings.motion)), kernels)) {}

template class ToolFromMesh<ToolParameters>;
template class ToolFromMesh<TrackedToolParameters>;
template class ToolFromMesh<ToolPenaltyParameters>;
template class ToolFromMesh<ToolGodObjectParameters>;
template class ToolFromMesh<InnerSphereParameters>;

Parameters parameters(LoadedSpheres::Settings& s) {
  Parameters all = parameters(s.tool);
  all.push_back({"max_tool_leaves", &s.leaves, kMinLeaves, kMaxLeaves,
                 "maximum number of spheres of the tool, 7.4; fewer spheres are less accurate"});
  for (Parameter& p : region_parameters(s.motion)) all.push_back(std::move(p));
  return all;
}

std::string validate(const LoadedSpheres::Settings& s) {
  if (const std::string tool = validate(s.tool); !tool.empty()) return tool;
  // PairChoice drops the pairs that no motion of up to half the look-ahead can violate.
  if (2 * s.motion.max_step_m > s.motion.look_ahead_m)
    return "look_ahead_m = " + std::to_string(s.motion.look_ahead_m) + ": expected twice max_step_m or more";
  return validate(s.motion);
}

std::vector<InputPart> input_files(const LoadedSpheres::Settings& s) {
  return input_files(s.tool);
}

LoadedSpheres::LoadedSpheres(const Settings& settings, double, const Kernels& kernels)
    : LoadedRenderer(
          renderer_of(settings.motion, load_tool_of_spheres(settings.tool, settings.leaves), kernels)) {}

}  // namespace remote_touch
