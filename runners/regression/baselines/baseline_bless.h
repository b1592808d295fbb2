// Storing a baseline: measured over builds, with a reason.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "runners/regression/baselines/manifest.h"

namespace remote_touch {

struct Blessing {
  std::filesystem::path folder;
  std::string name;
  std::string reason;
  std::string run, sweep;              // what a new baseline runs; empty: as the manifest says
  std::vector<std::string> overrides;  // with run or sweep
  std::vector<std::string> also;       // builds of the same source by other compilers
  bool one_compiler = false;           // without one: the spread is then of this compiler alone
  const std::atomic<bool>* stop = nullptr;
};

// Stores NAME.h5 and its entry in the manifest, which is begun where there is none. Numbers that are within
// the old spread of the old ones keep their old bits, and nothing is written when all do. Returns what was
// done, for people. Throws InputError without a reason, without a build of another compiler, and as
// measure_spread does, Interrupted when stop is set; what is stored is then untouched.
std::string bless(const Blessing& blessing);

}  // namespace remote_touch
