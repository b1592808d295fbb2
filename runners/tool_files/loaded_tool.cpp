#include "runners/tool_files/loaded_tool.h"

namespace remote_touch {

Parameters parameters(LoadedTool::Settings& s) {
  Parameters all = parameters(s.tool);
  for (Parameter& p : parameters(s.motion)) all.push_back(std::move(p));
  return all;
}

std::string validate(const LoadedTool::Settings& s) {
  const std::string tool = validate(s.tool);
  return tool.empty() ? validate(s.motion) : tool;
}

std::vector<RecordingPart> input_files(const LoadedTool::Settings& s) {
  return input_files(s.tool);
}

LoadedTool::LoadedTool(const Settings& settings, double, const Kernels& kernels)
    : renderer_(settings.motion, load_tool(settings.tool), kernels) {}

}  // namespace remote_touch
