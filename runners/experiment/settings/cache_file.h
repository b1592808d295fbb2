// Cache files of objects that take long to make, their folder, and its size.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "analysis/storage/digest.h"
#include "analysis/storage/other_processes.h"

namespace remote_touch {

// Returns the folder of the cache: the folder that the environment variable REMOTE_TOUCH_CACHE names. If it
// is not set, returns the folder remote-touch in XDG_CACHE_HOME, or in .cache of HOME. The path is empty if
// none of these variables is set.
std::filesystem::path cache_folder();

// The size of the cache folder, which is bounded: tools of many variants of a mesh would fill the disk.
struct CacheSize {
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
};

// Returns the maximum size of the cache folder: the environment variable REMOTE_TOUCH_CACHE_MB, or 512 MB if
// it is not set. Throws InputError if it is not a number of megabytes.
std::uintmax_t max_cache_bytes();

CacheSize cache_size(const std::filesystem::path& folder);

// Removes temporary files of programs that were killed while they wrote them, if they were not used for an
// hour, and then the cache files that were used longest ago, until their size is at most max_bytes. Other
// files are kept. Returns the number and size of the cache files that are left.
CacheSize shrink_cache(const std::filesystem::path& folder, std::uintmax_t max_bytes);

// Cache files of objects that take long to make: a line with their kind, the key that they were made for,
// their fields as in memory (a cache never leaves its machine), and the SHA-256 of all that.

// Packs into a hash, and into a file if one is given.
class CacheWriter final : public Packer {
 public:
  explicit CacheWriter(int file = -1) : file_(file) {}
  bool good() const { return good_; }
  void bytes(const void* data, std::size_t size) override;
  std::string hex() { return hash_.hex(); }
  void end_with_hash();

 private:
  void write(const char* data, std::size_t size);

  int file_;
  bool good_ = true;
  Sha256 hash_;
};

// The kind of a cache file. The first line of the file has the name of the kind and the version of the
// format. The file is named KEY.NAME, with the name of its kind.
struct CacheKind {
  std::string name;
  int version;
};

// Returns version, digest of the sources, compiler and flags of this program as a text for keys. Everything
// in the cache has it in its key, because another build may compute something else.
std::string build_for_keys();

// Returns true if the folder has a complete file of that kind and key, and take() has read all its fields.
// Then marks the file as used now. Does not call take() for a file of another key.
bool read_cache_file(const std::filesystem::path& folder, const CacheKind& kind, const std::string& key,
                     const std::function<void(Unpacker&)>& take);

// Writes the file under a temporary name and renames it, so that other processes see the whole file or none.
// Creates the folder. Then removes the files that make the folder too large. Returns false if the file cannot
// be written, which is not an error. Throws InputError as max_cache_bytes() does. If put() throws, the
// temporary file is removed.
bool write_cache_file(const std::filesystem::path& folder, const CacheKind& kind, const std::string& key,
                      const std::function<void(CacheWriter&)>& put);

}  // namespace remote_touch
