#include "runners/presentation/pages/trace_page.h"

#include <nlohmann/json.hpp>

#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"
#include "scenarios/files/text_file.h"

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

ViewPage trace_page(const std::vector<std::filesystem::path>& traces, const ViewOptions& options) {
  std::vector<std::unique_ptr<ShownRun>> runs;
  BoundingBox box_W;
  bool has_claims = false;
  for (const auto& file : traces) {
    const auto trace = std::make_shared<StoredTrace>(file);
    RunSource source{file.string(), trace, trace->attributes()};
    const Json claims = shown_claims(options.claims, source.attributes);
    has_claims |= !claims.empty();
    source.claims = claims.dump();
    runs.push_back(std::make_unique<ShownRun>(std::move(source), *options.kernels, options.stop));
    box_W.extend(runs.back()->box_W());
  }
  for (const auto& run : runs) run->set_box(box_W);
  if (runs.size() == 2) runs.front()->mark_divergence_from(*runs.back());
  ViewPage page = view_page(runs.front()->title(), runs, Json::object(), {}, options);
  if (!options.claims.empty() && !has_claims)
    page.shown += options.claims.string() + " has no claim of a figure that runs this experiment\n";
  return page;
}

}  // namespace remote_touch
