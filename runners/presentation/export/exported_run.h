// A stored trace with its frames, which are made again, as other programs show it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/tool/dynamics/tool_pose.h"
#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/geometry/point_cloud.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/presentation/export/export_job.h"

namespace remote_touch {

// A row for each tick.
struct ExportedRun {
  Experiment experiment;
  std::vector<double> time_s = {};  // finite, 0 or more
  std::vector<Vec3> hip_W = {}, proxy_W = {}, force_N = {};
  std::vector<Vec3> torque_Nm = {};  // zeros if the trace does not have the column, as without a tool
  // Identity if the trace does not have the column, as without a tool.
  std::vector<Eigen::Quaterniond> hip_orientation_W = {}, tool_orientation_W = {};
  std::vector<std::int32_t> frame = {};        // newest in use
  std::vector<std::uint64_t> frame_hash = {};  // 0: not computed
  std::shared_ptr<const VoxelTool> tool = {};  // null: a proxy

  std::size_t ticks() const { return time_s.size(); }
  ToolPose tool_pose(std::size_t tick) const { return {proxy_W[tick], tool_orientation_W[tick]}; }
};

// Throws InputError for a trace that is damaged, and as experiment_of_run().
ExportedRun exported_run(const ExportJob& job);

struct ExportedFrame {
  int number = 0;  // index among the frames in use, from 0
  double captured_s = 0, arrives_s = 0;
  std::size_t first_tick = 0;  // first tick that used the frame
  PointCloud points;           // the measured ones
};
// Calls use() for every frame that a tick used, in order. Throws InputError if the frames cannot be made
// again or are not those of the run. Throws Interrupted.
void for_each_frame(const ExportJob& job, const ExportedRun& run,
                    const std::function<void(const ExportedFrame&)>& use);

}  // namespace remote_touch
