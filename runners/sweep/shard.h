// The part of a sweep that one process runs.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>

namespace remote_touch {

// Shard `index` of `count`, numbered from 1. Cell c of the first round, numbered from 0, belongs to shard c
// mod count + 1. Neighbouring cells cost nearly the same, so every shard has about as many slow cells as the
// others.
struct Shard {
  int index = 1;
  int count = 1;
  // cells_of() returns how many of the `all` cells of the first round belong to the shard. cell() returns the
  // number of its i-th cell, i from 0, in the order of the first round.
  std::size_t cells_of(std::size_t all) const {
    return (all + static_cast<std::size_t>(count - index)) / static_cast<std::size_t>(count);
  }
  std::size_t cell(std::size_t i) const {
    return i * static_cast<std::size_t>(count) + static_cast<std::size_t>(index) - 1;
  }
  std::string text() const { return std::to_string(index) + "/" + std::to_string(count); }
};

// "2/7". Throws InputError.
Shard parse_shard(const std::string& text);

// Some of the shards of a sweep, in a file that was merged from them.
struct ShardSet {
  std::set<int> indices;
  int count = 1;
  std::string text() const;  // "1-3,7/1000"; "2/7" for one shard
};
// Reads what text() returns. Throws InputError, which names the source.
ShardSet parse_shards(const std::string& text, const std::string& source);

// Returns the shard of a Slurm job array (SLURM_ARRAY_TASK_ID, _COUNT, _MIN, _STEP) or of a program started
// by mpirun (OMPI_COMM_WORLD_RANK, _SIZE); none if neither is set. value_of: returns the value of an
// environment variable, null if it is not set, like std::getenv. Throws InputError for values that are not a
// valid shard.
std::optional<Shard> shard_from_environment(const std::function<const char*(const char*)>& value_of);

}  // namespace remote_touch
