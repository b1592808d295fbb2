#include "runners/evaluation/figures/valve_task.h"
#include "runners/evaluation/figures/parts/figure_form.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "core/dissertation/sphere_tree/sphere_tree.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/parts/figure_pictures.h"

namespace remote_touch {

namespace {

constexpr std::size_t kEvery = 5;            // ticks, in tables
constexpr std::size_t kClearanceEvery = 10;  // ticks, in the search for the least clearance
constexpr double kSettled_m = 1e-4;
constexpr std::size_t kRegionsEvery = 25;  // stride of the regions in pictures
constexpr int kRaysOfRegion = 60;
constexpr std::uint32_t kRegionColour = 0xC0392B;

Vec3 place_of(const Trace& t, std::size_t tick, const Vec3& p_T) {
  return t.proxy_position_m[tick] + t.tool_orientation[tick] * p_T;
}

// Returns the distance along a ray to where it leaves the union of the regions. from: a position inside them.
double exit_distance_m(const SphereTree& regions, const Vec3& from, const Vec3& along) {
  double out = 0, before = -1;
  while (out > before) {
    before = out;
    for (const Sphere& s : regions.leaves()) {
      const Vec3 d = from - s.centre;
      const double half = d.dot(along), root = half * half - d.squaredNorm() + s.radius_m * s.radius_m;
      if (root >= 0 && -half - std::sqrt(root) <= out) out = std::max(out, -half + std::sqrt(root));
    }
  }
  return out;
}

// Positions on the boundary of the union of the regions.
std::vector<Vec3> boundary(const SphereTree& regions) {
  std::vector<Vec3> positions;
  const double golden = 2.399963229728653;
  for (std::size_t leaf = 0; leaf < regions.leaves().size(); leaf += kRegionsEvery)
    for (int i = 0; i < kRaysOfRegion; ++i) {
      const double y = 1 - (2 * i + 1.0) / kRaysOfRegion, r = std::sqrt(1 - y * y);
      const auto [sine, cosine] = sin_cos(golden * i);
      const Vec3 along(r * cosine, y, r * sine);
      const Vec3& from = regions.leaves()[leaf].centre;
      const Vec3 position = from + exit_distance_m(regions, from, along) * along;
      if (position.z() > 0) positions.push_back(position);
    }
  return positions;
}

// Returns the points of the valves, and those of the wall in every second pixel of every second row.
std::vector<std::size_t> shown_points(const PointCloud& cloud) {
  const auto width = static_cast<std::size_t>(cloud.image->camera.width);
  return chosen_points(cloud, [&](std::size_t i) {
    const Vec3 p = cloud.point(i);
    const bool near = std::abs(p.x()) < 0.24 && std::abs(p.y()) < 0.14;  // NaN is not
    return near && (p.z() > 0.02 || (i % 2 == 0 && i / width % 2 == 0));
  });
}

}  // namespace

std::vector<ValveTask> run_tasks(FigureContext& context, const std::vector<NamedTask>& tasks) {
  std::vector<Experiment> experiments;
  for (const NamedTask& task : tasks)
    experiments.push_back(Experiment::load(task.experiment, task.overrides));
  std::vector<Trace> traces = context.run(experiments);
  std::vector<ValveTask> runs;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    std::shared_ptr<const Scenario> scenario = experiments[i].build_scenario(context.kernels());
    std::shared_ptr<const VoxelTool> tool = tool_of(experiments[i]);
    runs.push_back({tasks[i].name, tasks[i].label, std::move(experiments[i]), std::move(traces[i]),
                    std::dynamic_pointer_cast<const ValveTank>(scenario), std::move(tool)});
  }
  return runs;
}

double clearance_m(const ValveTask& task, Valve valve, std::size_t tick) {
  double min = std::numeric_limits<double>::infinity();
  const auto measure = [&](const Vec3& p_T) {
    min = min_or_nan(min, task.tank->distance_to_valve(valve, place_of(task.trace, tick, p_T)));
  };
  const TriangleMesh& mesh = task.tool->mesh;
  for (const Vec3& vertex : mesh.vertices) measure(vertex);
  for (const auto& [a, b, c] : mesh.triangles)
    measure((mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)] +
             mesh.vertices[static_cast<std::size_t>(c)]) /
            3);
  return min;
}

double min_clearance_m(const ValveTask& task, Valve valve) {
  double min = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < task.trace.length(); i += kClearanceEvery) {
    // No position on the tool can be nearer than this.
    const double bound_m =
        task.tank->distance_to_valve(valve, task.trace.proxy_position_m[i]) - task.tool->reach_m;
    if (!(bound_m >= min)) min = min_or_nan(min, clearance_m(task, valve, i));
  }
  return min;
}

Vec3 about_handle(const Trace& trace, std::size_t tick, const Vec3& torque_W) {
  return trace.hip_orientation[tick].conjugate() * torque_W;
}

