#include "tests/fuzz/shared/cache_target.h"

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "analysis/storage/digest.h"
#include "analysis/storage/other_processes.h"
#include "tests/fuzz/shared/scratch_file.h"

namespace remote_touch::fuzz {

std::filesystem::path cache_folder(const std::string& kind, int version, std::string_view bytes) {
  ::unsetenv("REMOTE_TOUCH_CACHE_MB");  // a limit that the user has set would remove the files
  const std::string name = "cache/" + std::string(kCacheKey) + "." + kind;
  const std::string_view rest = bytes.substr(std::min<std::size_t>(1, bytes.size()));
  if (bytes.starts_with('r')) return scratch_file(name, rest).parent_path();
  MemoryPacker key;
  key.text(kCacheKey);
  std::string file = "remote-touch-" + kind + "/" + std::to_string(version) + "\n" + key.take();
  file += rest;
  Sha256 hash;
  hash.add(file.data(), file.size());
  return scratch_file(name, file + hash.hex()).parent_path();
}

std::string cache_bytes(const std::filesystem::path& folder, const std::string& kind) {
  std::ifstream in(folder / (std::string(kCacheKey) + "." + kind), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace remote_touch::fuzz
