#include "runners/experiment/tool_files/loaded_spheres.h"

namespace remote_touch {

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

std::vector<RecordingPart> input_files(const LoadedSpheres::Settings& s) {
  return input_files(s.tool);
}

LoadedSpheres::LoadedSpheres(const Settings& settings, double, const Kernels& kernels)
    : LoadedSpheres(load_tool_of_spheres(settings.tool, settings.leaves), settings.motion, kernels) {}

LoadedSpheres::LoadedSpheres(const ToolOfSpheres& loaded, const ToolParameters& motion,
                             const Kernels& kernels)
    : renderer_(motion, loaded.tool, {loaded.spheres, &loaded.spheres->spheres}, kernels) {}

}  // namespace remote_touch
