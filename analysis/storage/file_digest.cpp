#include "analysis/storage/file_digest.h"

#include <fstream>
#include <string>

#include "analysis/storage/sha256.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

std::string block(const std::string& sum) {
  std::string text = std::string(kResultOpening) + sum + "\n";
  text.resize(kDigestBlockSize, '\0');
  return text;
}

}  // namespace

std::vector<char> with_file_digest(const std::vector<char>& image) {
  Sha256 hash;
  hash.add(image.data(), image.size());
  const std::string text = block(hash.hex());
  std::vector<char> sealed;
  sealed.reserve(text.size() + image.size());
  sealed.insert(sealed.end(), text.begin(), text.end());
  sealed.insert(sealed.end(), image.begin(), image.end());
  return sealed;
}

void write_file_digest(const std::filesystem::path& file) {
  const std::string text = block(sha256_of_file(file, kDigestBlockSize));
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  stream.write(text.data(), static_cast<std::streamsize>(text.size())).flush();
  if (!stream) throw InputError(file.string(), "cannot be sealed: expected a writable place");
}

bool has_result_header(const std::filesystem::path& file) {
  std::error_code unreachable;  // a pipe would lose what is read of it
  if (!std::filesystem::is_regular_file(file, unreachable)) return false;
  std::string opening(kResultOpening.size(), '\0');
  std::ifstream(file, std::ios::binary).read(opening.data(), static_cast<std::streamsize>(opening.size()));
  return opening == kResultOpening;
}

FileDigest file_digest_of(const std::filesystem::path& file) {
  std::string found(kDigestBlockSize, '\0');
  std::ifstream(file, std::ios::binary).read(found.data(), kDigestBlockSize);
  if (!found.starts_with(kResultOpening)) return FileDigest::absent;
  return found == block(sha256_of_file(file, kDigestBlockSize)) ? FileDigest::valid : FileDigest::broken;
}

}  // namespace remote_touch
