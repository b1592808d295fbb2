// A stored trace with its frames, which are made again, as other programs show it.
#pragma once

#include <atomic>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_shape/voxel_tool.h"
#include "core/kernels/kernels.h"
#include "core/points/point_cloud.h"
#include "runners/experiment/catalog/experiment.h"

namespace remote_touch {

// The input of every format of an export: the result, the output and the files to write.
struct ExportJob {
  const Hdf5Reader& result;
  std::filesystem::path output;
  NewFiles& files;
  // Throws InputError unless the file may be written: it must be absent, or begin with `opening` as an
  // earlier export does.
  std::function<void(const std::filesystem::path& file, const std::string& opening)> require_allowed;
  const Kernels* kernels = nullptr;         // pre: set
  const std::atomic<bool>* stop = nullptr;  // when set, ends with Interrupted

  void begin(const std::filesystem::path& file, const std::string& opening) const {
    if (require_allowed) require_allowed(file, opening);
    files.begin(file);
  }
  // Throws Interrupted when the user wants the program to end.
  void go_on() const;
};

// Appends the numbers one after another, as files store them: little-endian, without gaps.
template <class... Numbers>
void put(std::string& bytes, Numbers... numbers) {
  static_assert(std::endian::native == std::endian::little && (std::is_arithmetic_v<Numbers> && ...));
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
}

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
  double captured_s = 0, arrives_s = 0;
  std::size_t first_tick = 0;  // first tick that used the frame
  PointCloud points;           // the measured ones
};
// Calls use() for every frame that a tick used, in order. Throws InputError if the frames cannot be made
// again or are not those of the run. Throws Interrupted.
void for_each_frame(const ExportJob& job, const ExportedRun& run,
                    const std::function<void(const ExportedFrame&)>& use);

}  // namespace remote_touch
