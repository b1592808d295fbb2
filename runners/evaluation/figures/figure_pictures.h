// Pictures of figures: a tool in a cloud, images, and the pixels that colour rules select.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "analysis/storage/result_file.h"
#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/mesh/voxel_tool.h"
#include "core/points/point_cloud.h"
#include "runners/experiment/catalog/experiment.h"

namespace remote_touch {

struct Trace;

// Pixels of an image that colour rules select, and pictures of images.

// Returns each fixture rule of an experiment separately, in order.
std::vector<std::unique_ptr<FixtureRule>> rules_of(const Experiment& experiment);

// Returns one element for each point: 1 if the rule selects the point, else 0.
std::vector<char> picked_points(const FixtureRule& rule, const PointCloud& cloud);

// Pixels of an image that a picture shows: every step'th of the columns left .. right - 1 and of the rows
// top .. bottom - 1.
struct PictureCrop {
  int left, top, right, bottom, step = 1;
};

// Returns a table with columns column, row and colour. colours: those of all pixels, 0xRRGGBB. pre: the cloud
// has an image.
Table picture_table(const std::string& name, const std::string& title, const PointCloud& cloud,
                    const std::vector<std::uint32_t>& colours, const PictureCrop& crop);
// Returns a panel that draws the table of picture_table() as an image.
Panel picture_panel(const std::string& title, int row, int column, const std::string& table,
                    const PictureCrop& crop);

// Tables from which a picture of a tool in a cloud is drawn.

// The tool that an experiment's 6-DOF renderer moves.
std::shared_ptr<const VoxelTool> tool_of(const Experiment& experiment);

// Returns a frame's cloud as the renderer receives it: filtered and with normals, if the experiment has a
// depth pipeline.
PointCloud processed_cloud(const Experiment& experiment, const Kernels& kernels, int frame);

// Returns the indices of the points for which shows(i) is true.
template <class Shows>
std::vector<std::size_t> chosen_points(const PointCloud& cloud, Shows&& shows) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (shows(i)) chosen.push_back(i);
  return chosen;
}
// Returns the chosen points, with their normals, and their colours as 0xRRGGBB if the cloud has them.
Table cloud_table(const std::string& name, const std::string& title, const PointCloud& cloud,
                  const std::vector<std::size_t>& chosen);
Table vertex_table(const std::string& name, const TriangleMesh& mesh);
Table triangle_table(const std::string& name, const TriangleMesh& mesh);

// Adds the tables NAME_vertices, NAME_triangles and NAME_poses, with two rows for each of the ticks: the
// tool, then the device.
void add_tool_tables(Figure& figure, const std::string& name, const TriangleMesh& mesh, const Trace& trace,
                     const std::vector<std::size_t>& ticks);

// Returns a cloud, and the tool at tick number `instant` of the pose table: filled at the tool's pose,
// transparent at the device's. Tables are NAME_cloud, NAME_vertices, NAME_triangles and NAME_poses.
std::vector<ScenePart> tool_in_cloud(const std::string& name, std::size_t instant, double point_m);

// Returns the first tick at or after a time; the last one if there is none.
std::size_t tick_of(const Trace& trace, double time_s);

Panel scene_panel(const std::string& title, int row, int column, Scene scene);

// Distance and angle between the tool's and the device's pose in a tick.
double lag_m(const Trace& trace, std::size_t tick);
double lag_rad(const Trace& trace, std::size_t tick);

}  // namespace remote_touch
