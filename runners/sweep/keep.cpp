#include "runners/sweep/keep.h"

#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"

namespace remote_touch {

const char* name_of(Keep keep) {
  return keep == Keep::runs ? "runs" : keep == Keep::tally ? "tally" : "events";
}

Keep read_keep(const Json& sweep, const std::string& label) {
  const auto found = sweep.find("keep");
  if (found == sweep.end()) return Keep::runs;
  for (const Keep keep : {Keep::runs, Keep::tally, Keep::events}) {
    if (*found != name_of(keep)) continue;
    if (keep != Keep::runs && sweep.contains("refine"))
      throw InputError(label + ": keep = " + name_of(keep),
                       "refinement needs the values of all runs: expected runs, or a sweep without refine");
    return keep;
  }
  throw InputError(label + ": keep = " + found->dump(), "expected runs, tally or events");
}

}  // namespace remote_touch
