#include "runners/interfaces/cli/subcommands.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <sstream>

#include "core/parameters/parameter.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/provenance.h"

namespace remote_touch {

CLI::App* Subcommands::declare(const char* name, const char* meaning, std::function<int()> threads_wanted,
                               std::function<int()> start) {
  CLI::App* command = app.add_subcommand(name, meaning);
  command->callback([&act = act, &threads = threads, command, threads_wanted = std::move(threads_wanted),
                     start = std::move(start)] {
    if (!command->get_subcommands().empty()) return;  // a subcommand was requested instead
    threads = threads_wanted();
    act = start;
  });
  return command;
}

CLI::Validator between(double low, double high) {
  const auto problem = [=](const std::string& text) {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
    std::ostringstream message;
    message << "Value " << text << " not in range [" << low << " - " << high << "]";
    return message.str();
  };
  return {problem, "NUMBER"};
}

void add_set(CLI::App* command, std::vector<std::string>& overrides, const char* meaning) {
  command->add_option("--set", overrides, meaning)->allow_extra_args(false);
}

void print_replaced(const std::vector<std::string>& overrides) {
  for (const std::string& line : replaced_settings(overrides))
    std::fprintf(stderr, "%s: %s\n", program_identity().name.c_str(), printable(line).c_str());
}

}  // namespace remote_touch
