#include "runners/live/live_run.h"

#include <cstdio>

#include "analysis/digest.h"
#include "analysis/result_file.h"
#include "analysis/whole_file.h"
#include "runners/commands/commands.h"
#include "runners/commands/shell_command.h"
#include "runners/input_hashes.h"
#include "runners/provenance.h"

namespace remote_touch {

namespace {

std::string normalised(const LiveRequest& request) {
  std::vector<std::string> words = {"remote-touch", "live",    request.experiment, "--device",
                                    request.device, "--depth", request.depth};
  for (const std::string& assignment : request.overrides) words.insert(words.end(), {"--set", assignment});
  return shell_command(words);
}

void tell(const std::string& text) {
  std::fprintf(stderr, "live: %s%s", text.c_str(), text.ends_with('\n') ? "" : "\n");
}

}  // namespace

int command_live(const CommandLine& line, const LiveRequest& request) {
  const Experiment experiment = Experiment::load(request.experiment, request.overrides);
  for (const std::string& file : {request.record, request.output})
    if (!file.empty()) require_writable(file);
  LiveOptions options;
  options.device = request.device, options.depth = request.depth;
  options.duration_s = request.duration_s;
  options.record = request.record;
  options.kernels = line.kernels;
  options.stop = line.stop, options.report = line.report, options.rearm = line.rearm;
  options.provenance = provenance(experiment.to_json(), normalised(request), line.kernels->isa,
                                  input_hashes(experiment.inputs()));
  if (!line.quiet) options.tell = tell;
  const LiveResult result = run_live(experiment, options);

  std::printf("%s and %s: %s; ended because %s\n", result.device.c_str(), request.depth.c_str(),
              result.real_time.c_str(), result.ended.c_str());
  std::fputs(live_report(result.log, result.camera, result.stalls, result.rows_lost).c_str(), stdout);
  std::printf("  largest force written: %.3g N\n", result.log.largest_force_N);
  const std::string sum = request.output.empty() ? digest(result.log.trace.columns())
                                                 : write_trace(request.output, result.log.trace,
                                                               options.provenance, result.log.step_s);
  std::printf("  digest of the trace: %s\n", sum.c_str());
  return result.failed ? kCheckFailed : kDone;
}

}  // namespace remote_touch
