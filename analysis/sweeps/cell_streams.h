// Runs of a sweep that share random numbers, and runs that draw none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// The random streams from which the runs of a cell draw. A stream of the cell has the key (seed, cell without
// the axes of common noise, replicate); that of the replicate, as of a registration error, the key (seed,
// replicate).
struct RandomStreams {
  bool of_cell = false, of_replicate = false;

  // The runs of a fixed cell draw no random number: its replicates are equal and count as one run.
  bool is_fixed() const { return !of_cell && !of_replicate; }
};

// The streams of all cells of a sweep.
struct CellStreams {
  std::vector<RandomStreams> draws;     // one for each cell
  std::vector<std::size_t> noise_cell;  // the cell whose stream each cell uses
  std::vector<std::size_t> seed;        // a number for the seed of each cell: equal for equal seeds
  std::string doubt = {};  // why the streams are not known, and what is assumed then; empty: they are known

  bool is_fixed(std::size_t cell) const { return draws[cell].is_fixed(); }
  // True if these cells must be taken together replicate by replicate: one of them draws from the stream of
  // its replicate.
  bool share_replicates(const std::vector<std::size_t>& cells) const;
  // True if no two of these cells that draw share random numbers.
  bool are_independent(const std::vector<std::size_t>& cells) const;
};

// Returns streams in which every cell draws from its own, as without axes of common noise.
CellStreams independent_streams(std::size_t cells);

// The runs of some cells, as clusters: the runs of a cluster share random numbers, and clusters share none. A
// fixed cell has one run here, its first, in a cluster of its own.
struct RunCluster {
  std::vector<std::size_t> runs;  // finished ones
  std::size_t noise_cell = 0;     // the one of its first run; the clusters of a cell are a stratum
  bool is_fixed = false;
};
// Returns the clusters of the finished runs of these cells, in the order of their first runs. by_replicate:
// one cluster for each seed and replicate, as if one of the cells drew from the stream of its replicate.
// pre: the result is whole.
std::vector<RunCluster> clusters_of(const SweepResult& result, const CellStreams& streams,
                                    const std::vector<std::size_t>& cells, bool by_replicate);

// Returns the note on cells whose replicates are equal by construction: "40 equal runs count as one"; empty
// if there is none. done: returns the number of finished runs of a cell.
std::string equal_runs_note(const CellStreams& streams, const std::vector<std::size_t>& cells,
                            const std::function<std::int64_t(std::size_t cell)>& done);

}  // namespace remote_touch
