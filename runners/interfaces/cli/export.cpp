#include <cstdio>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/input_error.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/presentation/export/export_formats.h"

namespace remote_touch {

int command_export(const CommandLine& line, const ExportRequest& request) {
  const ExportFormat& format = export_format(request.output);
  require_different_file(request.output, request.file);
  require_writable(request.output);
  const Hdf5Reader result(request.file);
  const FileLock lock(request.output);
  NewFiles files;
  const auto require_allowed = [&](const std::filesystem::path& file, const std::string& opening) {
    require_export(line, file.string(), {request.file}, opening);
  };
  export_result(format, {result, request.output, files, require_allowed, line.kernels, line.stop});
  const std::size_t count = files.count();
  files.finish();
  std::printf("%s: %zu file%s, %.1f MB\n", printable(request.output).c_str(), count, count == 1 ? "" : "s",
              1e-6 * static_cast<double>(files.size()));
  return kDone;
}

}  // namespace remote_touch
