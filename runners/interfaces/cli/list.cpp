#include <cstdio>

#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/descriptions/descriptions.h"

namespace remote_touch {

int command_list(const CommandLine&, const ListRequest&) {
  for (const NamedKind& kind : named_kinds()) {
    std::puts(kind.kind.c_str());
    for (const NamedKind::Row& row : kind.rows)
      std::printf("  %-18s %s\n", row.name.c_str(), row.summary.c_str());
  }
  return kDone;
}

int command_describe(const CommandLine&, const DescribeRequest& request) {
  describe(request.name, stdout);
  return kDone;
}

}  // namespace remote_touch
