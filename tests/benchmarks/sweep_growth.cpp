// Measures how time, memory and files of sweeps grow with the number of runs: real runs as far as they take
// seconds, and beyond that runs that compute nothing, whose values are made up. Prints a line of JSON for
// each measurement:
// {"what": "tally", "runs": 1000, "processor_s": 0.01, "memory_MB": 12.3, "file_MB": 0.1}.
//
//     sweep_growth FOLDER [MOST_RUNS]     default of MOST_RUNS: 1e8. FOLDER: for the files, must be empty.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/tally/tally_file.h"
#include "core/kernels/isa.h"
#include "runners/sweep/shards/shard_merge.h"
#include "runners/sweep/sweep_session.h"

namespace remote_touch::benchmarks {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostReal = 100'000;     // number of real runs; one takes about 0.2 ms
constexpr std::uint64_t kMostKept = 10'000'000;  // number of runs of a file that keeps every run
constexpr int kShards = 100;

// A short press on a plane without noise, in ten cells for each thousand runs; at most 1000 cells.
Sweep sweep_of(std::uint64_t runs, const char* keep) {
  const std::uint64_t cells = std::min<std::uint64_t>(1000, runs / 10);
  return Sweep::from_json(R"({"title": "growth", "experiment": "fig4.12", "keep": ")" + std::string(keep) +
                              R"(",
    "set": {"duration_s": 0.02, "scenario.rise_s": 0.01, "trajectory.press_at_s": 0.01, "scenario.columns": 50,
            "scenario.rows": 50, "scenario.noise_sigma_m": 0},
    "axes": [{"parameter": "trajectory.depth_m", "from": 0.001, "to": 0.03, "count": )" +
                              std::to_string(cells) + R"(}],
    "replicates": )" + std::to_string(runs / cells) +
                              R"(, "measures": ["popped_through", "max_force"]})",
                          "growth");
}

TextAttributes attributes_of(const Sweep& sweep, const Shard& shard = {}) {
  TextAttributes attributes = {{"config", sweep.to_json()}, {"version", "0"}};
  if (shard.count > 1) attributes.emplace_back("shard", shard.text());
  return attributes;
}

// A number in [0, 1) that depends on the run only.
double made_up(std::uint64_t run) {
  std::uint64_t x = (run + 1) * 0x9E3779B97F4A7C15u;
  x ^= x >> 31, x *= 0xBF58476D1CE4E5B9u, x ^= x >> 29;
  return static_cast<double>(x >> 11) * 0x1p-53;
}

void fill(SweepResult& result) {
  for (std::size_t place = 0; place < result.held_count(); ++place) {
    const double value = made_up(result.run_at(place));
    std::get<std::vector<double>>(result.measures[0].values)[place] = value < 0.3;
    std::get<std::vector<double>>(result.measures[1].values)[place] = 10 * value;
    result.state[place] = RunState::done;
  }
}

struct Needed {
  double processor_s = 0, memory_MB = 0;
};
double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}
// Does the work in a child process. This process itself computes nothing: a child would lack the threads that
// OpenMP had made in it.
Needed in_child(const char* what, std::uint64_t runs, const std::function<void()>& work) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    work();
    std::_Exit(0);
  }
  int status = 1;
  rusage used{};
  wait4(child, &status, 0, &used);
  if (status != 0) {
    std::fprintf(stderr, "sweep_growth: %s of %llu runs failed\n", what,
                 static_cast<unsigned long long>(runs));
    std::exit(1);
  }
  return {seconds_of(used.ru_utime) + seconds_of(used.ru_stime), static_cast<double>(used.ru_maxrss) / 1024};
}

void measure(const char* what, std::uint64_t runs, const fs::path& file, const std::function<void()>& work) {
  const Needed needed = in_child(what, runs, work);
  std::printf(R"({"what": "%s", "runs": %llu, "processor_s": %.4g, "memory_MB": %.4g, "file_MB": %.4g})"
              "\n",
              what, static_cast<unsigned long long>(runs), needed.processor_s, needed.memory_MB,
              1e-6 * static_cast<double>(fs::file_size(file)));
}

void real_runs(const fs::path& folder, std::uint64_t runs) {
  const Kernels& kernels = kernels_for(best_isa());
  measure("runs, computed", runs, folder / "real.h5", [&] {
    const Sweep sweep = sweep_of(runs, "runs");
    SweepSession(sweep, {}, attributes_of(sweep), folder / "real.h5").run(kernels, nullptr, [](auto...) {});
  });
  measure("tally, computed", runs, folder / "real-tally.h5", [&] {
    const Sweep sweep = sweep_of(runs, "tally");
    TallySession(sweep, {}, attributes_of(sweep), folder / "real-tally.h5")
        .run(kernels, nullptr, [](auto...) {});
  });
  fs::remove(folder / "real.h5"), fs::remove(folder / "real-tally.h5");
}

void made_up_runs(const fs::path& folder, std::uint64_t runs) {
  std::vector<std::string> shards;
  for (int i = 1; i <= kShards; ++i) shards.push_back((folder / (std::to_string(i) + ".h5")).string());
  const auto make_shards = [&](int first, int last) {
    const Sweep sweep = sweep_of(runs, "runs");
    for (int i = first; i <= last; ++i) {
      const Shard shard{i, kShards};
      SweepResult part = sweep.plan(shard);
      fill(part);
      write_sweep(shards[static_cast<std::size_t>(i - 1)], part, attributes_of(sweep, shard));
    }
  };
  measure("a shard of 100", runs, folder / "1.h5", [&] { make_shards(1, 1); });
  in_child("the other shards", runs, [&] { make_shards(2, kShards); });
  measure("merge of 100 shards", runs, folder / "merged.h5", [&] {
    merge_shards({shards, (folder / "merged.h5").string()}, [](const SweepResult&) {});
  });
  fs::remove(folder / "merged.h5");
  for (const std::string& shard : shards) fs::remove(shard);
}

void made_up_tally(const fs::path& folder, std::uint64_t runs) {
  measure("tally", runs, folder / "tally.h5", [&] {
    const Sweep sweep = sweep_of(runs, "tally");
    TallySession session(sweep, {}, attributes_of(sweep), folder / "tally.h5");
    session.run([](SweepResult& part) { fill(part); }, 2, [](auto...) {});
  });
  fs::remove(folder / "tally.h5");
}

}  // namespace

void print_growth(const fs::path& folder, std::uint64_t most) {
  for (std::uint64_t runs = 1000; runs <= most; runs *= 10) {
    if (runs <= kMostReal) real_runs(folder, runs);
    if (runs <= kMostKept) made_up_runs(folder, runs);
    made_up_tally(folder, runs);
  }
}

}  // namespace remote_touch::benchmarks

int main(int count, char** words) {
  if (count < 2 || count > 3 || !std::filesystem::is_empty(words[1])) {
    std::fprintf(stderr, "usage: sweep_growth FOLDER [MOST_RUNS]: the folder is there, and empty\n");
    return 2;
  }
  remote_touch::benchmarks::print_growth(words[1],
                                         count > 2 ? std::strtoull(words[2], nullptr, 10) : 100'000'000);
}
