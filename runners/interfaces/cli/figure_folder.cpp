#include "runners/interfaces/cli/figure_folder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "analysis/figures/result_file.h"
#include "analysis/storage/atomic_file.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/interfaces/cli/outputs.h"

namespace remote_touch {

namespace {

namespace fs = std::filesystem;

// No buffer of fixed size is used for the line, because a claim may have any length.
std::string line_of(const Claim& claim) {
  const std::string verdict = claim.verdict == Verdict::fail ? "FAIL" : verdict_name(claim.verdict);
  const std::string paper = claim.verdict == Verdict::differs ? ", " + claim.source + ": " + claim.paper : "";
  char measured[40];
  std::snprintf(measured, sizeof measured, "%.6g", claim.measured);
  return "  " + verdict + std::string(verdict.size() < 7 ? 7 - verdict.size() : 0, ' ') + " " +
         (claim.set_up ? "set-up: " : "") + claim.claim + ": " + measured + " " + claim.unit + " (" +
         claim.criterion + paper + ")\n";
}

// Leaves claims about whole maps open, because a share of a coarse map is not that of the whole map.
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

bool was_made(const Figure& figure) {
  return std::none_of(figure.claims.begin(), figure.claims.end(),
                      [](const Claim& claim) { return claim.verdict == Verdict::not_run; });
}

fs::path made(const fs::path& folder) {
  make_folder(folder);
  return folder;
}

std::vector<std::string> names_of_figures() {
  std::vector<std::string> list;
  for (const FigureEntry& entry : figures()) list.emplace_back(entry.name);
  return list;
}

}  // namespace

FigureFolder::FigureFolder(const CommandLine& line, const std::string& folder,
                           const std::vector<FigureRun>& runs)
    : line_(line),
      folder_(folder),
      runs_(runs),
      claims_(made(folder_) / "claims.json", names_of_figures()),
      printed_(runs.size()) {
  require_report(line, (folder_ / "claims.json").string(), {}, kClaims);
  require_report(line, progress_file().string(), {}, kFigureProgress);
  for (const FigureRun& run : runs) require_result(line, file_of(run.entry->name), {});
  write_progress({std::vector<JobProgress>(runs.size()), TimeLeft{std::vector<double>(runs.size()), 0}});
}

FigureFolder::~FigureFolder() {
  std::error_code ignored;
  fs::remove(progress_file(), ignored);
}

void FigureFolder::finish(std::size_t run, const FigureContext& context, Figure figure) {
  context.require_unchanged_inputs();
  Recipe recipe{"figure", figure.name, runs_[run].overrides};
  if (context.made_runs_of_maps() < context.runs_of_maps()) {
    leave_unjudged(figure, context, runs_[run].coarse);
    recipe.coarse = runs_[run].coarse;
  }
  const fs::path file = file_of(figure.name);
  TextAttributes attributes =
      provenance(context.configurations(), recipe, line_.kernels->isa, context.inputs());
  attributes.emplace_back("summary", runs_[run].entry->summary);
  write_figure(file, figure, attributes);
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
  for (const std::string& note : context.note_lines()) printed_[run] += "  note: " + note + "\n";
}

void FigureFolder::report(const FigureProgress& progress, Progress& shown) {
  for (; next_ < runs_.size() && progress.runs[next_].state == JobState::done; ++next_) {
    shown.clear();
    std::fputs(printed_[next_].c_str(), stdout);
  }
  std::fflush(stdout);
  write_progress(progress);
  shown.update(progress_text(runs_, progress));
}

int FigureFolder::exit_code() const {
  std::fputs(not_made_.c_str(), stderr);
  return !all_hold_ ? kCheckFailed : made_ == 0 ? kBadInput : kDone;
}

// Writes the progress file for scripts/plot --follow. That program does not end by itself, and only this file
// says which figures are still to come.
void FigureFolder::write_progress(const FigureProgress& progress) {
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

}  // namespace remote_touch
