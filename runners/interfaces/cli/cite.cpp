#include <cstdio>
#include <nlohmann/json.hpp>

#include "analysis/scorecard/scorecard.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_file.h"
#include "core/parameters/input_error.h"
#include "runners/evaluation/regression/stored_result.h"
#include "runners/experiment/provenance/citation.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/interfaces/cli/commands.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

namespace {

// Figures have a title of their own. Other results have the title of their configuration; empty if there is
// none.
std::string title_of(const std::string& file, const TextAttributes& attributes) {
  if (const std::string title = attribute(attributes, "title"); !title.empty()) return title;
  const Json config = parse_json(stored_configuration(attribute(attributes, "config")), file + " config");
  const auto title = config.is_object() ? config.find("title") : config.end();
  return title != config.end() && title->is_string() ? title->get<std::string>() : std::string();
}

// Hashes and sessions store no digest.
std::string digest_text(const std::string& file, const TextAttributes& attributes) {
  const std::string digest = attribute(attributes, "digest");
  return digest.empty() ? "file with SHA-256 " + sha256_of_file(file) : "digest " + digest;
}

void print_entries(CitedResult cited, const TextAttributes& attributes) {
  cited.title = title_of(cited.file, attributes);
  cited.digest = digest_text(cited.file, attributes);
  std::printf("%s\n%s\n%s", dissertation_entry().c_str(), program_entry(attributes).c_str(),
              result_entry(cited, attributes).c_str());
}

void print_session_entries(const std::string& file, const TextAttributes& attributes) {
  CitedResult cited{file, "recording of a live session"};
  cited.remark = "what happened live cannot be repeated, but " +
                 shell_command({"remote-touch", "run", file, "-o", "again.h5"}) + " computes its trace again";
  print_entries(cited, attributes);
}

void print_result_entries(const StoredResult& result) {
  if (!result.of("plan_digest").empty())
    throw InputError(result.file(), "is a sweep in progress: expected a finished one");
  const bool is_figure = result.kind() == "figure";
  CitedResult cited{result.file(), result.kind()};
  if (is_figure) cited.kind += " " + result.of("figure");
  if (is_figure && result.of("figure") == kScorecardFigure) cited.kind = "scorecard";
  Remaking again = result.remaking();
  cited.commands = std::move(again.commands), cited.remark = std::move(again.reason);
  print_entries(cited, result.attributes());
}

}  // namespace

int command_cite(const CommandLine&, const CiteRequest& request) {
  if (request.file.empty()) {
    std::printf("%s\n%s", dissertation_entry().c_str(),
                program_entry(provenance({}, std::string(), {})).c_str());
    return kDone;
  }
  const Hdf5Reader file(request.file);
  if (is_schema_of(attribute(file.attributes(), "schema"), "session"))
    print_session_entries(request.file, file.attributes());
  else
    print_result_entries(StoredResult(file));
  return kDone;
}

}  // namespace remote_touch
