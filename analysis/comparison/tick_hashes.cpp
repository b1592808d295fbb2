#include "analysis/comparison/tick_hashes.h"

#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/schema.h"
#include "analysis/trace/hash64.h"

namespace remote_touch {

TickHashes hashes_of_trace(const StoredTrace& trace, int every) {
  const std::vector<std::uint64_t> all = trace.running_hash();
  TickHashes some;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i % static_cast<std::size_t>(every) != 0 && i + 1 != all.size()) continue;
    some.tick.push_back(static_cast<std::int32_t>(i));
    some.hash.push_back(all[i]);
  }
  return some;
}

void write_hashes(const std::filesystem::path& file, const TickHashes& hashes,
                  const TextAttributes& provenance) {
  Hdf5Writer hdf5;
  hdf5.attribute("/", "schema", schema_name("hashes"));
  hdf5.attributes("/", provenance);
  hdf5.group("/hashes");
  hdf5.columns("/hashes",
               {{"tick", "1", "number of the haptic tick", hashes.tick},
                {"tick_hash", "1", "64-bit hash of all columns up to this tick", hashes.hash}},
               "tick");
  hdf5.save(file);
}

StoredHashes read_hashes(const Hdf5Reader& hdf5) {
  hdf5.require_kind("hashes", "the result of remote-touch hashes");
  StoredHashes stored{
      {hdf5.values<std::int32_t>("/hashes/tick"), hdf5.values<std::uint64_t>("/hashes/tick_hash")},
      hdf5.attributes()};
  const std::vector<std::int32_t>& tick = stored.hashes.tick;
  if (tick.size() != stored.hashes.hash.size()) hdf5.damaged("its ticks and hashes differ in number");
  for (std::size_t i = 0; i < tick.size(); ++i)
    if (tick[i] < 0 || (i > 0 && tick[i] <= tick[i - 1])) hdf5.damaged("its ticks are out of order");
  return stored;
}

HashComparison compare_hashes(const TickHashes& baseline, const TickHashes& candidate) {
  HashComparison result;
  result.same_length =
      !baseline.tick.empty() && !candidate.tick.empty() && baseline.tick.back() == candidate.tick.back();
  for (std::size_t i = 0, j = 0; i < baseline.tick.size() && j < candidate.tick.size();) {
    if (baseline.tick[i] < candidate.tick[j]) {
      ++i;
    } else if (baseline.tick[i] > candidate.tick[j]) {
      ++j;
    } else {
      ++result.compared;
      const int tick = baseline.tick[i];
      const bool same = baseline.hash[i++] == candidate.hash[j++];
      if (same)
        result.same = tick;
      else if (!result.different)
        result.different = tick;
    }
  }
  return result;
}

}  // namespace remote_touch
