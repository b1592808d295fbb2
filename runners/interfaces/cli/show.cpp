// The commands that show and cite results and what is built in: `view`, `export`, `list`, `describe`, `cite`
// and `cache`.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/result_file.h"
#include "analysis/trace/columns.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "runners/evaluation/regression/baselines.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/evaluation/scorecard/scorecard.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/cache_file.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "runners/presentation/descriptions.h"
#include "runners/presentation/export_formats.h"
#include "runners/presentation/result_pages.h"
#include "runners/sweep/stored_sweep.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

struct ListRequest {
  std::vector<std::string> kind;  // words of a kind, such as {"fixture", "rules"}; empty: all kinds
};

struct DescribeRequest {
  std::string name;  // a name, or NAME.PARAMETER
};

struct CiteRequest {
  std::string file;  // empty: the program itself
};

struct CacheRequest {
  std::optional<double> max_MB;  // none: nothing is removed
};

struct ExportRequest {
  std::string file;
  std::string output;  // its ending is the format
  int every = 1;
};

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

int command_view(const CommandLine& line, const ViewRequest& request) {
  write_view(line, request);
  return kDone;
}

int command_export(const CommandLine& line, const ExportRequest& request) {
  require_every(request.every);
  const ExportFormat& format = export_format(request.output);
  require_different_file(request.output, request.file);
  require_writable(request.output);
  const Hdf5Reader result(request.file);
  const FileLock lock(request.output);
  NewFiles files;
  const auto require_allowed = [&](const std::filesystem::path& file, const std::string& opening) {
    require_export(line, file.string(), {request.file}, opening);
  };
  export_result(format,
                {result, request.output, files, require_allowed, line.kernels, line.stop, request.every});
  const std::size_t count = files.count();
  files.finish();
  const std::string kept = request.every > 1 ? formatted(", one in %d ticks", request.every) : "";
  std::printf("%s: %zu file%s, %.1f MB%s\n", printable(request.output).c_str(), count, count == 1 ? "" : "s",
              1e-6 * static_cast<double>(files.size()), kept.c_str());
  return kDone;
}

void print(const NamedKind& kind) {
  std::puts(kind.kind.c_str());
  for (const NamedKind::Row& row : kind.rows)
    std::printf("  %-18s %s\n", row.name.c_str(), row.summary.c_str());
}

int command_list(const CommandLine&, const ListRequest& request) {
  if (!request.kind.empty())
    print(named_kind(joined(request.kind, " ")));
  else
    for (const NamedKind& kind : named_kinds()) print(kind);
  return kDone;
}

int command_describe(const CommandLine&, const DescribeRequest& request) {
  std::fputs(described(request.name).c_str(), stdout);
  return kDone;
}

// Hashes and sessions store no digest.
std::string digest_text(const std::string& file, const TextAttributes& attributes) {
  const std::string digest = attribute(attributes, "digest");
  return digest.empty() ? "file with SHA-256 " + sha256_of_file(file) : "digest " + digest;
}

void print_entries(CitedResult cited, const TextAttributes& attributes) {
  cited.title = title_of(cited.file, attributes);
  cited.digest = digest_text(cited.file, attributes);
  std::printf("%s\n%s\n%s", dissertation_entry().c_str(), program_entry(attributes).c_str(),
              result_entry(cited, attributes).c_str());
}

void print_session_entries(const std::string& file, const TextAttributes& attributes) {
  CitedResult cited{file, "recording of a live session"};
  cited.remark = "what happened live cannot be repeated, but " +
                 shell_command({"remote-touch", "run", file, "-o", "again.h5"}) + " computes its trace again";
  print_entries(cited, attributes);
}

void print_result_entries(const StoredResult& result) {
  if (!result.of("plan_digest").empty())
    throw InputError(result.file(), "is a sweep in progress: expected a finished one");
  const bool is_figure = result.kind() == "figure";
  CitedResult cited{result.file(), result.kind()};
  if (is_figure) cited.kind += " " + result.of("figure");
  if (is_figure && result.of("figure") == kScorecardFigure) cited.kind = "scorecard";
  Remaking again = result.remaking();
  cited.commands = std::move(again.commands), cited.remark = std::move(again.reason);
  print_entries(cited, result.attributes());
}

int command_cite(const CommandLine&, const CiteRequest& request) {
  if (request.file.empty()) {
    std::printf("%s\n%s", dissertation_entry().c_str(),
                program_entry(provenance({}, std::string(), {})).c_str());
    return kDone;
  }
  const Hdf5Reader file(request.file);
  if (attribute(file.attributes(), "schema") == schema_name("session"))
    print_session_entries(request.file, file.attributes());
  else
    print_result_entries(StoredResult(file));
  return kDone;
}

