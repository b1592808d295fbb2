#include "runners/presentation/view/shown_claims.h"

#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

namespace {

constexpr const char* kColumns[] = {"claim", "paper", "measured", "unit", "criterion", "verdict"};

std::string figure_of(const TextAttributes& run) {
  const auto recipe = recipe_of(run);
  constexpr std::string_view kPrefix = "fig";
  if (!recipe || recipe->action != "run" || !recipe->overrides.empty() ||
      !recipe->subject.starts_with(kPrefix))
    return {};
  return recipe->subject.substr(kPrefix.size());
}

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw InputError(file.string(), "is not a list of claims: expected the claims.json of remote-touch figure");
}

Json shown(const Json& claim, const std::filesystem::path& file) {
  Json row = Json::object();
  for (const char* column : kColumns) {
    if (!claim.contains(column)) refuse(file);
    row[column] = claim[column];
  }
  return row;
}

}  // namespace

Json shown_claims(const std::filesystem::path& claims, const TextAttributes& run) {
  Json list = Json::array();
  if (claims.empty()) return list;
  const Json all =
      parse_json(read_text_file(claims, "expected the claims.json of remote-touch figure"), claims.string());
  if (!all.is_array()) refuse(claims);
  const std::string figure = figure_of(run);
  for (const Json& claim : all) {
    if (!claim.is_object() || !claim.contains("figure")) refuse(claims);
    if (claim["figure"] == figure) list.push_back(shown(claim, claims));
  }
  return list;
}

}  // namespace remote_touch
