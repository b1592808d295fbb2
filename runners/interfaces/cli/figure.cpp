#include "runners/interfaces/cli/figure.h"

#include <omp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/result_file.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {
namespace {

constexpr double kReportEvery_s = 0.5;

std::vector<double> expected_s(const std::vector<FigureRun>& runs) {
  std::vector<double> list;
  for (const FigureRun& run : runs) list.push_back(run.expected_s());
  return list;
}

namespace fs = std::filesystem;

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

struct FigureRequest {
  std::vector<std::string> names;
  std::string folder;
  int coarse = 1;      // uses every coarse-th value of a map's axes
  bool quick = false;  // uses coarse maps where a map takes minutes
};

// Returns each requested figure once, the quickest first.
std::vector<FigureRun> chosen_figures(const FigureRequest& request) {
  for (const std::string& name : request.names) {
    const auto is_named = [&](const FigureEntry& entry) { return name == "all" || name == entry.name; };
    if (std::none_of(figures().begin(), figures().end(), is_named))
      throw InputError("figure " + name,
                       "unknown: expected a name from `remote-touch list`; scripts/studies makes studies");
  }
  std::vector<FigureRun> chosen;
  for (const FigureEntry& entry : figures()) {
    const auto names_it = [&](const std::string& name) { return name == "all" || name == entry.name; };
    const int coarse = request.quick ? std::max(request.coarse, entry.quick_coarse) : request.coarse;
    if (std::none_of(request.names.begin(), request.names.end(), names_it)) continue;
    chosen.push_back({&entry, coarse});
  }
  return quickest_first(chosen);
}

// A missing recording is no failure of the method: the figure gets a claim that says so, and the others are
// made.
Figure made_or_not_run(const FigureEntry& entry, FigureContext& context) {
  try {
    return entry.make(context);
  } catch (const MissingInput& error) {
    Figure figure{entry.name, "Not run", std::string("Not run: ") + error.what()};
    figure.claims = {claim_not_run(entry.name, entry.summary, error.what())};
    return figure;
  }
}

int command_figure(const CommandLine& line, const FigureRequest& request) {
  for (const std::string& name : request.names) require_own_kind(name, "figure");
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

std::vector<std::string> figures_thinned_by_quick() {
  std::vector<std::string> names;
  for (const FigureEntry& entry : figures())
    if (entry.quick_coarse > 1) names.emplace_back(entry.name);
  return names;
}

}  // namespace

std::vector<FigureRun> quickest_first(const std::vector<FigureRun>& runs) {
  std::vector<FigureRun> ordered;
  for (const std::size_t i : shortest_first(expected_s(runs))) ordered.push_back(runs[i]);
  return ordered;
}

void make_figures(const CommandLine& line, const std::vector<FigureRun>& runs,
                  const std::function<Figure(const FigureEntry&, FigureContext&)>& make,
                  const std::function<void(std::size_t, const FigureContext&, Figure)>& finish,
                  const std::function<void(const FigureProgress&)>& report) {
  const int threads = omp_get_max_threads();
  WorkPool pool(threads);
  std::mutex one_at_a_time;
  std::vector<std::exception_ptr> failures(runs.size() + 1);
  const auto pieces = [&](std::size_t count, const auto& work) { pool.for_each(count, work); };
  std::vector<std::function<void()>> jobs;
  for (std::size_t i = 0; i < runs.size(); ++i)
    jobs.emplace_back([&, i] {
      try {
        if (line.stop && *line.stop) throw Interrupted{};
        FigureContext context(*line.kernels, line.stop, runs[i].coarse, pieces);
        Figure figure = make(*runs[i].entry, context);
        const std::lock_guard lock(one_at_a_time);
        finish(i, context, std::move(figure));
      } catch (...) {
        failures[i] = std::current_exception();
      }
    });
  const std::vector<double> expected = expected_s(runs);
  pool.run(jobs, kReportEvery_s, [&] {
    if (failures.back()) return;
    try {
      const std::vector<JobProgress> progress = pool.progress();
      report({progress, time_left(expected, progress, threads)});
    } catch (...) {  // rethrown when the jobs have ended, because they use local objects
      failures.back() = std::current_exception();
    }
  });
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

std::string progress_text(const std::vector<FigureRun>& runs, const FigureProgress& progress) {
  std::size_t made = 0;
  std::string at_work;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    made += progress.runs[i].state == JobState::done ? 1 : 0;
    if (progress.runs[i].state == JobState::running)
      at_work += (at_work.empty() ? ", making " : ", ") + std::string(runs[i].entry->name);
  }
  return std::to_string(made) + " of " + std::to_string(runs.size()) + at_work + "; about " +
         std::to_string(std::lround(progress.left.all_s)) + " s left";
}

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
  Recipe recipe{"figure", figure.name};
  if (context.made_runs_of_maps() < context.runs_of_maps()) {
    figure.caption += coarse_text(context.made_runs_of_maps(), context.runs_of_maps(), runs_[run].coarse);
    for (Claim& claim : figure.claims)
      if (claim.of_map) leave_open(claim);
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
    printed_[run] += line_of(claim) + "\n";
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
  write_file_atomically(progress_file(), text);
  written_ = text;
}

void add_figure(Subcommands& commands) {
  auto [command, figure] =
      commands.add("figure", "reproduce figures and check their claims; writes HDF5 files and claims.json",
                   command_figure);
  command->add_option("names", figure->names, "names from `remote-touch list`, or all")->required();
  command->add_option("-o,--output", figure->folder, "the folder to write into")->required();
  command
      ->add_option("--coarse", figure->coarse,
                   "maps: use only every Nth value of each axis; claims about a whole map then stay open")
      ->check(CLI::Range(1, 10));
  command->add_flag("--quick", figure->quick,
                    "use only every second to fourth value of each axis of the maps that take minutes: " +
                        joined(figures_thinned_by_quick(), ", "));
}

}  // namespace remote_touch
