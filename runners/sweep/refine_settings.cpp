#include "runners/sweep/refine_settings.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"

namespace remote_touch {

Parameters parameters(RefineSettings& r) {
  return {
      {"measure", &r.measure, 0, 0, "measure that defines the event"},
      {"threshold", &r.threshold, -1e12, 1e12, "the event happens when the measure is above this"},
      {"budget", &r.budget, 1, 1e7, "maximum number of runs, including the first round"},
      {"max_replicates", &r.max_replicates, 1, 100000, "maximum number of replicates of a cell"},
      {"levels", &r.levels, 0, 10, "how many times the spacing of the axes may be halved"},
  };
}

std::optional<RefineSettings> read_refine(const Json& json, const std::vector<Measure>& chosen,
                                          int replicates, const std::string& label) {
  const auto found = json.find("refine");
  if (found == json.end() || found->is_null()) return std::nullopt;
  RefineSettings refine;
  read_parameters(*found, parameters(refine), "refine");
  const auto is_it = [&](const Measure& measure) { return refine.measure == measure.name; };
  if (std::none_of(chosen.begin(), chosen.end(), is_it))
    throw InputError(label + ": refine.measure = \"" + refine.measure + "\"",
                     "expected one of the sweep's measures");
  if (refine.max_replicates < replicates)
    throw InputError(label + ": refine.max_replicates", "expected at least replicates");
  return refine;
}

}  // namespace remote_touch
