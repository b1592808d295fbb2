#include <cstdio>

#include "analysis/trace/column.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/descriptions/descriptions.h"

namespace remote_touch {

namespace {

void print(const NamedKind& kind) {
  std::puts(kind.kind.c_str());
  for (const NamedKind::Row& row : kind.rows)
    std::printf("  %-18s %s\n", row.name.c_str(), row.summary.c_str());
}

}  // namespace

int command_list(const CommandLine&, const ListRequest& request) {
  if (!request.kind.empty())
    print(named_kind(joined(request.kind, " ")));
  else
    for (const NamedKind& kind : named_kinds()) print(kind);
  return kDone;
}

int command_describe(const CommandLine&, const DescribeRequest& request) {
  describe(request.name, stdout);
  return kDone;
}

}  // namespace remote_touch
