#include "runners/sweep/shards/seen_shards.h"

#include <algorithm>

#include "core/parameters/input_error.h"

namespace remote_touch {

ShardSet take_shards(TextAttributes& attributes, const std::string& file) {
  const auto shard =
      std::find_if(attributes.begin(), attributes.end(), [](const auto& a) { return a.first == "shard"; });
  if (shard == attributes.end())
    throw InputError(file, "is the result of a whole sweep: expected the shards of a sweep");
  const ShardSet shards = parse_shards(shard->second, file);
  attributes.erase(shard);
  return shards;
}

void SeenShards::add(const std::string& file, const ShardSet& shards) {
  if (file_of_.empty()) first_file_ = file, all_.count = shards.count;
  if (shards.count != all_.count)
    throw InputError(file, "is shard " + shards.text() + ": expected shards of a sweep in " +
                               std::to_string(all_.count) + " shards, as " + first_file_ + " is");
  for (const int index : shards.indices)
    if (const auto [twin, is_new] = file_of_.emplace(index, file); !is_new)
      throw InputError(file, "is shard " + Shard{index, shards.count}.text() + ", which is also in " +
                                 twin->second + ": expected each shard once");
  all_.indices.insert(shards.indices.begin(), shards.indices.end());
}

void SeenShards::require_complete() const {
  if (are_complete()) return;
  ShardSet missing{{}, all_.count};
  for (int i = 1; i <= all_.count; ++i)
    if (!all_.indices.contains(i)) missing.indices.insert(i);
  const bool is_one = missing.indices.size() == 1;
  throw InputError("merge", std::string(is_one ? "shard " : "shards ") + missing.text() +
                                (is_one ? " is" : " are") + " missing: expected all of them, or --partial");
}

}  // namespace remote_touch