int command_cache(const CommandLine& line, const CacheRequest& request) {
  const std::filesystem::path folder = cache_folder();
  if (folder.empty())
    throw InputError("REMOTE_TOUCH_CACHE", "is not set, nor is HOME: expected a folder for the cache");
  constexpr double kBytes_per_MB = 1e6;
  const CacheSize size =
      request.max_MB ? shrink_cache(folder, static_cast<std::uintmax_t>(*request.max_MB * kBytes_per_MB))
                     : cache_size(folder);
  std::printf("%s: %zu files, %.1f MB; the maximum is %.1f MB\n", folder.c_str(), size.files,
              static_cast<double>(size.bytes) / kBytes_per_MB,
              static_cast<double>(max_cache_bytes()) / kBytes_per_MB);
  std::printf("instruction set of the inner loops: %s\n", line.kernels->isa);
  return kDone;
}

}  // namespace

void require_every(int every) {
  if (every < 1) throw InputError("--every " + std::to_string(every), "expected 1 or more");
}

std::string title_of(const std::string& file, const TextAttributes& attributes) {
  const std::string title = attribute(attributes, "title"), config = attribute(attributes, "config");
  if (!title.empty() || config.empty()) return title;
  const Json settings = parse_json(config, file + " config");
  const auto stored = settings.is_object() ? settings.find("title") : settings.end();
  return stored != settings.end() && stored->is_string() ? stored->get<std::string>() : std::string();
}

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
  write_file_atomically(request.output, page.html);
  std::printf("%s: %.1f MB\n%s", printable(request.output).c_str(),
              1e-6 * static_cast<double>(page.html.size()), page.shown.c_str());
}

void add_list(Subcommands& commands) {
  auto [list, listed] = commands.add(
      "list",
      "list the names of scenarios, renderers, trajectories, experiments, sweeps, tools, figures, measures",
      command_list, kNoThreads);
  list->add_option("kind", listed->kind, "list only this kind, for example renderers (default: all)");
}

void add_describe(Subcommands& commands) {
  auto [describe, described] = commands.add(
      "describe",
      "describe the parameters of a name: range, default, meaning; `trace`: the columns of a trace",
      command_describe, kNoThreads);
  describe
      ->add_option("name", described->name,
                   "a name from `remote-touch list`, or trace; or one parameter: proxy.r1_m, trace.force")
      ->required();
}

void add_view(Subcommands& commands) {
  auto [view, viewed] = commands.add(
      "view", "make a page that shows a trace, two of them, or a sweep, in 3-D and over time", command_view);
  view->add_option("results", viewed->results, "a trace, two traces to compare, or a sweep")
      ->required()
      ->expected(1, 2);
  view->add_option("-o,--output", viewed->output, "the HTML page to write")->required();
  view->add_option("--cells", viewed->cells,
                   "cells of a sweep to show, 3,4 or noise_sigma_m=0.003,..., one for each --cells "
                   "(default: failures nearest to the limit)")
      ->allow_extra_args(false);
  view->add_option("--max-mb", viewed->max_MB, "largest size of the page, MB; points are left out for it")
      ->check(between(1.0, 1000.0));
  view->add_option(
      "--claims", viewed->claims,
      "claims.json of `remote-touch figure`: the page of a figure's run shows the figure's claims");
}

void add_export(Subcommands& commands) {
  auto [exporting, exported] =
      commands.add("export", "write a result in the format of other programs", command_export);
  exporting->add_option("file", exported->file, "a trace, sweep or figure")->required();
  exporting
      ->add_option("output", exported->output,
                   "the file to write; its ending is the format: " + known_formats())
      ->required();
  exporting->add_option("--every", exported->every,
                        "keep only every n-th tick of a trace, and the last one; numbers stay as they are");
}

void add_cite(Subcommands& commands) {
  auto [citing, cite] = commands.add(
      "cite", "print BibTeX entries of the dissertation and of this program, or also of a result",
      command_cite, kNoThreads);
  citing->add_option(
      "file", cite->file,
      "a trace, sweep, figure, scorecard or recorded live session (default: none, the program)");
}

void add_cache(Subcommands& commands) {
  auto [command, cache] = commands.add(
      "cache",
      "show folder and size of the cache of tools and measured times, and the instruction set in use",
      command_cache, kNoThreads);
  command
      ->add_option("--max", cache->max_MB,
                   "remove the files used longest ago until at most this many MB are left; 0: all files")
      ->check(between(0, 1e9));
}

}  // namespace remote_touch
