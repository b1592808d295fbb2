// Cache files of objects that take long to make: a line with their kind, the key that they were made for,
// their fields as in memory (a cache never leaves its machine), and the SHA-256 of all that.
#pragma once

#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "analysis/storage/sha256.h"

namespace remote_touch {

// Writes values one after the other into a hash, and into a file if one is given.
class CacheWriter {
 public:
  explicit CacheWriter(int file = -1) : file_(file) {}
  bool good() const { return good_; }
  void bytes(const void* data, std::size_t size);
  template <class Value>
  void value(const Value& v) {
    static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
    bytes(&v, sizeof v);
  }
  template <class Value>
  void list(const std::vector<Value>& values) {
    value(values.size());
    bytes(values.data(), values.size() * sizeof(Value));
  }
  void text(const std::string& t) {
    value(t.size());
    bytes(t.data(), t.size());
  }
  std::string hex() { return hash_.hex(); }
  void end_with_hash();

 private:
  void write(const char* data, std::size_t size);

  int file_;
  bool good_ = true;
  Sha256 hash_;
};

// Reads values from bytes; once one is missing, it and all later ones are left unchanged.
class CacheReader {
 public:
  CacheReader(const char* begin, const char* end) : at_(begin), end_(end) {}
  bool done() const { return good_ && at_ == end_; }  // nothing was missing, nothing is left
  template <class Value>
  void value(Value& v) {
    if (has(1, sizeof v)) std::memcpy(&v, at_, sizeof v), at_ += sizeof v;
  }
  template <class Value>
  void list(std::vector<Value>& values) {
    std::size_t count = 0;
    value(count);
    if (!has(count, sizeof(Value))) return;
    values.resize(count);
    std::memcpy(static_cast<void*>(values.data()), at_, count * sizeof(Value));
    at_ += count * sizeof(Value);
  }
  void text(std::string& t) {
    std::size_t count = 0;
    value(count);
    if (has(count, 1)) t.assign(at_, count), at_ += count;
  }

 private:
  bool has(std::size_t count, std::size_t size) {
    good_ = good_ && count <= static_cast<std::size_t>(end_ - at_) / size;
    return good_;
  }
  const char *at_, *end_;
  bool good_ = true;
};

// The kind of a cache file, its first line, which ends with the version of the format. Files are named
// KEY.KIND.
struct CacheKind {
  std::string name;
  int version;
};

// Whether the folder has a complete file of that kind and key, and take() read all its fields.
bool read_cache_file(const std::filesystem::path& folder, const CacheKind& kind, const std::string& key,
                     const std::function<void(CacheReader&)>& take);

// Writes to a temporary name and renames, so that other processes see the whole file or none; creates the
// folder, and removes from it what makes it too large. Returns false if it cannot be written, which is not an
// error. Throws InputError as max_cache_bytes().
bool write_cache_file(const std::filesystem::path& folder, const CacheKind& kind, const std::string& key,
                      const std::function<void(CacheWriter&)>& put);

}  // namespace remote_touch
