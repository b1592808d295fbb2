#include "runners/experiment/settings/provenance.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "analysis/storage/digest.h"
#include "build_info.h"  // written by the build: version, commit, compiler, flags
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) ||
         std::string("_-./=,:+%@").find(c) != std::string::npos;
}

std::string quoted(const std::string& word) {
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string safe = "'";
  for (const char c : word) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return safe + "'";
}

ProgramIdentity& this_program() {
  static ProgramIdentity program;
  return program;
}

using Words = std::vector<std::string>;

void add_options(Words& words, const char* option, const Words& values) {
  for (const std::string& value : values) words.insert(words.end(), {option, value});
}

std::string cell_text(const Recipe& recipe) {
  std::string text;
  for (const std::size_t place : recipe.cell)
    text.append(text.empty() ? "" : ",").append(std::to_string(place));
  return text;
}

// Accepts integers only. The library would convert any number.
void take_integer(const Json& json, const char* name, int& value) {
  const auto found = json.find(name);
  if (found == json.end()) return;
  const auto number = found->is_number_integer() ? found->get<std::int64_t>() : -1;
  if (number < 0 || number > std::numeric_limits<int>::max())
    throw InputError(std::string(kRecipe) + "." + name, "expected an integer");
  value = static_cast<int>(number);
}

void take_cell(const Json& json, std::vector<std::size_t>& cell) {
  const auto found = json.find("cell");
  if (found == json.end()) return;
  for (const Json& place : found->get_ref<const Json::array_t&>()) {
    if (!place.is_number_unsigned()) throw InputError(std::string(kRecipe) + ".cell", "expected integers");
    cell.push_back(place.get<std::size_t>());
  }
}

Recipe recipe_in(const Json& json) {
  Recipe recipe{json.at("action").get<std::string>(), json.at("subject").get<std::string>()};
  recipe.overrides = json.value("set", Words()), recipe.tolerances = json.value("tolerances", Words());
  recipe.candidate = json.value("candidate", std::string());
  take_cell(json, recipe.cell);
  take_integer(json, "replicate", recipe.replicate), take_integer(json, "coarse", recipe.coarse);
  return recipe;
}

bool is_known(const std::string& action) {
  constexpr const char* kActions[] = {"run", "sweep", "replay", "figure", "compare"};
  return std::find(std::begin(kActions), std::end(kActions), action) != std::end(kActions);
}

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

// Returns a map from the path in each line to the rest of the line.
std::map<std::string, std::string> by_path(const std::string& text) {
  std::map<std::string, std::string> lines;
  std::istringstream stream(text);
  stream.exceptions(std::ios::badbit);  // throws if memory runs out, which would look like the end
  for (std::string line; std::getline(stream, line);) {
    const std::size_t end = std::min(line.rfind(": "), line.size());
    lines[line.substr(0, end)] = line.substr(std::min(end + 2, line.size()));
  }
  return lines;
}

constexpr const char* kAuthor = "{{The Remote Touch authors}}";
constexpr const char* kTitle =
    "{{Remote Touch}: simulation and evaluation of haptic rendering of streaming point clouds}";
// The year of this version. README.md and CITATION.cff have the same.
constexpr const char* kYear = "{2026}";

// BibTeX counts braces even behind a backslash, so a brace is written as a command.
std::string escaped(char c) {
  static const std::map<char, const char*> commands = {
      {'\\', "backslash"},   {'{', "braceleft"}, {'}', "braceright"}, {'^', "asciicircum"},
      {'~', "asciitilde"},   {'<', "less"},      {'>', "greater"},    {'|', "bar"},
      {'\'', "quotesingle"}, {'`', "asciigrave"}};
  if (const auto found = commands.find(c); found != commands.end())
    return std::string("{\\text") + found->second + "}";
  return std::string("#$%&_").find(c) != std::string::npos ? std::string{'\\', c} : std::string{c};
}

std::string braced(const std::string& text) {
  return "{" + bibtex_text(text) + "}";
}

std::string typewriter(const std::string& text) {
  return "\\texttt" + braced(text);
}

// Names and values of fields; each value includes its braces.
using Fields = std::vector<std::pair<std::string, std::string>>;

std::string bibtex_entry(const std::string& kind, const std::string& key, const Fields& fields) {
  std::size_t width = 0;
  for (const auto& field : fields) width = std::max(width, field.first.size());
  std::string text = "@" + kind + "{" + key;
  for (const auto& [name, value] : fields)
    text += ",\n  " + name + std::string(width - name.size(), ' ') + " = " + value;
  return text + "\n}\n";
}

// Returns a key that BibTeX accepts.
std::string key_of(const std::string& name) {
  std::string key;
  for (const char c : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '_';
    key += is_plain ? c : '-';
  }
  return key.empty() ? "result" : key;
}

