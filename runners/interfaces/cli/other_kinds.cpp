#include "runners/interfaces/cli/other_kinds.h"

#include <algorithm>
#include <filesystem>

#include "runners/evaluation/figures/figures.h"
#include "runners/experiment/settings/embedded_data.h"

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

}  // namespace remote_touch
