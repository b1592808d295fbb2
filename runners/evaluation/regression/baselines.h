// Baselines: stores one with a reason, and makes its result again and compares.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "runners/evaluation/regression/result_comparison.h"
#include "runners/evaluation/regression/stored_result.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/stored_sweep.h"

namespace remote_touch {

// Makes a baseline's result again with the present program, and compares.

struct BaselineCheck {
  enum class State {
    same,
    changed,         // numbers outside the spread, or another experiment
    missing,         // a required baseline; fails a check as a change does
    not_comparable,  // the stored file is damaged, or what it runs cannot be run any more
    not_run          // a recording that it needs is not on this machine
  };
  std::string name;
  State state = State::same;
  std::string text = {};                            // one line
  std::optional<ResultComparison> comparison = {};  // if one was made
};

// Adds the notes on the runs to `notes`, unless it is null. Never throws InputError: a problem of one
// baseline must not hide the others. Throws Interrupted.
BaselineCheck check_baseline(const std::filesystem::path& folder, const Baseline& baseline,
                             const Kernels& kernels, const std::atomic<bool>* stop,
                             NoteCounts* notes = nullptr);

// Returns an entry `missing` for each experiment, scenario, fixture rule, trajectory and renderer that no
// baseline runs, except rules that read a file of the user, and parts named live-session. Returns none if the
// manifest need not be complete.
std::vector<BaselineCheck> missing_baselines(const std::filesystem::path& folder, const Manifest& manifest);

// Stores a baseline: its spread measured over builds, with a reason.

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