// "version 0.3.0, commit HASH with local changes, sources with SHA-256 HASH"
std::string build_text(const TextAttributes& attributes) {
  const std::string text = "version " + attribute(attributes, "version") + ", " + commit_text(attributes);
  const std::string sources = attribute(attributes, "source_digest");
  if (attribute(attributes, "git_dirty") == "no" || sources.empty()) return text;
  return text + ", sources with SHA-256 " + sources;
}

// Returns the names of the user's program or plug-ins that add renderers and the like to the catalog; empty
// if there are none.
std::string own_programs(const TextAttributes& attributes) {
  std::string text;
  if (const std::string program = attribute(attributes, "program"); !program.empty())
    text = "; in the program " + program + ", SHA-256 " + attribute(attributes, "program_sha256");
  if (const std::string plugins = attribute(attributes, "plugins"); !plugins.empty())
    text += "; with the plug-ins " + plugins;
  return text;
}

// Returns the text as TeX.
std::string how_to_repeat(const CitedResult& result) {
  std::string commands;
  for (const std::string& command : result.commands) commands += (commands.empty() ? "" : "; ") + command;
  std::string text;
  if (commands != printable(commands))
    text = "; " + typewriter(shell_command({"remote-touch", "repro", result.file})) +
           " prints the commands that make it again";
  else if (!commands.empty())
    text = "; made again by " + typewriter(commands);
  return result.remark.empty() ? text : text + "; " + bibtex_text(result.remark);
}

}  // namespace

std::string shell_command(const std::vector<std::string>& words) {
  std::string command;
  for (const std::string& word : words) command.append(command.empty() ? "" : " ").append(quoted(word));
  return command;
}

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

const Kernels& kernels_of_level(const std::string& level) {
  for (const Kernels* kernels : supported_kernels())
    if (kernels->isa == level) return *kernels;
  if (level.empty()) return kernels_for(best_isa());
  throw InputError("REMOTE_TOUCH_ISA = " + level, std::string("expected x86-64 up to ") +
                                                      supported_kernels().back()->isa + " on this machine");
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

std::vector<Words> commands(const Recipe& recipe) {
  const bool is_replay = recipe.action == "replay";
  Words words = program_words();
  words.insert(words.end(), {is_replay ? "sweep" : recipe.action, recipe.subject});
  if (recipe.action == "compare") words.push_back(recipe.candidate);
  add_options(words, "--set", recipe.overrides);
  add_options(words, "--tolerance", recipe.tolerances);
  if (recipe.coarse != 1) add_options(words, "--coarse", {std::to_string(recipe.coarse)});
  if (!is_replay) return {words};
  Words again = program_words();
  again.insert(again.end(),
               {"replay", "--cell", cell_text(recipe), "--replicate", std::to_string(recipe.replicate)});
  return {words, again};
}

std::string command_text(const Recipe& recipe) {
  std::string text;
  for (const Words& words : commands(recipe))
    text.append(text.empty() ? "" : "; ").append(shell_command(words));
  return text;
}

std::string to_json(const Recipe& recipe) {
  Json json = {{"action", recipe.action}, {"subject", recipe.subject}};
  if (!recipe.overrides.empty()) json["set"] = recipe.overrides;
  if (recipe.action == "replay") json["cell"] = recipe.cell, json["replicate"] = recipe.replicate;
  if (recipe.coarse != 1) json["coarse"] = recipe.coarse;
  if (recipe.action == "compare") json["candidate"] = recipe.candidate;
  if (!recipe.tolerances.empty()) json["tolerances"] = recipe.tolerances;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);  // names of files need not be UTF-8
}

std::optional<Recipe> recipe_of(const TextAttributes& attributes) {
  try {
    const Json json = json_or_none(attribute(attributes, kRecipe), kRecipe).value_or(Json());
    Recipe recipe = recipe_in(json);
    if (is_known(recipe.action)) return recipe;
  } catch (const Json::exception&) {  // a field is missing, or of another kind
  } catch (const InputError&) {
  }
  return {};
}

std::string other_maker(const TextAttributes& result) {
  const std::string program = attribute(result, "program"), plugins = attribute(result, "plugins");
  if (!program.empty() && program != program_identity().name)
    return "was made by " + program + ", which has entries of its own: expected that program";
  if (!are_loaded(plugins)) return "was made with plug-ins: expected --plugin for each of\n" + plugins;
  return {};
}

void InputHashes::add(const std::vector<InputPart>& parts) {
  for (const InputPart& part : parts)
    if (parts_.count(part) == 0) read(part);
}

