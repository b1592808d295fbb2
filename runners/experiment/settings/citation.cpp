#include "runners/experiment/settings/citation.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <utility>

#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"

namespace remote_touch {

namespace {

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
