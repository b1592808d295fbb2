#include "analysis/sweeps/cell_streams.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace remote_touch {

bool CellStreams::share_replicates(const std::vector<std::size_t>& cells) const {
  return std::any_of(cells.begin(), cells.end(), [&](std::size_t cell) { return draws[cell].of_replicate; });
}

bool CellStreams::are_independent(const std::vector<std::size_t>& cells) const {
  std::set<std::size_t> seen, seeds;
  for (const std::size_t cell : cells) {
    if (draws[cell].of_cell && !seen.insert(noise_cell[cell]).second) return false;
    if (draws[cell].of_replicate && !seeds.insert(seed[cell]).second) return false;
  }
  return true;
}

CellStreams independent_streams(std::size_t cells) {
  CellStreams streams;
  streams.draws.assign(cells, {true, false});
  streams.noise_cell.resize(cells), streams.seed.assign(cells, 0);
  std::iota(streams.noise_cell.begin(), streams.noise_cell.end(), std::size_t{0});
  return streams;
}

std::vector<RunCluster> clusters_of(const SweepResult& result, const CellStreams& streams,
                                    const std::vector<std::size_t>& cells, bool by_replicate) {
  std::vector<RunCluster> clusters;
  std::map<std::pair<std::size_t, int>, std::size_t> of_key;
  for (const std::size_t cell : cells)
    for (int replicate = 0; replicate < result.replicates; ++replicate) {
      const std::size_t run = result.run(cell, replicate);
      if (result.state[run] != RunState::done) continue;
      if (streams.is_fixed(cell)) {
        clusters.push_back({{run}, streams.noise_cell[cell], true});
        break;
      }
      const std::size_t key = by_replicate ? streams.seed[cell] : streams.noise_cell[cell];
      const auto [at, is_new] = of_key.try_emplace({key, replicate}, clusters.size());
      if (is_new) clusters.push_back({{}, streams.noise_cell[cell], false});
      clusters[at->second].runs.push_back(run);
    }
  return clusters;
}

std::string equal_runs_note(const CellStreams& streams, const std::vector<std::size_t>& cells,
                            const std::function<std::int64_t(std::size_t cell)>& done) {
  std::int64_t runs = 0, fixed = 0;
  for (const std::size_t cell : cells)
    if (const std::int64_t own = streams.is_fixed(cell) ? done(cell) : 0; own > 1) runs += own, ++fixed;
  if (fixed == 0) return {};
  return std::to_string(runs) + " equal runs count as " + (fixed == 1 ? "one" : std::to_string(fixed));
}

}  // namespace remote_touch
