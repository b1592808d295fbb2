#include "runners/evaluation/scorecard/card_folder.h"

#include <nlohmann/json.hpp>

#include "analysis/figures/result_file.h"
#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "core/parameters/input_error.h"
#include "runners/evaluation/scorecard/report_json.h"
#include "runners/evaluation/scorecard/stored_card.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

void make_scorecard_folder(const std::string& folder) {
  for (const char* part : {"runs", "traces"}) make_folder(std::filesystem::path(folder) / part);
  for (const char* file : {kScorecardFile, "scorecard.json", "costs.json"})
    require_writable(std::filesystem::path(folder) / file);
}

void require_all_of(const std::filesystem::path& file, const BenchmarkPlan& plan) {
  std::error_code unreachable;
  if (!std::filesystem::exists(file, unreachable)) return;
  const TextAttributes attributes = Hdf5Reader(file).attributes();
  if (const std::string schema = attribute(attributes, "schema"); is_earlier_schema(schema))
    throw InputError(file.string(), "was written with the earlier schema " + schema +
                                        ": expected another folder, in which the scorecard starts again");
  const Json stored = Json::parse(attribute(attributes, "config"), nullptr,
                                  false);  // a broken text gives no object
  const Json wanted = Json::parse(configuration_of(plan));
  for (const char* kind : {"methods", "scenes"}) {
    if (!stored.is_object() || !stored.contains(kind) || !stored[kind].is_object())
      throw InputError(file.string(), "is not a scorecard and would be overwritten: expected another folder");
    for (const auto& item : stored[kind].items())
      if (!wanted.contains(kind) || !wanted[kind].contains(item.key()))
        throw InputError(file.string(), std::string("has more ") + kind + ", first " + item.key() +
                                            ", and would be replaced: expected those and others too, or "
                                            "another folder");
  }
}

std::string scorecard_command(const std::vector<std::string>& methods, const std::vector<std::string>& scenes,
                              int seeds) {
  std::string command = program_text() + " scorecard";
  for (const std::string& name : methods) command += " " + name;
  if (!scenes.empty()) command += " --scene";
  for (const std::string& name : scenes) command += " " + name;
  return command + " --seeds " + std::to_string(seeds);
}

std::string write_scorecard(const std::filesystem::path& folder, const BenchmarkPlan& plan,
                            const ScorecardReport& report, const std::string& command) {
  std::string digest = write_figure(folder / kScorecardFile, scorecard_figure(report.card),
                                    provenance(configuration_of(plan), command, ""));
  const std::string text = to_json(report);
  write_file_atomically(folder / "scorecard.json", text.data(), text.size());
  return digest;
}

}  // namespace remote_touch
