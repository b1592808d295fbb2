#include "runners/evaluation/figures/figure_pictures.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/mesh_files/loaded_tool.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

std::vector<std::unique_ptr<FixtureRule>> rules_of(const Experiment& experiment) {
  std::vector<std::unique_ptr<FixtureRule>> rules;
  const Json resolved = parse_json(experiment.to_json(), "experiment");
  for (const Json& part : resolved.at("fixtures")) {
    const auto factory = find_entry(fixtures(), part.at("name").get<std::string>(), "fixture").make();
    read_parameters(part, factory->settings(), "fixtures", {"name"});
    rules.push_back(factory->build());
  }
  return rules;
}

std::vector<char> picked_points(const FixtureRule& rule, const PointCloud& cloud) {
  return list_of(rule.weights(cloud), [](double fraction) -> char { return fraction > 0; });
}

Table picture_table(const std::string& name, const std::string& title, const PointCloud& cloud,
                    const std::vector<std::uint32_t>& colours, const PictureCrop& crop) {
  const int width = cloud.image->camera.width;
  TableRows rows;
  for (int v = crop.top; v < crop.bottom; v += crop.step)
    for (int u = crop.left; u < crop.right; u += crop.step)
      rows.push_back({double(u), double(v), double(colours[static_cast<std::size_t>(v) * width + u])});
  return table_of(name, title,
                  {{"column", "px", "column of the pixel"},
                   {"row", "px", "row of the pixel"},
                   {"colour", "1", "red * 65536 + green * 256 + blue"}},
                  rows);
}

Panel picture_panel(const std::string& title, int row, int column, const std::string& table,
                    const PictureCrop& crop) {
  // Rows count downwards.
  return plot(
      title, "", "", {{table, "column", "row", CurveStyle::image, "", 0, "colour"}},
      {{{row, column}}, {{crop.left - 0.5, crop.right - 0.5}}, {{crop.bottom - 0.5, crop.top - 0.5}}, true});
}

namespace {

constexpr std::uint32_t kToolColour = 0x146BAB, kDeviceColour = 0xC08800;
const char *const kAxes[] = {"x", "y", "z"}, *const kCorners[] = {"a", "b", "c"};

}  // namespace

std::shared_ptr<const VoxelTool> tool_of(const Experiment& experiment) {
  const auto renderer = nlohmann::json::parse(experiment.to_json()).at("renderer");
  ToolSettings settings;
  settings.mesh = renderer.at("tool_mesh");
  settings.size_m = renderer.at("tool_size_m");
  settings.voxel_m = renderer.at("tool_voxel_m");
  settings.repair = renderer.at("tool_repair");
  return load_tool(settings);
}

PointCloud processed_cloud(const Experiment& experiment, const Kernels& kernels, int frame) {
  PointCloud cloud = experiment.build_scenario(kernels)->cloud(frame);
  const FrameProcessing processing = experiment.build_processing(kernels);
  if (processing.depth) processing.depth->process(cloud);
  return cloud;
}

Table cloud_table(const std::string& name, const std::string& title, const PointCloud& cloud,
                  const std::vector<std::size_t>& chosen) {
  Table table{name,
              title,
              {{"x", "m", "x of the point", at(chosen, cloud.x)},
               {"y", "m", "y of the point", at(chosen, cloud.y)},
               {"z", "m", "z of the point", at(chosen, cloud.z)}}};
  if (cloud.has_normals()) {
    table.add("nx", "1", "x of the normal", at(chosen, cloud.nx));
    table.add("ny", "1", "y of the normal", at(chosen, cloud.ny));
    table.add("nz", "1", "z of the normal", at(chosen, cloud.nz));
  }
  if (!cloud.colour.empty())
    table.add("colour", "1", "colour as 0xRRGGBB", at(chosen, doubles(cloud.colour)));
  return table;
}

Table vertex_table(const std::string& name, const TriangleMesh& mesh) {
  Table table{name, "vertices of the tool, from its centre of mass"};
  for (const int axis : {0, 1, 2})
    table.add(kAxes[axis], "m", "position in the tool's axes", along(axis, mesh.vertices));
  return table;
}

Table triangle_table(const std::string& name, const TriangleMesh& mesh) {
  Table table{name, "triangles of the tool"};
  for (const std::size_t corner : {0, 1, 2})
    table.add(kCorners[corner], "1", "row of a corner among the vertices",
              each(mesh.triangles, [&](const auto& triangle) { return triangle[corner]; }));
  return table;
}

void add_tool_tables(Figure& figure, const std::string& name, const TriangleMesh& mesh, const Trace& trace,
                     const std::vector<std::size_t>& ticks) {
  figure.tables.push_back(vertex_table(name + "_vertices", mesh));
  figure.tables.push_back(triangle_table(name + "_triangles", mesh));
  TableRows rows;
  const auto add = [&](std::size_t tick, const Vec3& p, const Eigen::Quaterniond& q) {
    rows.push_back({trace.time_s[tick], p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()});
  };
  for (const std::size_t tick : ticks) {
    add(tick, trace.proxy_position_m[tick], trace.tool_orientation[tick]);
    add(tick, trace.hip_position_m[tick], trace.hip_orientation[tick]);
  }
  std::vector<ColumnName> columns = {{"time", "s", "simulated time"}};
  for (const char* axis : kAxes) columns.push_back({axis, "m", "centre of mass"});
  for (const char* part : {"qw", "qx", "qy", "qz"})
    columns.push_back({part, "1", "orientation, tool axes to the world's"});
  figure.tables.push_back(table_of(name + "_poses", "poses of tool and device, in turn", columns, rows));
}

std::size_t tick_of(const Trace& trace, double time_s) {
  const auto at = std::lower_bound(trace.time_s.begin(), trace.time_s.end(), time_s - kSameTime_s);
  return std::min(static_cast<std::size_t>(at - trace.time_s.begin()), trace.length() - 1);
}

std::vector<ScenePart> tool_in_cloud(const std::string& name, std::size_t instant, double point_m) {
  ScenePart cloud{ScenePart::Kind::points, name + "_cloud"};
  cloud.size_m = point_m;
  ScenePart tool{ScenePart::Kind::solid, name + "_vertices", kToolColour};
  tool.triangles = name + "_triangles", tool.poses = name + "_poses";
  tool.pose_row = static_cast<int>(2 * instant);
  tool.label = "tool";
  ScenePart device = tool;
  device.colour = kDeviceColour, device.opacity = 0.4, device.label = "device";
  device.pose_row = tool.pose_row + 1;
  return {cloud, tool, device};
}

Panel scene_panel(const std::string& title, int row, int column, Scene scene) {
  Panel panel{title, "", ""};
  panel.grid_position = {row, column};
  panel.scene = std::move(scene);
  return panel;
}

double lag_m(const Trace& trace, std::size_t tick) {
  return (trace.hip_position_m[tick] - trace.proxy_position_m[tick]).norm();
}

double lag_rad(const Trace& trace, std::size_t tick) {
  return rotation_vector(trace.tool_orientation[tick].conjugate() * trace.hip_orientation[tick]).norm();
}

}  // namespace remote_touch
