// Runs of the tasks of 7.5 among the valves of the tank, and their tables, pictures and claims.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/mesh/voxel_tool.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "scenarios/simulated/camera_scenes.h"

namespace remote_touch {

struct ValveTask : NamedRun {
  std::shared_ptr<const ValveTank> tank;  // null for other scenarios
  std::shared_ptr<const VoxelTool> tool;
};
std::vector<ValveTask> run_tasks(FigureContext& context, const std::vector<NamedExperiment>& tasks);

// Returns a table of places x, y, z.
Table position_table(const std::string& name, const std::string& title, const std::vector<Vec3>& places);

// Returns the least distance from the tool's mesh to the true surface of a valve, over every tenth tick. It
// is measured at the vertices and at the centres of the triangles, so it can be too large by a few hundredths
// of a millimetre. pre: there is a tank; also for the functions below.
double min_clearance_m(const ValveTask& task, Valve valve);

// Returns a torque about the handle's own axes, which are those of the tool.
Vec3 about_handle(const Trace& trace, std::size_t tick, const Vec3& torque_W);

// Returns force, torque, the force and torque that the device exerts, distances and contacts of every fifth
// tick.
Table task_table(const ValveTask& task);
// Returns force and torque at the ticks, which are called A, B, ... The table is named "moments". For
// add_letters().
Table moment_table(const std::string& title, const Trace& trace, const std::vector<std::size_t>& ticks);
// Adds these letters to a panel over time. Its first curve must show the force or the torque.
void add_letters(Panel& panel);
// The log of the task's steps; no rows without a task.
Table sequence_table(const ValveTask& task);

// Adds the tables NAME_cloud, NAME_regions (positions on the boundary of the regions) of the first frame,
// NAME_vertices, NAME_triangles, and NAME_poses of the ticks.
void add_task_picture_tables(Figure& figure, const FigureContext& context, const ValveTask& task,
                             const std::vector<std::size_t>& ticks);
// Returns a picture of the tank from beside the camera, with the tool at tick number `instant` of the ticks.
Panel task_picture(const ValveTask& task, const std::string& title, std::size_t instant, int row, int column);

// Adds the claims of any task: all numbers are finite, and no leaf ends a tick deeper than 0.1 mm in a
// region.
void add_task_claims(Figure& figure, const ValveTask& task);

}  // namespace remote_touch
