#include "runners/presentation/view/trace_page.h"

#include <nlohmann/json.hpp>

#include "runners/presentation/view/shown_claims.h"

namespace remote_touch {

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
