// Finds out which shards of a sweep the files of a merge hold.
#pragma once

#include <map>
#include <string>

#include "analysis/storage/hdf5_file.h"
#include "runners/sweep/sweep_parts.h"

namespace remote_touch {

// Removes the attribute `shard` and returns what it states. Throws InputError for the result of a whole
// sweep.
ShardSet take_shards(TextAttributes& attributes, const std::string& file);

class SeenShards {
 public:
  // Throws InputError if one of the shards was added before, or the sweep had another number of shards.
  void add(const std::string& file, const ShardSet& shards);
  const ShardSet& all() const { return all_; }
  bool are_complete() const { return all_.indices.size() == static_cast<std::size_t>(all_.count); }
  void require_complete() const;  // throws InputError, which names the missing shards

 private:
  std::string first_file_;
  std::map<int, std::string> file_of_;
  ShardSet all_;
};

}  // namespace remote_touch
