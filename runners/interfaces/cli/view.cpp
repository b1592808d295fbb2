#include <cstdio>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/input_error.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/presentation/view/sweep_page.h"
#include "runners/presentation/view/trace_page.h"

namespace remote_touch {

namespace {

bool is_sweep_file(const std::string& file) {
  const Hdf5Reader result(file);
  if (attribute(result.attributes(), "schema").starts_with("remote-touch-session/"))
    throw InputError(file, "is a recorded live session: expected its trace, made by remote-touch run " +
                               file + " -o TRACE.h5");
  const std::string kind = kind_of(result);
  if (kind != "trace" && kind != "sweep")
    throw InputError(file, "is a " + kind + ": expected a trace or a sweep");
  return kind == "sweep";
}

ViewPage page_of(const ViewRequest& request, const ViewOptions& options) {
  bool is_sweep = false;
  for (const std::string& file : request.results) is_sweep |= is_sweep_file(file);
  if (is_sweep && request.results.size() > 1)
    throw InputError(request.results.back(),
                     "a sweep cannot be shown with another result: expected one sweep alone, or two traces");
  if (!is_sweep && !request.cells.empty())
    throw InputError("--cells " + request.cells.front(),
                     "only for a sweep, but " + request.results.front() + " is a trace: expected a sweep");
  if (is_sweep && !request.claims.empty())
    throw InputError("--claims " + request.claims,
                     "only for traces, but " + request.results.front() + " is a sweep: expected a trace");
  if (is_sweep) return sweep_page(request.results.front(), request.cells, options);
  return trace_page({request.results.begin(), request.results.end()}, options);
}

}  // namespace

void write_view(const CommandLine& line, const ViewRequest& request) {
  std::vector<std::string> inputs = request.results;
  inputs.push_back(request.claims);
  require_report(line, request.output, inputs, kPage);
  ViewOptions options;
  options.max_bytes = static_cast<std::size_t>(1e6 * request.max_MB);
  options.claims = request.claims;
  options.kernels = line.kernels;
  options.stop = line.stop;
  const ViewPage page = page_of(request, options);
  write_file_atomically(request.output, page.html.data(), page.html.size());
  std::printf("%s: %.1f MB\n%s", printable(request.output).c_str(),
              1e-6 * static_cast<double>(page.html.size()), page.shown.c_str());
}

int command_view(const CommandLine& line, const ViewRequest& request) {
  write_view(line, request);
  return kDone;
}

}  // namespace remote_touch
