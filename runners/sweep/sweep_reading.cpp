#include "runners/sweep/sweep_reading.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

namespace {

const std::vector<std::string> kParts = {"title",      "experiment", "set",    "axes",
                                         "replicates", "measures",   "refine", "keep"};

// Returns the path of an experiment that a sweep file names. A file in the folder of the sweep file comes
// first.
std::string beside(const std::string& sweep_file, const std::string& experiment) {
  const auto there = std::filesystem::path(sweep_file).parent_path() / experiment;
  std::error_code unreachable;
  return std::filesystem::is_regular_file(there, unreachable) ? there.string() : experiment;
}

}  // namespace

bool is_of_sweep(const std::string& assignment) {
  const std::string key = assignment.substr(0, assignment.find_first_of(".="));
  return std::find(kParts.begin(), kParts.end(), key) != kParts.end();
}

void refuse_unknown_part(const Json& json, const std::string& label) {
  for (const auto& item : json.items())
    if (!is_of_sweep(item.key()))
      throw InputError(label + ": " + item.key(), "unknown: expected " + joined(kParts, ", "));
}

Json read_experiment(const Json& json, const std::string& label, const std::vector<std::string>& overrides) {
  const auto found = json.find("experiment");
  if (found == json.end() || !(found->is_string() || found->is_object()))
    throw InputError(label + ": experiment", "missing: expected a name, a file or an experiment itself");
  std::vector<std::string> settings;
  if (const auto set = json.find("set"); set != json.end()) {
    if (!set->is_object()) throw InputError(label + ": set", "expected {\"path\": value, ...}");
    for (const auto& item : set->items()) settings.push_back(item.key() + "=" + item.value().dump());
  }
  settings.insert(settings.end(), overrides.begin(), overrides.end());
  const Experiment experiment = found->is_string()
                                    ? Experiment::load(beside(label, found->get<std::string>()), settings)
                                    : Experiment::from_json(found->dump(), label + ": experiment", settings);
  if (experiment.settings().key.cell != 0 || experiment.settings().key.replicate != 0)
    throw InputError(label + ": experiment", "cell and replicate are set by the sweep: expected 0");
  return parse_json(experiment.to_json(), label);
}

std::string title_over(const Json& experiment, const std::vector<ChangedSetting>& changes,
                       const std::vector<SweepAxis>& axes) {
  const std::string title = experiment.value("title", std::string());
  if (title.empty()) return title;
  std::vector<ChangedSetting> of_sweep;
  for (const ChangedSetting& change : changes)
    if (is_of_sweep(change.first)) of_sweep.push_back(change);
  std::string over;
  for (const SweepAxis& axis : axes) over += (over.empty() ? ", over " : " and ") + axis.subject();
  return changed_title(title, of_sweep) + over;
}

std::vector<SweepAxis> read_axes(const Json& json, const std::string& label, int levels) {
  const auto found = json.find("axes");
  if (found == json.end() || !found->is_array() || found->empty() || found->size() > 8)
    throw InputError(label + ": axes", "expected a list of 1 to 8 axes");
  std::vector<SweepAxis> axes;
  for (std::size_t i = 0; i < found->size(); ++i)
    axes.push_back(read_axis((*found)[i], label + ": axes." + std::to_string(i), levels));
  return axes;
}

std::vector<Measure> read_measures(const Json& json, const std::string& label) {
  const auto found = json.find("measures");
  if (found == json.end()) return {measures().begin(), measures().end()};
  std::vector<Measure> chosen;
  std::vector<std::string> names;
  for (const Measure& measure : measures()) names.push_back(measure.name);
  const auto refuse = [&](const std::string& what) {
    throw InputError(label + ": measures",
                     what + ": expected a list of different names of " + joined(names, ", "));
  };
  if (!found->is_array() || found->empty()) refuse("not a list");
  for (const Json& name : *found) {
    const auto is_it = [&](const Measure& measure) { return name == measure.name; };
    const auto measure = std::find_if(measures().begin(), measures().end(), is_it);
    if (measure == measures().end()) {
      const auto renamed = new_name(name.is_string() ? name.get<std::string>() : "", names);
      refuse(name.dump() + " is unknown" + (renamed ? "; it is now " + *renamed : ""));
    }
    if (std::any_of(chosen.begin(), chosen.end(), is_it)) refuse(name.dump() + " appears twice");
    chosen.push_back(*measure);
  }
  return chosen;
}

}  // namespace remote_touch
