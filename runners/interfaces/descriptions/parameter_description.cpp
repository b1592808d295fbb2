#include "runners/interfaces/descriptions/parameter_description.h"

#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/sections.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

namespace {

// An entry to which the first name of the path leads.
struct Owner {
  std::string name, section;
  std::unique_ptr<Configurable> settings;
};

std::vector<Owner> owners_of(const std::string& name) {
  std::vector<Owner> owners;
  for (const ExperimentSection& section : experiment_sections())
    for (const SectionEntry& entry : section.entries()) {
      if (name.empty() || (name != section.key && name != entry.name)) continue;
      owners.push_back({entry.name.empty() ? section.key : entry.name, section.key, entry.make()});
    }
  return owners;
}

// Pure numbers, and columns without a unit, have no such text.
std::string unit_text(std::string_view unit) {
  std::string text;
  if (!unit.empty() && unit != "1") text.append("unit ").append(unit).append("; ");
  return text;
}

void print(const Owner& owner, const Parameter& parameter, std::FILE* out) {
  const Unit* unit = unit_of(parameter.name);
  std::fprintf(out, "%s.%s: a parameter of \"%s\": %s\n  %sdefault %s; allowed %s%s\n", owner.name.c_str(),
               parameter.name.c_str(), owner.section.c_str(), parameter.help.c_str(),
               unit_text(unit ? unit->text : "").c_str(), value_text(parameter).c_str(),
               allowed(parameter).c_str(), parameter.is_live ? "; live" : "");
}

void describe_column(const std::string& name, std::FILE* out) {
  std::vector<std::string> known;
  for (const TraceColumn& column : trace_columns()) {
    known.emplace_back(column.name);
    if (name != column.name) continue;
    std::fprintf(out, "trace.%s: a column of a trace: %s\n", column.name, meaning_of(column).c_str());
    if (std::string_view(column.meaning) != column.meaning_with_tool)
      std::fprintf(out, "  with a tool: %s\n", column.meaning_with_tool);
    std::fprintf(out, "  %s%d in each row; in %s\n", unit_text(column.unit).c_str(), column.width,
                 runs_with(column.part));
    return;
  }
  refuse_key(name, known, "trace.");
}

}  // namespace

bool describe_parameter(const std::string& path, std::FILE* out) {
  const std::vector<std::string> keys = path_keys(path);
  const bool in_list = keys.size() == 3 && is_index(keys[1]);
  if (keys.size() != 2 && !in_list) return false;
  if (keys[0] == "trace" && !in_list) return describe_column(keys[1], out), true;
  std::vector<std::string> known;
  bool found = false;
  const std::vector<Owner> owners = owners_of(keys.front());
  for (const Owner& owner : owners)
    for (const Parameter& parameter : owner.settings->settings()) {
      known.push_back(parameter.name);
      if (parameter.name != keys.back()) continue;
      print(owner, parameter, out);
      found = true;
    }
  if (!found && !owners.empty()) refuse_key(keys.back(), known, keys.front() + ".");
  return found;
}

std::string meaning_of(const TraceColumn& column) {
  std::string meaning = column.meaning;
  for (std::size_t i = 0; i < column.value_names.size(); ++i)
    meaning.append(i == 0 ? ": " : ", ").append(std::to_string(i)).append(" ").append(column.value_names[i]);
  return meaning;
}

const char* runs_with(TracePart part) {
  switch (part) {
    case TracePart::always:
      break;
    case TracePart::tool:
      return "a run with a tool";
    case TracePart::guidance:
      return "a run with guidance or a sequence";
    case TracePart::replay:
      return "a run that replays a known contact";
    case TracePart::measured_surface:
      return "a run with a measured surface beside the true one";
    case TracePart::slave:
      return "a run with a slave";
    case TracePart::channel_energy:
      return "a run whose hand is to feel the slave";
    case TracePart::slave_tool:
      return "a run with a slave that has a tool";
    case TracePart::rounded_hand:
      return "a run whose device rounds the pose of the hand";
    case TracePart::hand:
      return "a run with an operator or a device";
  }
  return "every run";
}

}  // namespace remote_touch
