// Radius queries with each of the searches.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/kernels/isa.h"
#include "core/search/neighbour_search.h"
#include "scenarios/recordings/recording.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/benchmarks/proxy_benchmark.h"

namespace remote_touch::benchmarks {
namespace {

GatheredPoints list_for(const NeighbourSearch& search) {
  GatheredPoints list;
  list.reserve(search.size(), search.has_fixture_radius(), search.has_stiffness());
  return list;
}

bool finds_expected(const NeighbourSearch& search, const naive::Queries& queries, const Kernels& kernels) {
  GatheredPoints list = list_for(search);
  const std::size_t every = queries.balls.size() / queries.expected.size();
  for (std::size_t i = 0; i < queries.expected.size(); ++i) {
    list.clear();
    search.gather(queries.balls[i * every], kernels, list);
    std::vector<std::uint32_t> found(list.index(), list.index() + list.size());
    std::sort(found.begin(), found.end());
    if (found != queries.expected[i]) return false;
  }
  return true;
}

void time_queries(benchmark::State& state, const NeighbourSearch& search, const naive::Queries& queries,
                  const Kernels& kernels) {
  GatheredPoints list = list_for(search);
  std::size_t i = 0;
  double found = 0;
  for (auto _ : state) {
    list.clear();
    search.gather(queries.balls[i], kernels, list);
    list.finish();
    benchmark::ClobberMemory();
    found += static_cast<double>(list.size());
    if (++i == queries.balls.size()) i = 0;
  }
  state.counters["found"] = benchmark::Counter(found, benchmark::Counter::kAvgIterations);
}

// Returns the first frame of a recording, if there is one: a real surface, with holes.
std::optional<PointCloud> recorded_cloud() {
  const char* named = std::getenv("REMOTE_TOUCH_DATA");
  const auto folder =
      std::filesystem::path(named != nullptr ? named : "../shared/data") / "rgbd/visp_organ_table";
  if (!std::filesystem::exists(folder)) return std::nullopt;
  return read_frame(index_recording(folder), 0, 3.0);
}

}  // namespace

void add_query(const std::string& name, const std::shared_ptr<const NeighbourSearch>& search,
               const naive::Queries& queries) {
  for (const Kernels* kernels : supported_kernels())
    add(
        name + "/" + queries.name + "/" + kernels->isa,
        [=, &queries] { return finds_expected(*search, queries, *kernels); },
        [=, &queries](benchmark::State& state) { time_queries(state, *search, queries, *kernels); });
}

std::vector<naive::Queries> query_sets() {
  std::vector<naive::Queries> queries;
  const std::optional<PointCloud> recorded = recorded_cloud();
  for (const naive::Centres centres : {naive::Centres::slide, naive::Centres::jump}) {
    queries.push_back(naive::on_grid(centres));
    queries.push_back(naive::on_image("image_0.75m", naive::wave_image(0.75), centres));
    // A 1 cm ball holds 81 pixels at 1.03 m, as in the published comparison.
    queries.push_back(naive::on_image("image_1.03m", naive::wave_image(1.03), centres));
    if (recorded) queries.push_back(naive::on_image("image_recorded", *recorded, centres));
  }
  return queries;
}

void add_queries(const naive::Queries& queries) {
  add_query("query_brute_force", std::make_shared<BruteForceSearch>(queries.cloud), queries);
  add_query("query_cells", std::make_shared<UniformGridSearch>(queries.cloud, 0.004), queries);
  if (queries.cloud.image)
    add_query("query_window", std::make_shared<ImageWindowSearch>(queries.cloud), queries);
}

}  // namespace remote_touch::benchmarks
