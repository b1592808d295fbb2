#include "analysis/storage/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {
EVP_MD_CTX* context(const std::shared_ptr<void>& state) {
  return static_cast<EVP_MD_CTX*>(state.get());
}
}  // namespace

Sha256::Sha256() : state_(EVP_MD_CTX_new(), [](void* c) { EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(c)); }) {
  if (!state_ || EVP_DigestInit_ex(context(state_), EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not available");
}

void Sha256::add(const void* data, std::size_t size) {
  EVP_DigestUpdate(context(state_), data, size);
}

std::string Sha256::hex() {
  std::array<unsigned char, 32> bytes{};
  EVP_DigestFinal_ex(context(state_), bytes.data(), nullptr);
  std::string text;
  for (const unsigned char b : bytes) text += "0123456789abcdef"[b >> 4], text += "0123456789abcdef"[b & 15];
  return text;
}

std::string sha256_of_file(const std::filesystem::path& file, std::size_t from) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(from));
  std::vector<char> part(1 << 18);
  Sha256 hash;
  while (in && in.read(part.data(), static_cast<std::streamsize>(part.size())).gcount() > 0)
    hash.add(part.data(), static_cast<std::size_t>(in.gcount()));
  if (!in.eof()) throw InputError(file.string(), "cannot be read: expected a readable file");
  return hash.hex();
}

}  // namespace remote_touch
