#include "analysis/storage/digest.h"

#include <bit>

#include "analysis/storage/sha256.h"

namespace remote_touch {

static_assert(std::endian::native == std::endian::little,
              "the digest hashes the bytes of the columns as they lie");

namespace {

template <class Number>
void add_values(Sha256& hash, const std::vector<Number>& numbers) {
  hash.add(numbers.data(), numbers.size() * sizeof(Number));
}

void add_values(Sha256& hash, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) hash.add(text.c_str(), text.size() + 1);
}

void add(Sha256& hash, const Column& column) {
  hash.add(column.name.c_str(), column.name.size() + 1);
  hash.add(&column.width, sizeof column.width);
  std::visit([&hash](const auto& v) { add_values(hash, v); }, column.values);
}

}  // namespace

std::string digest(const std::vector<Column>& columns) {
  Sha256 hash;
  for (const Column& column : columns) add(hash, column);
  return hash.hex();
}

std::string digest(const std::vector<Table>& tables) {
  Sha256 hash;
  for (const Table& table : tables) {
    hash.add(table.name.c_str(), table.name.size() + 1);
    for (const Column& column : table.columns) add(hash, column);
  }
  return hash.hex();
}

}  // namespace remote_touch
