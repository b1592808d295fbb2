// Sweeps, and methods and scenes of the scorecard, as JSON.
#include <omp.h>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runners/evaluation/scorecard/benchmark.h"
#include "runners/sweep/sweep.h"
#include "scenarios/files/input_files.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::plans {
namespace {

// Sweeps as JSON. Every cell is checked, which takes minutes for millions of cells, so only small sweeps are
// read.

constexpr double kMaxCells = 16, kMaxReplicates = 1000;

double number_in(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : 0;
}

// The result is NaN if the number cannot be a count of cells.
double cells_of(const Json& json, double halved) {
  double cells = 1;
  for (const Json& axis : json["axes"]) {
    if (!axis.is_object()) continue;
    const auto values = axis.find("values");
    const double count =
        values != axis.end() ? static_cast<double>(values->size()) : number_in(axis, "count");
    cells *= std::max(1.0, (count - 1) * std::exp2(halved) + 1);
  }
  return cells;
}

bool is_small(const Json& json) {
  if (!json.is_object() || !json.contains("axes") || !json["axes"].is_array()) return true;
  double halved = 0, replicates = number_in(json, "replicates");
  if (const auto refine = json.find("refine"); refine != json.end() && refine->is_object()) {
    halved = number_in(*refine, "levels");
    replicates = std::max(replicates, number_in(*refine, "max_replicates"));
  }
  return cells_of(json, halved) <= kMaxCells && replicates <= kMaxReplicates;
}

// An experiment by name is one that is compiled in, not a file.
bool reads_no_file(const Json& json) {
  if (!json.is_object() || !json.contains("experiment") || !json["experiment"].is_string()) return true;
  for (const EmbeddedText& known : embedded_experiments())
    if (json["experiment"] == known.name) return true;
  return false;
}

void read_sweep(std::string_view bytes) {
  const std::string text(bytes);
  omp_set_num_threads(1);
  accepts(bytes, [&] {
    const Json json = parse_json(text, "sweep");
    if (!is_small(json) || !reads_no_file(json)) return;
    const Sweep sweep = Sweep::from_json(text, "sweep");
    const std::string complete = sweep.to_json();
    require(Sweep::from_json(complete, "complete sweep").to_json() == complete,
            "a sweep survives writing and reading");
    require(sweep.plan({2, 3}).run_count() == sweep.plan().run_count(), "a shard has the shape of the whole");
    sweep.thinned(2);
  });
}

const Registered of_sweep("sweep", read_sweep);

// Methods and scenes of the scorecard as JSON. The first byte selects one of them.

void read_part(std::string_view bytes) {
  if (bytes.empty()) return;
  const std::string text(bytes.substr(1));
  accepts(bytes, [&] {
    if (bytes.front() == 'm') {
      const Method method = read_method("fuzz", text);
      configuration({method}, {}, 2);
    } else {
      const BenchmarkScene scene = read_benchmark_scene("fuzz", text);
      configuration({}, {scene}, 2);
      scene.sweep({"proxy", "proxy", R"({"name": "proxy"})"}, 2);
    }
  });
}

const Registered of_part("scorecard_part", read_part);

}  // namespace
}  // namespace remote_touch::fuzz::plans
