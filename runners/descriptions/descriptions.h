// Everything that has a name, as text: for people at the command line and in Python.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "analysis/measures/measures.h"

namespace remote_touch {

// All parameters of an entry of a catalog, the configuration of an experiment, and so on, for every kind that
// has the name. Throws InputError if none has; nothing is written then.
void describe(const std::string& name, std::FILE* out);

// Meaning, unit, which way it gets better, and the runs that have it.
std::string summary_of(const Measure& measure);

// The names of one kind.
struct NamedKind {
  struct Row {
    std::string name, summary;
  };
  std::string kind;  // "renderers"
  std::vector<Row> rows;
};
// Of every kind, in the order in which `list` prints them.
std::vector<NamedKind> named_kinds();

}  // namespace remote_touch
