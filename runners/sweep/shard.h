// Which part of a sweep a process does.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace remote_touch {

// Shard index of count, counted from 1. Cell c of the first round, counted from 0, belongs to shard
// c mod count + 1: neighbours differ little in cost, so every shard gets its share of slow ones.
struct Shard {
  int index = 1;
  int count = 1;
  bool has(std::size_t cell) const {
    return cell % static_cast<std::size_t>(count) + 1 == static_cast<std::size_t>(index);
  }
  std::string text() const { return std::to_string(index) + "/" + std::to_string(count); }
};

// "2/7". Throws InputError.
Shard parse_shard(const std::string& text);

// Of a Slurm job array (SLURM_ARRAY_TASK_ID, _COUNT, _MIN, _STEP) or a program started by mpirun
// (OMPI_COMM_WORLD_RANK, _SIZE); nothing where neither is set. Throws InputError for values that make no
// shard. value_of: of an environment variable, null where it is not set, as std::getenv tells it.
std::optional<Shard> shard_from_environment(const std::function<const char*(const char*)>& value_of);

}  // namespace remote_touch
