// Everything that has a name, as text: for people at the command line and in Python.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "analysis/measures/measures.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

// One parameter, or one column of a trace, as text.

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

// Prints all parameters of an entry of a catalog, the configuration of an experiment, and so on, for every
// kind that has the name. NAME.PARAMETER prints one parameter, see describe_parameter(). Throws
// InputError if no kind has the name, and then writes nothing.
void describe(const std::string& name, std::FILE* out);

// Returns the meaning, the unit, the better direction, and the runs that have the measure.
std::string summary_of(const Measure& measure);

// The names of one kind.
struct NamedKind {
  struct Row {
    std::string name, summary;
  };
  std::string kind;  // "renderers"
  std::vector<Row> rows;
};
// Returns the names of every kind, in the order in which `list` prints the kinds.
std::vector<NamedKind> named_kinds();
// Returns the kind of this name: "renderers". Throws InputError, which names all kinds, if there is none.
NamedKind named_kind(const std::string& name);

}  // namespace remote_touch
