// The command line: shared options, and which command the words select.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <sstream>

#include "analysis/storage/digest.h"
#include "core/parameters/parameter.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "runners/interfaces/plugins/plugin_library.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/work_pool.h"

namespace remote_touch {
namespace {

template <class Entries>
bool has(const Entries& entries, const std::string& name) {
  return std::any_of(entries.begin(), entries.end(), [&](const auto& entry) { return name == entry.name; });
}

bool is_of(const std::string& command, const std::string& name) {
  if (command == "run") return has(embedded_experiments(), name);
  if (command == "sweep") return has(embedded_sweeps(), name);
  return has(figures(), name);
}

std::string advice(const char* kind, const std::string& command, const std::string& name,
                   const char* output) {
  return std::string("is ") + kind + ": expected `remote-touch " + command + " " + name + " -o " + output +
         "`";
}

// Adds the renderers of the plug-ins to the catalog. Results record the plug-ins and their hashes.
void load_plugins(const std::vector<std::string>& files) {
  if (files.empty()) return;
  Catalog catalog = catalog_in_use();
  ProgramIdentity program = program_identity();
  for (const std::string& file : files) {
    for (RendererEntry& entry : load_plugin(file)) catalog.add(std::move(entry));
    program.plugins.push_back({file, sha256_of_file(file)});
  }
  use_catalog(std::move(catalog));
  identify_program(std::move(program));
}

constexpr const char* kExamples = R"(Examples:
  remote-touch run fig4.12 -o lift.h5            # a run, and its measures
  remote-touch view lift.h5 -o lift.html         # a page that shows it in 3-D
  remote-touch figure 4.12 -o out                # a figure of the dissertation, with its claims
Pages: README.md and runners/interfaces/cli/README.md)";

// Throws InputError if the name that `run` or `sweep` was given does not exist. A user needs this before the
// message that an option is missing.
void check_name(const CLI::App& command) {
  const bool is_run = command.get_name() == "run";
  if (!is_run && command.get_name() != "sweep") return;
  const std::vector<std::string> given = command.get_option(is_run ? "experiment" : "sweep")->results();
  if (given.empty()) return;
  require_own_kind(given.front(), command.get_name());
  if (is_run)
    Experiment::load(given.front());
  else
    Sweep::load(given.front());
}

// Returns the error of a word that is no command and no option here.
InputError unknown_word(const std::string& word, const CLI::App& place, const CLI::App& app,
                        const std::string& called) {
  std::vector<std::string> known;
  if (word.starts_with('-')) {
    for (const CLI::App* owner : {&place, &app})
      for (const CLI::Option* option : owner->get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  } else {
    for (const CLI::App* command : place.get_subcommands(nullptr)) known.push_back(command->get_name());
  }
  const std::string similar = similar_key(word, known);
  return InputError(word, (word.starts_with('-') ? "unknown option" : "unknown") +
                              (similar.empty() ? "" : "; did you mean " + similar) + ": see " + called +
                              " --help");
}

// Returns an error that names an unknown command or option, because CLI11's own error does not.
InputError usage_error(CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> left = app.remaining(true);
  CLI::App* place = &app;
  std::string called = "remote-touch";
  while (!place->get_subcommands().empty()) {
    place = place->get_subcommands().front();
    called += " " + place->get_name();
  }
  const auto option = std::ranges::find_if(left, [](const auto& word) { return word.starts_with('-'); });
  if (option != left.end()) return unknown_word(*option, *place, app, called);
  if (!place->get_subcommands(nullptr).empty() && !left.empty())
    return unknown_word(left.front(), *place, app, called);
  check_name(*place);
  return InputError(error.what(), "see " + called + " --help");
}

}  // namespace

std::string other_kind(const std::string& name, const std::string& command) {
  std::error_code unreachable;
  if (is_of(command, name) || std::filesystem::exists(name, unreachable)) return {};
  if (is_of("run", name)) return advice("an experiment", "run", name, "FILE");
  if (is_of("sweep", name)) return advice("a sweep", "sweep", name, "FILE");
  // The name of a figure is its number. Experiments and sweeps are named like their files: fig4.12.
  for (const std::string& number : {name, name.starts_with("fig") ? name.substr(3) : std::string()})
    if (is_of("figure", number)) return advice("a figure", "figure", number, "FOLDER");
  return {};
}

void require_own_kind(const std::string& name, const std::string& command) {
  if (const std::string other = other_kind(name, command); !other.empty()) throw InputError(name, other);
}

int run_command_line(int argc, char** argv, CommandLine line, const Kernels& (*choose_kernels)()) {
  CLI::App app{"Haptic rendering of streaming point clouds: simulate, evaluate, reproduce figures."};
  app.require_subcommand(1);
  app.set_version_flag("--version", [] {
    return "remote-touch " + version() + ", " + commit_text(provenance({}, std::string(), {}));
  });
  app.fallthrough();
  app.add_flag("-q,--quiet", line.quiet, "do not show progress");
  app.add_flag_callback("--progress-json", Progress::use_json,
                        "show progress as JSON for other programs, one object in a line");
  app.add_flag(
      "--force", line.force,
      "also overwrite files that are not results of this program; an input file is never overwritten");
  app.add_option(
         "--plugin", line.plugins,
         "a shared library with renderers, one for each --plugin; see runners/interfaces/plugins/README.md")
      ->allow_extra_args(false)
      ->type_name("FILE");
  std::function<int()> act;
  int threads = -1;
  Subcommands commands{app, line, act, threads};
  std::string group;
#define GROUP(name) group = "Subcommands, " name;
#define COMMAND(name) add_##name(commands), app.get_subcommand(#name)->group(group);
  REMOTE_TOUCH_COMMANDS(GROUP, COMMAND)
#undef COMMAND
#undef GROUP
  app.footer(kExamples);
  wrap_standard_output();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw usage_error(app, error);
    std::ostringstream text;  // of --help or --version
    app.exit(error, text, text);
    std::fputs(text.str().c_str(), stdout);
    return kDone;
  }
  if (threads >= 0) use_threads(threads);
  line.kernels = &choose_kernels();
  load_plugins(line.plugins);
  return act();
}

}  // namespace remote_touch
