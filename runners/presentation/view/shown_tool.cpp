#include "runners/presentation/view/shown_tool.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/tool_files/tool_loading.h"

namespace remote_touch {

namespace {

constexpr const char* kLeaves = "max_tool_leaves";

ToolSettings tool_settings(const Json& renderer) {
  ToolSettings settings;
  const Parameters known = parameters(settings);
  Json of_tool = Json::object();
  for (const auto& item : renderer.items())
    if (std::any_of(known.begin(), known.end(), [&](const Parameter& p) { return p.name == item.key(); }))
      of_tool[item.key()] = item.value();
  read_parameters(of_tool, known, "renderer");
  return settings;
}

std::vector<float> centres_and_radii(std::span<const Sphere> spheres) {
  std::vector<float> list;
  for (const Sphere& one : spheres)
    for (const double number : {one.centre.x(), one.centre.y(), one.centre.z(), one.radius_m})
      list.push_back(static_cast<float>(number));
  return list;
}

}  // namespace

ShownTool shown_tool(const Json& renderer) {
  const ToolSettings settings = tool_settings(renderer);
  if (!renderer.contains(kLeaves)) return {load_tool(settings), nullptr};
  ToolOfSpheres loaded = load_tool_of_spheres(settings, renderer[kLeaves].get<int>());
  return {std::move(loaded.tool), std::move(loaded.spheres)};
}

Json json_of(const ShownTool& tool, PackedArrays& numbers) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (const Vec3& v : tool.tool->mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) vertices.push_back(static_cast<float>(v[axis]));
  for (const auto& triangle : tool.tool->mesh.triangles)
    for (const int corner : triangle) triangles.push_back(static_cast<std::uint32_t>(corner));
  Json json{{"vertices", json_of(numbers.add(vertices))}, {"triangles", json_of(numbers.add(triangles))}};
  if (tool.spheres) json["spheres"] = json_of(numbers.add(centres_and_radii(tool.spheres->spheres.leaves())));
  return json;
}

}  // namespace remote_touch
