// Makes a baseline's result again with the present program, and compares.
#pragma once

#include <optional>

#include "runners/evaluation/regression/manifest.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/stored_sweep.h"

namespace remote_touch {

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

}  // namespace remote_touch
