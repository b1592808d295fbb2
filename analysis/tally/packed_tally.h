// A cell's tally as bytes, for journals to which they are only appended.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "analysis/tally/cell_tally.h"

namespace remote_touch {

// Format: "RTt1", the content, and a 64-bit checksum of all bytes before it. The content is the members of
// CellTally in their order. Counts and numbers of runs are unsigned in base 128, least digit first, with the
// high bit set in all digits but the last; doubles have 8 bytes, little-endian. A list begins with its
// length. Buckets are stored as the distance from the one before. Equal tallies have equal bytes.
std::string to_bytes(const CellTally& tally);

// Returns nothing unless the bytes are exactly what to_bytes() returns for some tally. One changed bit is
// always noticed, other damage with a probability of 1 - 2^-64.
std::optional<CellTally> from_bytes(std::string_view bytes);

}  // namespace remote_touch
