#include "runners/presentation/export/export_formats.h"

#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/presentation/export/result_tables.h"

namespace remote_touch {

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
  format.write(job);
  job.go_on();
}

}  // namespace remote_touch
