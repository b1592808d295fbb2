// The running hash of a trace, without the trace. It can be sent to another machine to find the first tick at
// which two runs differ. It has 8 bytes per tick, or less if only every n-th tick is kept.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "analysis/comparison/column_source.h"
#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

struct TickHashes {
  std::vector<std::int32_t> tick;   // increasing; the last is the trace's last
  std::vector<std::uint64_t> hash;  // the running hash at that tick (hash64.h)
};

// Returns every n-th tick of a trace (n = every), and the last. pre: every > 0.
TickHashes hashes_of_trace(const StoredTrace& trace, int every);

void write_hashes(const std::filesystem::path& file, const TickHashes& hashes,
                  const TextAttributes& provenance);
struct StoredHashes {
  TickHashes hashes;
  TextAttributes attributes;
};
StoredHashes read_hashes(const Hdf5Reader& file);  // throws InputError for any other file
inline StoredHashes read_hashes(const std::filesystem::path& file) {
  return read_hashes(Hdf5Reader(file));
}

// Comparison over the ticks that both have. The runs are equal up to and including tick `same`, and differ
// from tick `different` on. The ticks in between are not stored in both.
struct HashComparison {
  std::size_t compared = 0;
  std::optional<int> same, different;
  bool same_length = false;
  bool is_same() const { return compared > 0 && same_length && !different; }
};
HashComparison compare_hashes(const TickHashes& baseline, const TickHashes& candidate);

}  // namespace remote_touch
