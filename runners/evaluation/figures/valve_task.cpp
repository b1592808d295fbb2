#include "runners/evaluation/figures/valve_task.h"
#include "runners/evaluation/figures/figure_recipe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "core/dissertation/tool_motion/sphere_tree.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/figure_pictures.h"

namespace remote_touch {

namespace {

constexpr std::size_t kClearanceEvery = 10;  // ticks, in the search for the least clearance
constexpr double kSettled_m = 1e-4;
constexpr std::size_t kRegionsEvery = 25;  // stride of the regions in pictures
constexpr int kRaysOfRegion = 60;
constexpr std::uint32_t kRegionColour = 0xC0392B;

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

Table position_table(const std::string& name, const std::string& title, const std::vector<Vec3>& places) {
  return {name,
          title,
          {{"x", "m", "x", along(0, places)},
           {"y", "m", "y", along(1, places)},
           {"z", "m", "z", along(2, places)}}};
}

std::vector<ValveTask> run_tasks(FigureContext& context, const std::vector<NamedExperiment>& tasks) {
  std::vector<ValveTask> runs;
  for (NamedRun& run : named_runs(context, tasks)) {
    std::shared_ptr<const Scenario> scenario = run.experiment.build_scenario(context.kernels());
    std::shared_ptr<const VoxelTool> tool = tool_of(run.experiment);
    runs.push_back({std::move(run), std::dynamic_pointer_cast<const ValveTank>(scenario), std::move(tool)});
  }
  return runs;
}

double min_clearance_m(const ValveTask& task, Valve valve) {
  const Trace& t = task.trace;
  const TriangleMesh& mesh = task.tool->mesh;
  std::vector<Vec3> places_T = mesh.vertices;
  for (const auto& [a, b, c] : mesh.triangles)
    places_T.push_back((mesh.vertices[static_cast<std::size_t>(a)] +
                        mesh.vertices[static_cast<std::size_t>(b)] +
                        mesh.vertices[static_cast<std::size_t>(c)]) /
                       3);
  double min = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < t.length(); i += kClearanceEvery) {
    const auto to_valve_m = [&](const Vec3& p_W) { return task.tank->distance_to_valve(valve, p_W); };
    // No position on the tool can be nearer than this.
    if (to_valve_m(t.proxy_position_m[i]) - task.tool->reach_m >= min) continue;
    for (const Vec3& p_T : places_T)
      min = min_or_nan(min, to_valve_m(t.proxy_position_m[i] + t.tool_orientation[i] * p_T));
  }
  return min;
}

Vec3 about_handle(const Trace& trace, std::size_t tick, const Vec3& torque_W) {
  return trace.hip_orientation[tick].conjugate() * torque_W;
}

Table task_table(const ValveTask& task) {
  const Trace& t = task.trace;
  const auto about = [&](int axis, const std::vector<Vec3>& torque_W) {
    return each_of(t.length(), [&](std::size_t i) { return about_handle(t, i, torque_W[i])[axis]; });
  };
  return every(
      5,
      {task.name,
       task.label,
       {{"time", "s", "simulated time", t.time_s},
        {"force", "N", "norm of the force", norms(t.force_N)},
        {"torque", "N m", "norm of the torque", norms(t.torque_Nm)},
        {"torque_x", "N m", "torque about the handle's x, the roll axis", about(0, t.torque_Nm)},
        {"torque_y", "N m", "torque about the handle's y, which the device can exert", about(1, t.torque_Nm)},
        {"torque_z", "N m", "torque about the handle's z, which the device can exert", about(2, t.torque_Nm)},
        {"exerted_x", "N m", "torque that the device exerts about the roll axis",
         about(0, t.device_torque_Nm)},
        {"exerted", "N", "norm of the force that the device exerts", norms(t.device_force_N)},
        {"lag", "m", "distance from the tool to the device",
         norms_between(t.hip_position_m, t.proxy_position_m)},
        {"yielded", "m", "distance from where the operator wants the device to where it is",
         norms_between(t.intended_position_m, t.hip_position_m)},
        {"pairs", "1", "pairs of leaves that touch", doubles(t.contact_count)},
        {"leaves", "1", "leaves of the tool that touch", doubles(t.contact_clusters)},
        {"active", "1", "constraints that hold the tool", doubles(t.active_constraints)},
        {"penetration", "m", "deepest leaf of the tool in a region at the end of the tick",
         t.tool_penetration_m},
        {"detections", "1", "collision detections in the tick", doubles(t.detections)},
        {"exhausted", "1", "the tick ended before the tool was at rest", doubles(t.budget_exhausted)}}});
}

Table moment_table(const std::string& title, const Trace& trace, const std::vector<std::size_t>& ticks) {
  std::vector<std::int32_t> moment(ticks.size());
  std::iota(moment.begin(), moment.end(), 0);
  const auto letters = list_of(moment, [](int i) { return std::string(1, static_cast<char>('A' + i)); });
  return {"moments",
          title,
          {{"letter", "1", "moment of the task", moment, 1, letters},
           {"time", "s", "simulated time", at(ticks, trace.time_s)},
           {"force", "N", "norm of the force", at(ticks, norms(trace.force_N))},
           {"torque", "N m", "norm of the torque", at(ticks, norms(trace.torque_Nm))}}};
}

void add_letters(Panel& panel) {
  const std::string column = panel.curves.front().y;
  panel.curves.push_back({"moments", "time", column, CurveStyle::letters, "", 0, "letter"});
}

Table sequence_table(const ValveTask& task) {
  using Entry = SequenceEntry;
  const std::vector<Entry> log = sequence_log(task.trace);
  return {task.name + "_steps",
          "steps of the task: " + task.label,
          {{"step", "1", "number of the step", each(log, &Entry::step)},
           {"began", "s", "when it began", each(log, &Entry::began_s)},
           {"ended", "s", "when it ended", each(log, &Entry::ended_s)},
           {"missed", "1", "whether its deadline ended it", each(log, &Entry::missed)},
           {"distance", "m", "from the tool to the goal when it ended", each(log, &Entry::distance_m)},
           {"angle", "deg", "between tool and goal when it ended",
            each(log, [](const Entry& entry) { return entry.angle_rad / kRadiansPerDegree; })}}};
}

void add_task_picture_tables(Figure& figure, const FigureContext& context, const ValveTask& task,
                             const std::vector<std::size_t>& ticks) {
  PointCloud cloud = processed_cloud(task.experiment, context.kernels(), 0);
  figure.tables.push_back(
      cloud_table(task.name + "_cloud", "points of the first frame", cloud, shown_points(cloud)));
  task.experiment.build_fixtures().assign(cloud, 0);
  RegionTree regions;
  regions.assign(cloud);
  figure.tables.push_back(position_table(task.name + "_regions",
                                         "places on the boundary of the forbidden regions",
                                         boundary(regions.spheres())));
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
  claim_finite(claims, t);
  claims.at_most("the tool stays out of the regions: depth of its deepest sphere at the end of a tick",
                 max_of(t.tool_penetration_m), kSettled_m, "m", "very small");
}

}  // namespace remote_touch
