#include "analysis/digest.h"

#include <openssl/evp.h>

#include <array>
#include <bit>
#include <memory>
#include <stdexcept>

namespace remote_touch {

static_assert(std::endian::native == std::endian::little,
              "the digest hashes the bytes of the columns as they lie");

namespace {

class Sha256 {
 public:
  Sha256() : state_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    if (!state_ || EVP_DigestInit_ex(state_.get(), EVP_sha256(), nullptr) != 1)
      throw std::runtime_error("SHA-256 is not available");
  }
  void add(const void* data, std::size_t size) { EVP_DigestUpdate(state_.get(), data, size); }
  void add(const Column& column) {
    add(column.name.c_str(), column.name.size() + 1);
    add(&column.width, sizeof column.width);
    std::visit([this](const auto& v) { add_values(v); }, column.values);
  }
  std::string hex() {
    std::array<unsigned char, 32> bytes{};
    EVP_DigestFinal_ex(state_.get(), bytes.data(), nullptr);
    std::string text;
    for (const unsigned char b : bytes)
      text += "0123456789abcdef"[b >> 4], text += "0123456789abcdef"[b & 15];
    return text;
  }

 private:
  template <class Number>
  void add_values(const std::vector<Number>& numbers) {
    add(numbers.data(), numbers.size() * sizeof(Number));
  }
  void add_values(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) add(text.c_str(), text.size() + 1);
  }

  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> state_;
};

}  // namespace

std::string digest(const std::vector<Column>& columns) {
  Sha256 hash;
  for (const Column& column : columns) hash.add(column);
  return hash.hex();
}

std::string digest(const std::vector<Table>& tables) {
  Sha256 hash;
  for (const Table& table : tables) {
    hash.add(table.name.c_str(), table.name.size() + 1);
    for (const Column& column : table.columns) hash.add(column);
  }
  return hash.hex();
}

}  // namespace remote_touch
