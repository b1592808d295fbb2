// Everything that has a name, as text: for people at the command line and in Python.
#pragma once

#include <string>
#include <vector>

#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

// Returns the meaning of a column in a run without a tool, with the names of its values.
std::string meaning_of(const TraceColumn& column);
const char* runs_with(TracePart part);  // "every run", "a run with a tool", ...

// Returns all parameters of an entry of a catalog, the configuration of an experiment, and so on, for every
// kind that has the name. NAME.PARAMETER is one parameter: proxy.r1_m; renderer.r1_m of every renderer that
// has it; trace.force, a column of a trace. Throws InputError if no kind has the name.
std::string described(const std::string& name);

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
