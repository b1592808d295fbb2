// The part of a sweep that one process runs.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace remote_touch {

// Shard `index` of `count`, numbered from 1. Cell c of the first round, numbered from 0, belongs to shard c
// mod count + 1. Neighbouring cells cost nearly the same, so every shard has about as many slow cells as the
// others.
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

// Returns the shard of a Slurm job array (SLURM_ARRAY_TASK_ID, _COUNT, _MIN, _STEP) or of a program started
// by mpirun (OMPI_COMM_WORLD_RANK, _SIZE); none if neither is set. value_of: returns the value of an
// environment variable, null if it is not set, like std::getenv. Throws InputError for values that are not a
// valid shard.
std::optional<Shard> shard_from_environment(const std::function<const char*(const char*)>& value_of);

}  // namespace remote_touch
