#include <cstdio>

#include "analysis/column_source.h"
#include "analysis/tick_hashes.h"
#include "analysis/whole_file.h"
#include "core/input_error.h"
#include "runners/commands/commands.h"

namespace remote_touch {

int command_hashes(const CommandLine&, const HashesRequest& request) {
  if (request.every < 1) throw InputError("--every " + std::to_string(request.every), "allowed 1 or more");
  require_other(request.output, request.trace);
  require_writable(request.output);
  const TickHashes hashes = hashes_of_trace(request.trace, request.every);
  const StoredTrace trace(request.trace);
  TextAttributes kept;
  for (const char* name : {"config", "command", "version", "git_commit", "git_dirty", "sources", "compiler",
                           "flags", "isa", "inputs"})
    if (const std::string value = attribute(trace.attributes(), name); !value.empty())
      kept.emplace_back(name, value);
  write_hashes(request.output, hashes, kept);
  std::printf("%s: %zu hashes, the last of tick %d\n", request.output.c_str(), hashes.tick.size(),
              hashes.tick.empty() ? -1 : hashes.tick.back());
  return kDone;
}

}  // namespace remote_touch
