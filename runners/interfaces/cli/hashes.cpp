#include <cstdio>

#include "analysis/comparison/compared_columns.h"
#include "analysis/figures/result_file.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"

namespace remote_touch {

int command_hashes(const CommandLine& line, const HashesRequest& request) {
  if (request.every < 1) throw InputError("--every " + std::to_string(request.every), "expected 1 or more");
  const FileLock lock = lock_output(line, request.output, {request.trace});
  const StoredTrace trace(request.trace);
  const TickHashes hashes = hashes_of_trace(trace, request.every);
  write_hashes(request.output, hashes, provenance_of(present_attributes(trace.attributes())));
  std::printf("%s: %zu hashes", printable(request.output).c_str(), hashes.tick.size());
  if (!hashes.tick.empty()) std::printf(", the last of tick %d", hashes.tick.back());
  std::printf("\n");
  return kDone;
}

}  // namespace remote_touch