Table task_table(const ValveTask& task) {
  const Trace& t = task.trace;
  TableRows rows;
  for (std::size_t i = 0; i < t.length(); i += kEvery) {
    const Vec3 torque_T = about_handle(t, i, t.torque_Nm[i]),
               device_T = about_handle(t, i, t.device_torque_Nm[i]);
    rows.push_back({t.time_s[i], t.force_N[i].norm(), t.torque_Nm[i].norm(), torque_T.x(), torque_T.y(),
                    torque_T.z(), device_T.x(), t.device_force_N[i].norm(), lag_m(t, i),
                    (t.intended_position_m[i] - t.hip_position_m[i]).norm(), double(t.contact_count[i]),
                    double(t.contact_clusters[i]), double(t.active_constraints[i]), t.tool_penetration_m[i],
                    double(t.detections[i]), double(t.budget_exhausted[i])});
  }
  const std::vector<ColumnName> columns = {
      {"time", "s", "simulated time"},
      {"force", "N", "norm of the force"},
      {"torque", "N m", "norm of the torque"},
      {"torque_x", "N m", "torque about the handle's x, the roll axis"},
      {"torque_y", "N m", "torque about the handle's y, which the device can exert"},
      {"torque_z", "N m", "torque about the handle's z, which the device can exert"},
      {"exerted_x", "N m", "torque that the device exerts about the roll axis"},
      {"exerted", "N", "norm of the force that the device exerts"},
      {"lag", "m", "distance from the tool to the device"},
      {"yielded", "m", "distance from where the operator wants the device to where it is"},
      {"pairs", "1", "pairs of leaves that touch"},
      {"leaves", "1", "leaves of the tool that touch"},
      {"active", "1", "constraints that hold the tool"},
      {"penetration", "m", "deepest leaf of the tool in a region at the end of the tick"},
      {"detections", "1", "collision detections in the tick"},
      {"exhausted", "1", "the tick ended before the tool was at rest"}};
  return table_of(task.name, task.label, columns, rows);
}

Table moment_table(const std::string& title, const Trace& trace, const std::vector<std::size_t>& ticks) {
  TableRows rows;
  Column letters{"letter", "1", "moment of the task", {}, 1, {}};
  std::vector<std::int32_t> letter;
  for (const std::size_t tick : ticks) {
    letters.value_names.emplace_back(1, static_cast<char>('A' + letter.size()));
    letter.push_back(static_cast<std::int32_t>(letter.size()));
    rows.push_back({trace.time_s[tick], trace.force_N[tick].norm(), trace.torque_Nm[tick].norm()});
  }
  letters.values = letter;
  Table table = table_of("moments", title,
                         {{"time", "s", "simulated time"},
                          {"force", "N", "norm of the force"},
                          {"torque", "N m", "norm of the torque"}},
                         rows);
  table.columns.insert(table.columns.begin(), letters);
  return table;
}

Panel lettered(Panel panel) {
  const std::string column = panel.curves.front().y;
  panel.curves.push_back({"moments", "time", column, CurveStyle::letters, "", 0, "letter"});
  return panel;
}

Table sequence_table(const ValveTask& task) {
  TableRows rows;
  for (const SequenceEntry& entry : sequence_log(task.trace))
    rows.push_back({double(entry.step), entry.began_s, entry.ended_s, entry.missed ? 1.0 : 0.0,
                    entry.distance_m, entry.angle_rad / kRadiansPerDegree});
  const std::vector<ColumnName> columns = {{"step", "1", "number of the step"},
                                           {"began", "s", "when it began"},
                                           {"ended", "s", "when it ended"},
                                           {"missed", "1", "whether its deadline ended it"},
                                           {"distance", "m", "from the tool to the goal when it ended"},
                                           {"angle", "deg", "between tool and goal when it ended"}};
  return table_of(task.name + "_steps", "steps of the task: " + task.label, columns, rows);
}

void add_task_picture_tables(Figure& figure, const FigureContext& context, const ValveTask& task,
                             const std::vector<std::size_t>& ticks) {
  PointCloud cloud = processed_cloud(task.experiment, context.kernels(), 0);
  figure.tables.push_back(
      cloud_table(task.name + "_cloud", "points of the first frame", cloud, shown_points(cloud)));
  task.experiment.build_fixtures().assign(cloud, 0);
  RegionTree regions;
  regions.assign(cloud);
  TableRows positions;
  for (const Vec3& p : boundary(regions.spheres())) positions.push_back({p.x(), p.y(), p.z()});
  figure.tables.push_back(table_of(task.name + "_regions", "places on the boundary of the forbidden regions",
                                   {{"x", "m", "x"}, {"y", "m", "y"}, {"z", "m", "z"}}, positions));
  add_tool_tables(figure, task.name, task.tool->mesh, task.trace, ticks);
}

Panel task_picture(const ValveTask& task, const std::string& title, std::size_t instant, int row,
                   int column) {
  Scene scene{{0.42, 0.40, 0.62},
              {-0.015, 0.005, 0.125},
              Vec3::UnitY(),
              0.54,
              0.72,
              tool_in_cloud(task.name, instant, 0.003)};
  ScenePart regions{ScenePart::Kind::points, task.name + "_regions", kRegionColour};
  regions.size_m = 0.0015, regions.opacity = 0.5, regions.label = "region";
  scene.parts.insert(scene.parts.begin() + 1, regions);
  return scene_panel(title, row, column, scene);
}

void add_task_claims(Figure& figure, const ValveTask& task) {
  const Trace& t = task.trace;
  const Claims claims(figure, task.label + ": ");
  claims.at_most("all numbers are finite: fraction of ticks with one that is not", non_finite_fraction(t), 0,
                 "fraction");
  claims.at_most("the tool stays out of the regions: depth of its deepest sphere at the end of a tick",
                 max_of(t.tool_penetration_m), kSettled_m, "m", "very small");
}

}  // namespace remote_touch
