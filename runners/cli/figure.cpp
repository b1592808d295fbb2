#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "analysis/figures/result_file.h"
#include "analysis/storage/atomic_file.h"
#include "core/parameters/input_error.h"
#include "runners/cli/claims_file.h"
#include "runners/cli/commands.h"
#include "runners/cli/figure_runs.h"
#include "runners/cli/progress.h"
#include "runners/provenance/provenance.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

namespace {

namespace fs = std::filesystem;

// Each once.
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
    if (std::any_of(request.names.begin(), request.names.end(), names_it)) chosen.push_back({&entry, coarse});
  }
  return quickest_first(chosen);
}

std::string line_of(const Claim& claim) {
  const char* verdict = claim.verdict == Verdict::fail ? "FAIL" : verdict_name(claim.verdict);
  const std::string paper =
      claim.verdict == Verdict::differs ? ", the dissertation prints: " + claim.paper : "";
  char line[1000];
  std::snprintf(line, sizeof line, "  %-7s %s%s: %.6g %s (%s%s)\n", verdict, claim.set_up ? "set-up: " : "",
                claim.claim.c_str(), claim.measured, claim.unit.c_str(), claim.criterion.c_str(),
                paper.c_str());
  return line;
}

// A share of a coarse map is not that of the whole.
void leave_unjudged(Figure& figure, const FigureContext& context, int coarse) {
  figure.caption += " Made from " + std::to_string(context.made_runs_of_maps()) + " of the " +
                    std::to_string(context.runs_of_maps()) + " runs of its maps: one in " +
                    std::to_string(coarse) + " values of each axis. Claims about a whole map stay open.";
  for (Claim& claim : figure.claims) {
    if (!claim.of_map) continue;
    claim.verdict = Verdict::open;
    claim.criterion += ", not judged on a coarse map";
  }
}

// A recording that is not there is no failure of the method: the claim says so and the rest goes on.
Figure made_or_not_run(const FigureEntry& entry, const FigureContext& context) {
  try {
    return entry.make(context);
  } catch (const MissingRecording& error) {
    Figure figure{entry.name, "Not run", std::string("Not run: ") + error.what()};
    figure.claims = {claim_not_run(entry.name, entry.summary, error.what())};
    return figure;
  }
}

bool was_made(const Figure& figure) {
  return std::none_of(figure.claims.begin(), figure.claims.end(),
                      [](const Claim& claim) { return claim.verdict == Verdict::not_run; });
}

// A folder that figures are written into.
class FigureFolder {
 public:
  FigureFolder(const CommandLine& line, const std::string& folder, const std::vector<FigureRun>& runs)
      : line_(line),
        folder_(folder),
        runs_(runs),
        claims_(make(folder_) / "claims.json", names()),
        printed_(runs.size()) {
    write_progress({std::vector<JobProgress>(runs.size()), TimeLeft{std::vector<double>(runs.size()), 0}});
  }
  ~FigureFolder() {
    std::error_code ignored;
    fs::remove(progress_file(), ignored);
  }

  void finish(std::size_t run, const FigureContext& context, Figure figure) {
    Recipe recipe{"figure", figure.name};
    if (context.made_runs_of_maps() < context.runs_of_maps()) {
      leave_unjudged(figure, context, runs_[run].coarse);
      recipe.coarse = runs_[run].coarse;
    }
    const fs::path file = folder_ / ("fig" + figure.name + ".h5");
    write_figure(file, figure,
                 provenance(context.configurations(), recipe, line_.kernels->isa, context.inputs()));
    claims_.replace(figure.name, figure.claims);
    if (was_made(figure))
      ++made_;
    else
      not_made_ += "remote-touch: figure " + figure.name + ": " + figure.caption + "\n";
    printed_[run] = "figure " + figure.name + " -> " + file.string() + "\n";
    for (const Claim& claim : figure.claims) {
      printed_[run] += line_of(claim);
      all_hold_ &= claim.verdict != Verdict::fail;
    }
  }
  // What the figures say is printed in their order, whichever was made first.
  void report(const FigureProgress& progress, Progress& shown) {
    for (; next_ < runs_.size() && progress.runs[next_].state == JobState::done; ++next_) {
      shown.clear();
      std::fputs(printed_[next_].c_str(), stdout);
    }
    std::fflush(stdout);
    write_progress(progress);
    shown.update(words(runs_, progress));
  }
  // What was not made is said on the standard error too; where that is all, nothing was done.
  int exit_code() const {
    std::fputs(not_made_.c_str(), stderr);
    return made_ == 0 ? kBadInput : all_hold_ ? kDone : kCheckFailed;
  }

 private:
  static fs::path make(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure)
      throw InputError(folder.string(),
                       "cannot be made (" + failure.message() + "): expected a writable folder");
    return folder;
  }
  static std::vector<std::string> names() {
    std::vector<std::string> list;
    for (const FigureEntry& entry : figures()) list.emplace_back(entry.name);
    return list;
  }
  fs::path progress_file() const { return folder_ / "progress.json"; }

  // For scripts/plot --follow: in a program that does not end by itself nothing else says what is still to
  // come.
  void write_progress(const FigureProgress& progress) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      const JobState state = progress.runs[i].state;
      list.push_back({{"name", runs_[i].entry->name},
                      {"summary", runs_[i].entry->summary},
                      {"state", state == JobState::waiting   ? "waiting"
                                : state == JobState::running ? "running"
                                                             : "done"},
                      {"left_s", std::round(progress.left.of_job_s[i])}});
    }
    const std::string text =
        nlohmann::ordered_json{{"left_s", std::round(progress.left.all_s)}, {"figures", list}}.dump(1) + "\n";
    if (text == written_) return;
    write_file_atomically(progress_file(), text.data(), text.size());
    written_ = text;
  }

  const CommandLine& line_;
  fs::path folder_;
  const std::vector<FigureRun>& runs_;
  ClaimsFile claims_;
  std::vector<std::string> printed_;
  std::size_t next_ = 0;
  bool all_hold_ = true;
  int made_ = 0;
  std::string not_made_;
  std::string written_;
};

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
