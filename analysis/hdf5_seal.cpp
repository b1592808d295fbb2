#include "analysis/hdf5_seal.h"

#include <fstream>
#include <string>

#include "analysis/sha256.h"

namespace remote_touch {

namespace {

const std::string kOpening = "Remote Touch result. HDF5 begins at byte 512; SHA-256 from there on:\n";

std::string block(const std::string& sum) {
  std::string text = kOpening + sum + "\n";
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

Seal seal_of(const std::filesystem::path& file) {
  std::string found(kSealSize, '\0');
  std::ifstream(file, std::ios::binary).read(found.data(), kSealSize);
  if (!found.starts_with(kOpening)) return Seal::absent;
  return found == block(sha256_of_file(file, kSealSize)) ? Seal::intact : Seal::broken;
}

}  // namespace remote_touch
