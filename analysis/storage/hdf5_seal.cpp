#include "analysis/storage/hdf5_seal.h"

#include <fstream>
#include <string>

#include "analysis/storage/sha256.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

std::string block(const std::string& sum) {
  std::string text = std::string(kResultOpening) + sum + "\n";
  text.resize(kSealSize, '\0');
  return text;
}

}  // namespace

std::vector<char> seal(const std::vector<char>& image) {
  Sha256 hash;
  hash.add(image.data(), image.size());
  const std::string text = block(hash.hex());
  std::vector<char> sealed;
  sealed.reserve(text.size() + image.size());
  sealed.insert(sealed.end(), text.begin(), text.end());
  sealed.insert(sealed.end(), image.begin(), image.end());
  return sealed;
}

void seal_file(const std::filesystem::path& file) {
  const std::string text = block(sha256_of_file(file, kSealSize));
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  stream.write(text.data(), static_cast<std::streamsize>(text.size())).flush();
  if (!stream) throw InputError(file.string(), "cannot be sealed; allowed a writable place");
}

Seal seal_of(const std::filesystem::path& file) {
  std::string found(kSealSize, '\0');
  std::ifstream(file, std::ios::binary).read(found.data(), kSealSize);
  if (!found.starts_with(kResultOpening)) return Seal::absent;
  return found == block(sha256_of_file(file, kSealSize)) ? Seal::intact : Seal::broken;
}

}  // namespace remote_touch
