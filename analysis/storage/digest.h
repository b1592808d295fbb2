// The digest of results: columns equal bit for bit have equal digests.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analysis/trace/column.h"

namespace remote_touch {

// SHA-256 over name, width and little-endian values of each column in order, as 64 hexadecimal digits. Names
// and texts each end with a zero byte. The name of a table precedes its columns.
std::string digest(const std::vector<Column>& columns);
std::string digest(const std::vector<Table>& tables);

class Sha256;

// The same digest of columns whose values come in blocks.
class ColumnDigest {
 public:
  ColumnDigest();
  ~ColumnDigest();
  void begin(const std::string& name, int width);  // begins the next column
  void add(const Values& values);                  // the next values of the column
  std::string text();                              // call once, at the end

 private:
  std::unique_ptr<Sha256> hash_;
};

}  // namespace remote_touch
