// One parameter, or one column of a trace, as text.
#pragma once

#include <cstdio>
#include <string>

#include "analysis/trace/trace.h"

namespace remote_touch {

// Prints the parameter of a path, once for every entry that has it:
//   proxy.r1_m, run.seed    of an entry of a catalog, or of a section
//   renderer.r1_m           of every renderer that has it, as in --set
//   fixtures.0.radius_m     the same for a list
//   trace.force             a column of a trace
// Returns false, and prints nothing, if no section and no entry has the first name. Throws InputError, with
// the most similar name, if it has no such parameter.
bool describe_parameter(const std::string& path, std::FILE* out);

// Returns the meaning of a column in a run without a tool, with the names of its values.
std::string meaning_of(const TraceColumn& column);
const char* runs_with(TracePart part);  // "every run", "a run with a tool", ...

}  // namespace remote_touch
