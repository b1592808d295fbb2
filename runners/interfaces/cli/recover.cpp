#include <cinttypes>
#include <cstdio>

#include "core/parameters/input_error.h"
#include "runners/experiment/sessions/session_recorder.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"

namespace remote_touch {

int command_recover(const CommandLine& line, const RecoverRequest& request) {
  const FileLock lock = lock_output(line, request.output, {request.file});
  const UnfinishedSession made = recover_session(request.file, request.output);
  std::printf("%s: %" PRIu64 " ticks and %" PRIu64 " frames%s\n", printable(request.output).c_str(),
              made.ticks, made.frames, made.has_end ? "" : "; the recording was interrupted");
  if (made.left_out_bytes > 0)
    std::printf("  note: the last %" PRIu64
                " bytes of %s are left out, from the first damaged or incomplete block on\n",
                made.left_out_bytes, printable(request.file).c_str());
  std::printf("  %s is unchanged; remove it when you no longer need it\n", printable(request.file).c_str());
  return kDone;
}

}  // namespace remote_touch
