// Stores a baseline: its spread measured over builds, with a reason.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "runners/evaluation/regression/manifest.h"

namespace remote_touch {

struct Blessing {
  std::filesystem::path folder;
  std::string name;
  std::string reason;
  std::string run, sweep;              // experiment or sweep of a new baseline; empty: as in the manifest
  std::vector<std::string> overrides;  // --set, only with run or sweep
  std::vector<std::string> also;       // builds of the same source by other compilers
  bool one_compiler = false;           // allows `also` to be empty: the spread is then of this compiler alone
  const std::atomic<bool>* stop = nullptr;
};

// Stores NAME.h5 and its entry in the manifest, which is created if missing. Numbers within the old spread of
// the old ones keep their old bits, and nothing is written if all do. Returns what was done, as text. Throws
// InputError without a reason, without a build of another compiler unless one_compiler is set, and as
// measure_spread() does. Throws Interrupted when stop is set. The stored files are unchanged in all these
// cases.
std::string bless(const Blessing& blessing);

}  // namespace remote_touch
