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

void begin_column(Sha256& hash, const std::string& name, int width) {
  hash.add(name.c_str(), name.size() + 1);
  hash.add(&width, sizeof width);
}

void add(Sha256& hash, const Values& values) {
  std::visit([&hash](const auto& v) { add_values(hash, v); }, values);
}

void add(Sha256& hash, const Column& column) {
  begin_column(hash, column.name, column.width);
  add(hash, column.values);
}

}  // namespace

ColumnDigest::ColumnDigest() : hash_(std::make_unique<Sha256>()) {}
ColumnDigest::~ColumnDigest() = default;

void ColumnDigest::begin(const std::string& name, int width) {
  begin_column(*hash_, name, width);
}

void ColumnDigest::add(const Values& values) {
  remote_touch::add(*hash_, values);
}

std::string ColumnDigest::text() {
  return hash_->hex();
}

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
