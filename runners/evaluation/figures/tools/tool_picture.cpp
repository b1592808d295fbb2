#include "runners/evaluation/figures/tools/tool_picture.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/trace/trace.h"
#include "core/geometry/rotation.h"
#include "runners/experiment/tool_files/tool_loading.h"

namespace remote_touch {

namespace {

constexpr std::uint32_t kToolColour = 0xE07B39, kDeviceColour = 0x3A6EA5;

void add_rows(Table& table, const std::vector<std::string>& names, const std::string& unit,
              const std::string& meaning, const std::vector<std::vector<double>>& rows) {
  for (std::size_t c = 0; c < names.size(); ++c) {
    std::vector<double> values;
    for (const std::vector<double>& row : rows) values.push_back(row.at(c));
    table.add(names[c], unit, meaning, std::move(values));
  }
}

std::vector<double> chosen_of(const std::vector<double>& values, const std::vector<std::size_t>& chosen) {
  std::vector<double> kept;
  for (const std::size_t i : chosen) kept.push_back(values[i]);
  return kept;
}

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
  Table table{name, title};
  table.add("x", "m", "x of the point", chosen_of(cloud.x, chosen));
  table.add("y", "m", "y of the point", chosen_of(cloud.y, chosen));
  table.add("z", "m", "z of the point", chosen_of(cloud.z, chosen));
  if (cloud.has_normals()) {
    table.add("nx", "1", "x of the normal", chosen_of(cloud.nx, chosen));
    table.add("ny", "1", "y of the normal", chosen_of(cloud.ny, chosen));
    table.add("nz", "1", "z of the normal", chosen_of(cloud.nz, chosen));
  }
  if (cloud.colour.empty()) return table;
  std::vector<double> colour;
  for (const std::size_t i : chosen) colour.push_back(cloud.colour[i]);
  table.add("colour", "1", "colour as 0xRRGGBB", std::move(colour));
  return table;
}

Table vertex_table(const std::string& name, const TriangleMesh& mesh) {
  std::vector<std::vector<double>> rows;
  for (const Vec3& p : mesh.vertices) rows.push_back({p.x(), p.y(), p.z()});
  Table table{name, "vertices of the tool, from its centre of mass"};
  add_rows(table, {"x", "y", "z"}, "m", "position in the tool's axes", rows);
  return table;
}

Table triangle_table(const std::string& name, const TriangleMesh& mesh) {
  std::vector<std::vector<double>> rows;
  for (const auto& [a, b, c] : mesh.triangles)
    rows.push_back({static_cast<double>(a), static_cast<double>(b), static_cast<double>(c)});
  Table table{name, "triangles of the tool"};
  add_rows(table, {"a", "b", "c"}, "1", "row of a corner among the vertices", rows);
  return table;
}

Table pose_table(const std::string& name, const Trace& trace, const std::vector<std::size_t>& ticks) {
  std::vector<double> time_s;
  std::vector<std::vector<double>> places, turns;
  const auto add = [&](std::size_t tick, const Vec3& p, const Eigen::Quaterniond& q) {
    time_s.push_back(trace.time_s[tick]);
    places.push_back({p.x(), p.y(), p.z()});
    turns.push_back({q.w(), q.x(), q.y(), q.z()});
  };
  for (const std::size_t tick : ticks) {
    add(tick, trace.proxy_position_m[tick], trace.tool_orientation[tick]);
    add(tick, trace.hip_position_m[tick], trace.hip_orientation[tick]);
  }
  Table table{name, "poses of tool and device, in turn"};
  table.add("time", "s", "simulated time", time_s);
  add_rows(table, {"x", "y", "z"}, "m", "centre of mass", places);
  add_rows(table, {"qw", "qx", "qy", "qz"}, "1", "orientation, tool axes to the world's", turns);
  return table;
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
  panel.grid_position = std::pair(static_cast<double>(row), static_cast<double>(column));
  panel.scene = std::move(scene);
  return panel;
}

double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return rotation_vector(a.conjugate() * b).norm();
}

double lag_m(const Trace& trace, std::size_t tick) {
  return (trace.hip_position_m[tick] - trace.proxy_position_m[tick]).norm();
}

double lag_rad(const Trace& trace, std::size_t tick) {
  return angle_between(trace.tool_orientation[tick], trace.hip_orientation[tick]);
}

}  // namespace remote_touch
