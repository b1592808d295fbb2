#include "runners/experiment/provenance/maker.h"

#include <algorithm>
#include <sstream>

#include "runners/experiment/provenance/provenance.h"

namespace remote_touch {

namespace {

bool is_loaded(const std::string& sha256) {
  const std::vector<ProgramIdentity::Plugin>& loaded = program_identity().plugins;
  return std::any_of(loaded.begin(), loaded.end(),
                     [&](const ProgramIdentity::Plugin& plugin) { return plugin.sha256 == sha256; });
}

// plugins: a line "FILE: sha256 HASH" for each.
bool are_loaded(const std::string& plugins) {
  std::istringstream lines(plugins);
  for (std::string line; std::getline(lines, line);)
    if (!is_loaded(line.substr(line.rfind(' ') + 1))) return false;
  return true;
}

}  // namespace

std::string other_maker(const TextAttributes& result) {
  const std::string program = attribute(result, "program"), plugins = attribute(result, "plugins");
  if (!program.empty() && program != program_identity().name)
    return "was made by " + program + ", which has entries of its own: expected that program";
  if (!are_loaded(plugins)) return "was made with plug-ins: expected --plugin for each of\n" + plugins;
  return {};
}

}  // namespace remote_touch
