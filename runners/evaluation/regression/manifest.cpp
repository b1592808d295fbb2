#include "runners/evaluation/regression/manifest.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"
#include "runners/experiment/settings/json_parameters.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

namespace {

Revision revision_of(const Json& json) {
  return {json.at("reason"), json.value("moved", "")};
}

Json json_of(const Revision& revision) {
  return {{"reason", revision.reason}, {"moved", revision.moved}};
}

Baseline baseline_of(const Json& json, const std::filesystem::path& file) {
  Baseline baseline{json.at("name"), json.at("command"), json.at("subject")};
  if (baseline.command != "run" && baseline.command != "sweep")
    throw InputError(file.string(), "baseline " + baseline.name + ": command: expected run, sweep");
  baseline.overrides = json.at("set").get<std::vector<std::string>>();
  baseline.sha256 = json.at("sha256"), baseline.revision = revision_of(json);
  if (const auto found = json.find("history"); found != json.end())
    for (const Json& one : found->get_ref<const Json::array_t&>())
      baseline.history.push_back(revision_of(one));
  baseline.builds = json.at("measured_over").get<std::vector<std::string>>();
  for (const auto& [name, spread] : json.at("spread").get_ref<const Json::object_t&>()) {
    if (!(spread.get<double>() >= 0))
      throw InputError(file.string(),
                       "baseline " + baseline.name + ": spread of " + name + ": expected 0 or more");
    baseline.tolerances[name].absolute = spread;
  }
  return baseline;
}

Json json_of(const Baseline& baseline) {
  Json spread = Json::object();
  for (const auto& [name, tolerance] : baseline.tolerances) spread[name] = tolerance.absolute;
  Json history = Json::array();
  for (const Revision& revision : baseline.history) history.push_back(json_of(revision));
  return {{"name", baseline.name},
          {"command", baseline.command},
          {"subject", baseline.subject},
          {"set", baseline.overrides},
          {"sha256", baseline.sha256},
          {"reason", baseline.revision.reason},
          {"moved", baseline.revision.moved},
          {"history", history},
          {"spread", spread},
          {"measured_over", baseline.builds}};
}

}  // namespace

const Baseline* Manifest::find(const std::string& name) const {
  const auto found = std::find_if(baselines.begin(), baselines.end(),
                                  [&](const Baseline& baseline) { return baseline.name == name; });
  return found == baselines.end() ? nullptr : &*found;
}

std::filesystem::path manifest_file(const std::filesystem::path& folder) {
  return folder / "manifest.json";
}

Manifest read_manifest(const std::filesystem::path& folder) {
  const std::filesystem::path file = manifest_file(folder);
  const Json json = parse_json(
      read_text_file(file,
                     "expected a folder of baselines (--folder), or the project's root as working folder"),
      file.string());
  try {
    Manifest manifest{json.at("complete")};
    for (const Json& one : json.at("baselines")) manifest.baselines.push_back(baseline_of(one, file));
    return manifest;
  } catch (const Json::exception& error) {
    std::string what = error.what();  // "[json.exception...] key 'spread' not found"
    if (const auto end = what.find("] "); end != std::string::npos) what.erase(0, end + 2);
    throw InputError(file.string(), what + ": expected what remote-touch baseline bless writes");
  }
}

std::string text_of(const Manifest& manifest) {
  Json list = Json::array();
  for (const Baseline& baseline : manifest.baselines) list.push_back(json_of(baseline));
  return Json({{"complete", manifest.complete}, {"baselines", list}}).dump(2) + "\n";
}

std::filesystem::path file_of(const std::filesystem::path& folder, const Baseline& baseline) {
  return folder / (baseline.name + ".h5");
}

std::string subject_of(const std::filesystem::path& folder, const Baseline& baseline) {
  return baseline.subject.ends_with(".json") ? (folder / baseline.subject).string() : baseline.subject;
}

}  // namespace remote_touch
