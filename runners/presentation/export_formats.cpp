#include "runners/presentation/export_formats.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/frame_stream.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/presentation/result_pages.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

namespace {

template <class Number>
std::vector<Number> numbers(const Hdf5Reader& trace, const std::string& column, std::size_t ticks,
                            int width = 1) {
  auto list = trace.values<Number>("/trace/" + column, width);
  if (list.size() != ticks * static_cast<std::size_t>(width))
    trace.damaged("/trace/" + column + " is not as long as /trace/time");
  return list;
}

std::vector<Vec3> vectors(const Hdf5Reader& trace, const std::string& column, std::size_t ticks) {
  if (!trace.has("/trace/" + column)) trace.damaged("it has no /trace/" + column);
  const auto flat = numbers<double>(trace, column, ticks, 3);
  std::vector<Vec3> list;
  for (std::size_t i = 0; i < flat.size(); i += 3) list.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
  return list;
}

std::vector<Eigen::Quaterniond> orientations(const Hdf5Reader& trace, const std::string& column,
                                             std::size_t ticks) {
  if (!trace.has("/trace/" + column))
    return std::vector<Eigen::Quaterniond>(ticks, Eigen::Quaterniond::Identity());
  const auto flat = numbers<double>(trace, column, ticks, 4);
  std::vector<Eigen::Quaterniond> list;
  for (std::size_t i = 0; i < flat.size(); i += 4)
    list.emplace_back(flat[i], flat[i + 1], flat[i + 2], flat[i + 3]);
  return list;
}

template <class T>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::size_t>& places) {
  std::vector<T> some;
  if (all.empty()) return some;
  some.reserve(places.size());
  for (const std::size_t i : places) some.push_back(all[i]);
  return some;
}

PointCloud measured_points(const PointCloud& cloud) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.is_measured(i)) places.push_back(i);
  PointCloud some;
  some.x = chosen(cloud.x, places), some.y = chosen(cloud.y, places), some.z = chosen(cloud.z, places);
  some.nx = chosen(cloud.nx, places), some.ny = chosen(cloud.ny, places), some.nz = chosen(cloud.nz, places);
  some.fixture_radius_m = chosen(cloud.fixture_radius_m, places);
  some.stiffness_N_per_m = chosen(cloud.stiffness_N_per_m, places);
  some.colour = chosen(cloud.colour, places);
  return some;
}

}  // namespace

ExportedRun exported_run(const ExportJob& job) {
  const Hdf5Reader& trace = job.result;
  ExportedRun run{experiment_of_run(trace.attributes(), trace.file())};
  run.time_s = trace.values<double>("/trace/time");
  constexpr double kMaxTime_s = 2e9;  // seconds of a message have 32 bits
  for (const double time_s : run.time_s)
    if (!(time_s >= 0 && time_s < kMaxTime_s))
      trace.damaged("/trace/time has a time that is not a number, negative, or 2e9 s or more");
  const std::size_t ticks = run.ticks();
  run.hip_W = vectors(trace, "hip_position", ticks), run.proxy_W = vectors(trace, "proxy_position", ticks);
  run.force_N = vectors(trace, "force", ticks);
  run.torque_Nm =
      trace.has("/trace/torque") ? vectors(trace, "torque", ticks) : std::vector<Vec3>(ticks, Vec3::Zero());
  run.hip_orientation_W = orientations(trace, "hip_orientation", ticks);
  run.tool_orientation_W = orientations(trace, "tool_orientation", ticks);
  run.frame = numbers<std::int32_t>(trace, "frame_index", ticks);
  if (!std::is_sorted(run.frame.begin(), run.frame.end())) trace.damaged("/trace/frame_index goes back");
  run.frame_hash = numbers<std::uint64_t>(trace, "frame_hash", ticks);
  if (trace.has("/trace/tool_orientation"))
    run.tool = shown_tool(parse_json(attribute(trace.attributes(), "config"), trace.file())["renderer"]).tool;
  return run;
}

void for_each_frame(const ExportJob& job, const ExportedRun& run,
                    const std::function<void(const ExportedFrame&)>& use) {
  replay_frames(run.experiment, run.time_s, *job.kernels, job.stop, [&](const Frame& frame) {
    job.go_on();
    const auto first = std::lower_bound(run.frame.begin(), run.frame.end(), frame.index);
    if (first == run.frame.end() || *first != frame.index) return;  // no tick used it: it arrived too late
    const auto first_tick = static_cast<std::size_t>(first - run.frame.begin());
    PointCloud buffer;
    const PointCloud& cloud = frame.points->every_point(*job.kernels, buffer);
    const std::uint64_t hash = run.frame_hash[first_tick];
    if (hash != 0 && hash != frame_hash(cloud, frame.captured_s))
      throw InputError(
          job.result.file(),
          "has other frames than this program makes from its configuration: expected a trace that "
          "this version made, or .csv or .npz");
    use({frame.captured_s, frame.arrives_s, first_tick, measured_points(cloud)});
  });
}

void ExportJob::go_on() const {
  if (stop && *stop) throw Interrupted{};
}

const std::vector<ExportFormat>& export_formats() {
  static const std::vector<ExportFormat> formats{
      {".csv", "tables as text", false, write_csv},
      {".npz", "arrays for NumPy", false, write_npz},
      {".vtp", "scene, paths and tool for ParaView", true, write_vtp},
      {".mcap", "messages of ROS 2 for Foxglove and rerun", true, write_mcap},
  };
  return formats;
}

std::string known_formats() {
  std::string list;
  for (const ExportFormat& format : export_formats())
    list.append(list.empty() ? "" : ", ")
        .append(format.ending)
        .append(" (")
        .append(format.meaning)
        .append(format.traces_only ? "; of traces)" : ")");
  return list;
}

const ExportFormat& export_format(const std::filesystem::path& output) {
  std::string known;
  for (const ExportFormat& format : export_formats()) {
    if (output.extension() == format.ending) return format;
    known.append(known.empty() ? "" : ", ").append(format.ending);
  }
  throw InputError(output.string(), "has an unknown ending: expected one of " + known);
}

void export_result(const ExportFormat& format, const ExportJob& job) {
  const std::string kind = exported_kind(job.result);
  if (format.traces_only && kind != "trace")
    throw InputError(job.result.file(),
                     "is a " + kind + ": expected a trace for " + format.ending + ", or .csv or .npz");
  if (job.every > 1 && kind != "trace")
    throw InputError("--every " + std::to_string(job.every),
                     "only for a trace, but " + job.result.file() + " is a " + kind + ": expected a trace");
  format.write(job);
  job.go_on();
}

}  // namespace remote_touch
