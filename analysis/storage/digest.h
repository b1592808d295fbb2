// The digest of results: columns equal bit for bit have equal digests.
#pragma once

#include <string>
#include <vector>

#include "analysis/trace/column.h"

namespace remote_touch {

// SHA-256 over name, width and little-endian values (texts each with a zero at the end) of each column in
// order, as 64 hexadecimal digits.
std::string digest(const std::vector<Column>& columns);
std::string digest(const std::vector<Table>& tables);

}  // namespace remote_touch
