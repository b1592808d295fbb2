#include "runners/sweep/keep.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/sweeps/sweep_result.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

const char* name_of(Keep keep) {
  return keep == Keep::runs ? "runs" : keep == Keep::tally ? "tally" : "events";
}

Keep read_keep(const Json& sweep, const std::vector<Measure>& measures, const std::string& label) {
  const auto found = sweep.find("keep");
  if (found == sweep.end()) return Keep::runs;
  for (const Keep keep : {Keep::runs, Keep::tally, Keep::events}) {
    if (*found != name_of(keep)) continue;
    if (keep != Keep::runs && sweep.contains("refine"))
      throw InputError(label + ": keep = " + name_of(keep),
                       "refinement needs the values of all runs: expected runs, or a sweep without refine");
    const auto is_of_event = [](const Measure& each) {
      return is_event({each.name, each.unit, each.meaning, {}});
    };
    if (keep == Keep::events && std::none_of(measures.begin(), measures.end(), is_of_event))
      throw InputError(label + ": keep = events",
                       "none of the measures is an event: expected one such as popped_through, or tally");
    return keep;
  }
  throw InputError(label + ": keep = " + found->dump(), "expected runs, tally or events");
}

}  // namespace remote_touch
