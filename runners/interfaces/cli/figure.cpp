#include <algorithm>

#include "core/parameters/input_error.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/figure_folder.h"
#include "runners/interfaces/cli/figure_runs.h"
#include "runners/interfaces/cli/progress.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

namespace {

// Returns each requested figure once, the quickest first.
std::vector<FigureRun> chosen_figures(const FigureRequest& request) {
  for (const std::string& name : request.names) {
    const auto is_named = [&](const FigureEntry& entry) { return name == "all" || name == entry.name; };
    if (std::none_of(figures().begin(), figures().end(), is_named))
      throw InputError("figure " + name, "unknown: expected a name from `remote-touch list`");
  }
  std::vector<FigureRun> chosen;
  for (const FigureEntry& entry : figures()) {
    const auto names_it = [&](const std::string& name) { return name == "all" || name == entry.name; };
    const int coarse = request.quick ? std::max(request.coarse, entry.quick_coarse) : request.coarse;
    if (std::none_of(request.names.begin(), request.names.end(), names_it)) continue;
    if (!request.overrides.empty() && !entry.takes_recording)
      throw InputError("figure " + std::string(entry.name) + " --set " + request.overrides.front(),
                       "this figure has no settings: expected camera-error");
    chosen.push_back({&entry, coarse, request.overrides});
  }
  return quickest_first(chosen);
}

// A missing recording is no failure of the method: the figure gets a claim that says so, and the others are
// made.
Figure made_or_not_run(const FigureEntry& entry, FigureContext& context) {
  try {
    return entry.make(context);
  } catch (const MissingRecording& error) {
    Figure figure{entry.name, "Not run", std::string("Not run: ") + error.what()};
    figure.claims = {claim_not_run(entry.name, entry.summary, error.what())};
    return figure;
  }
}

}  // namespace

int command_figure(const CommandLine& line, const FigureRequest& request) {
  const std::vector<FigureRun> runs = chosen_figures(request);
  FigureFolder folder(line, request.folder, runs);
  Progress shown("figures", line.quiet);
  make_figures(
      line, runs, made_or_not_run,
      [&](std::size_t run, const FigureContext& context, Figure figure) {
        folder.finish(run, context, std::move(figure));
      },
      [&](const FigureProgress& progress) { folder.report(progress, shown); });
  shown.clear();
  return folder.exit_code();
}

}  // namespace remote_touch
