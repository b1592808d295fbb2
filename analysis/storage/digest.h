// The digest of results: columns equal bit for bit have equal digests.
#pragma once

#include <string>
#include <vector>

#include "analysis/trace/column.h"

namespace remote_touch {

// SHA-256 over name, width and little-endian values of each column in order, as 64 hexadecimal digits. Names
// and texts each end with a zero byte. The name of a table precedes its columns.
std::string digest(const std::vector<Column>& columns);
std::string digest(const std::vector<Table>& tables);

}  // namespace remote_touch
