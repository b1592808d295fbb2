// A small sweep, made into files. It keeps a tally, or with the override keep=runs its runs.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_reader.h"
#include "core/kernels/kernels.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep_session.h"
#include "tests/support/test_files.h"

namespace remote_touch {

// A run takes a millisecond.
inline Sweep quick_sweep(const std::vector<std::string>& overrides = {}) {
  constexpr const char* kQuick = R"({"title": "quick", "experiment": "fig4.12", "keep": "events",
    "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
    "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 3},
             {"parameter": "scenario.acceleration_m_per_s2", "from": 0, "to": 7, "count": 4}],
    "replicates": 5, "measures": ["max_penetration", "popped_through", "first_pop_through_time"]})";
  return Sweep::from_json(kQuick, "quick.json", overrides);
}

class QuickSweeps : public testing::Test {
 protected:
  explicit QuickSweeps(const std::string& folder) : folder_(folder) {}

  static Sweep quick(const std::vector<std::string>& overrides = {}) { return quick_sweep(overrides); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  static TextAttributes attributes_of(const Sweep& sweep, const Shard& shard) {
    TextAttributes attributes = {{"config", sweep.to_json()}, {"version", "1"}};
    if (shard.count > 1) attributes.emplace_back("shard", shard.text());
    return attributes;
  }
  // Makes the file and returns it. after: the number of finished runs at which it is interrupted.
  std::string made(const std::string& name, const Sweep& sweep, const Shard& shard = {},
                   std::size_t after = ~std::size_t{0}) const {
    SweepSession session(sweep, shard, attributes_of(sweep, shard), file(name));
    std::atomic<bool> stop{after == 0};
    try {
      session.run(kernels_for(best_isa()), &stop, [&](std::size_t done, std::size_t, std::size_t) {
        if (done >= after) stop = true;
      });
    } catch (const Interrupted&) {
    }
    return file(name);
  }
  static SweepTally tally_in(const std::string& name) { return read_tally(Hdf5Reader(name)).tally; }
  const TestFolder folder_;
};

}  // namespace remote_touch