void InputHashes::read(const InputPart& part) {
  const std::vector<InputFile> files = files_of(part);  // throws before anything is stored
  auto& known = recordings_[part.path];
  for (const auto& [name, file] : files) {
    if (known.count(name) > 0) continue;
    const std::string sum = sha256_of_file(file);
    std::error_code failure;
    const std::uintmax_t size = std::filesystem::file_size(file, failure);
    if (failure) throw InputError(file.string(), "cannot be read (" + failure.message() + ")");
    known[name] = {sum, size};
  }
  parts_.insert(part);
}

std::string InputHashes::text() const {
  std::string text;
  for (const auto& [path, files] : recordings_) {
    std::vector<std::string> lines;
    std::uintmax_t bytes = 0;
    for (const auto& [name, file] : files) {
      const std::string plain = in_one_line(name);
      // sha256sum puts a backslash in front of a line whose file name it has changed.
      lines.push_back((plain == name ? "" : "\\") + file.sha256 + "  " + plain);
      bytes += file.size;
    }
    std::sort(lines.begin(), lines.end());
    Sha256 hash;
    for (const std::string& line : lines) hash.add((line + "\n").data(), line.size() + 1);
    if (!text.empty()) text += '\n';
    text += in_one_line(path) + ": " + std::to_string(files.size()) + " file(s), " + std::to_string(bytes) +
            " bytes, sha256 " + hash.hex();
  }
  return text;
}

std::string input_hashes(const std::vector<InputPart>& parts) {
  InputHashes hashes;
  hashes.add(parts);
  return hashes.text();
}

std::string in_one_line(const std::string& name) {
  std::string line;
  for (const char c : name) {
    if (c == '\\')
      line += "\\\\";
    else if (c == '\n')
      line += "\\n";
    else if (c == '\r')
      line += "\\r";
    else
      line += c;
  }
  return line;
}

std::vector<ChangedInput> changed_inputs(const std::string& before, const std::string& now) {
  const auto then = by_path(before), later = by_path(now);
  std::vector<ChangedInput> changed;
  for (const auto& [path, line] : then) {
    const auto same = later.find(path);
    if (same == later.end() || same->second != line)
      changed.push_back({path, line, same == later.end() ? "absent" : same->second});
  }
  for (const auto& [path, line] : later)
    if (then.count(path) == 0) changed.push_back({path, "absent", line});
  return changed;
}

void InputHashes::require_unchanged() const {
  remote_touch::require_unchanged({parts_.begin(), parts_.end()}, text());
}

void require_unchanged(const std::vector<InputPart>& parts, const std::string& before) {
  const std::vector<ChangedInput> changed = changed_inputs(before, input_hashes(parts));
  if (changed.empty()) return;
  const ChangedInput& first = changed.front();
  throw InputError(first.path, "changed while it was read (" + first.before + "; now " + first.now +
                                   "): expected files that no program writes during the run");
}

std::string bibtex_text(const std::string& text) {
  std::string value;
  char last = ' ';
  for (const char c : printable(text)) {
    if (c == '-' && last == '-') value += "{}";
    value += escaped(c);
    last = c;
  }
  return value;
}

std::string dissertation_entry() {
  return bibtex_entry(
      "phdthesis", "ryden_2013",
      {{"author", "{Ryd{\\'e}n, F.}"},
       {"title", "{Real-Time Haptic Interaction with Remote Environments using Non-contact Sensors}"},
       {"school", "{University of Washington}"},
       {"year", "{2013}"}});
}

std::string program_entry(const TextAttributes& attributes) {
  const std::string stored_version = attribute(attributes, "version");
  const std::string commit = attribute(attributes, "git_commit");
  const std::string build = commit.empty() || commit == "unknown" ? stored_version : commit.substr(0, 12);
  Fields fields = {{"author", kAuthor}, {"title", kTitle}, {"version", braced(stored_version)}};
  if (stored_version == version()) fields.emplace_back("year", kYear);
  fields.emplace_back("note", braced(build_text(attributes)));
  return bibtex_entry("software", "remote_touch_" + key_of(build), fields);
}

std::string result_entry(const CitedResult& result, const TextAttributes& attributes) {
  const std::filesystem::path file(result.file);
  const std::string name = file.filename().string();
  const std::string origin =
      bibtex_text(result.kind + " ") + typewriter(name) +
      bibtex_text(" of Remote Touch, " + build_text(attributes) + own_programs(attributes));
  std::string note = bibtex_text(result.digest) + how_to_repeat(result);
  if (const std::string inputs = attribute(attributes, "input_digests"); !inputs.empty())
    note += bibtex_text("; it read " + inputs);
  return bibtex_entry("misc", key_of(file.stem().string()),
                      {{"key", braced(name)},
                       {"title", braced(result.title.empty() ? name : result.title)},
                       {"howpublished", "{" + origin + "}"},
                       {"note", "{" + note + "}"}});
}

}  // namespace remote_touch
