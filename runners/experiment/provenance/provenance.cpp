#include "runners/experiment/provenance/provenance.h"

#include <fstream>

#include "build_info.h"  // written by the build: version, commit, compiler, flags
#include "runners/experiment/provenance/input_hashes.h"
#include "runners/experiment/provenance/shell_command.h"

namespace remote_touch {

namespace {

ProgramIdentity& this_program() {
  static ProgramIdentity program;
  return program;
}

}  // namespace

void identify_program(ProgramIdentity identity) {
  this_program() = std::move(identity);
}

const ProgramIdentity& program_identity() {
  return this_program();
}

std::vector<std::string> program_words() {
  std::vector<std::string> words = {this_program().name};
  for (const ProgramIdentity::Plugin& plugin : this_program().plugins)
    words.insert(words.end(), {"--plugin", plugin.file});
  return words;
}

std::string program_text() {
  return shell_command(program_words());
}

std::string version() {
  return REMOTE_TOUCH_VERSION;
}

std::string cpu_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t value = line.find(": ");
    if (line.starts_with("model name") && value != std::string::npos) return line.substr(value + 2);
  }
  return {};
}

std::string commit_text(const TextAttributes& attributes) {
  std::string commit = attribute(attributes, "git_commit");
  if (commit == "unknown") return "commit unknown (built without git)";
  if (attribute(attributes, "git_dirty") == "yes") commit += " with local changes";
  return "commit " + commit;
}

TextAttributes provenance(const std::string& config, const std::string& command, const std::string& isa,
                          const std::string& inputs) {
  TextAttributes list = {{"config", config},
                         {"command", command},
                         {"version", REMOTE_TOUCH_VERSION},
                         {"git_commit", REMOTE_TOUCH_GIT_COMMIT},
                         {"git_dirty", REMOTE_TOUCH_GIT_DIRTY},
                         {"source_digest", REMOTE_TOUCH_SOURCES},
                         {"compiler", REMOTE_TOUCH_COMPILER},
                         {"flags", REMOTE_TOUCH_FLAGS}};
  const ProgramIdentity& program = this_program();
  if (!program.sha256.empty()) {
    list.emplace_back("program", program.name);
    list.emplace_back("program_sha256", program.sha256);
  }
  std::string plugins;
  for (const ProgramIdentity::Plugin& plugin : program.plugins)
    plugins.append(plugins.empty() ? "" : "\n")
        .append(in_one_line(plugin.file))
        .append(": sha256 ")
        .append(plugin.sha256);
  if (!plugins.empty()) list.emplace_back("plugins", plugins);
  if (!isa.empty()) list.emplace_back("isa", isa);
  if (!inputs.empty()) list.emplace_back("input_digests", inputs);
  return list;
}

TextAttributes provenance(const std::string& config, const Recipe& recipe, const std::string& isa,
                          const std::string& inputs) {
  TextAttributes list = provenance(config, command_text(recipe), isa, inputs);
  list.insert(list.begin() + 2, {kRecipe, to_json(recipe)});
  return list;
}

}  // namespace remote_touch
