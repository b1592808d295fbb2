// Running what made a baseline again, with the present program, and comparing.
#pragma once

#include <optional>

#include "runners/regression/baselines/manifest.h"
#include "runners/regression/comparison/result_comparison.h"
#include "runners/simulation/simulation.h"

namespace remote_touch {

struct BaselineCheck {
  enum class State {
    same,
    changed,         // numbers outside the spread, another experiment, or no baseline where one has to be
    not_comparable,  // the stored file is damaged, or what it runs cannot be run any more
    not_run          // what it needs is not on this machine: a recording
  };
  std::string name;
  State state = State::same;
  std::string text = {};                            // one line
  std::optional<ResultComparison> comparison = {};  // where it came to one
};

// Never throws InputError: what is wrong with one baseline must not hide the others. Throws Interrupted.
BaselineCheck check_baseline(const std::filesystem::path& folder, const Baseline& baseline,
                             const Kernels& kernels, const std::atomic<bool>* stop);

// One changed entry for each experiment, scenario, fixture rule, trajectory and renderer that no baseline
// runs, but for rules that read a file of the user's; none where the manifest need not be complete.
std::vector<BaselineCheck> missing_baselines(const std::filesystem::path& folder, const Manifest& manifest);

}  // namespace remote_touch
