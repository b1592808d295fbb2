// Packs values one after the other, as they are in memory and without names. The bytes are for another
// process of this machine, or for files that never leave it.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace remote_touch {

class Packer {
 public:
  virtual ~Packer() = default;
  virtual void bytes(const void* data, std::size_t size) = 0;
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
  void list(const std::vector<std::string>& texts) {
    value(texts.size());
    for (const std::string& t : texts) text(t);
  }
  void text(const std::string& t) {
    value(t.size());
    bytes(t.data(), t.size());
  }
};

class MemoryPacker final : public Packer {
 public:
  void bytes(const void* data, std::size_t size) override {
    packed_.append(static_cast<const char*>(data), size);
  }
  std::string take() { return std::move(packed_); }

 private:
  std::string packed_;
};

// Reads values in the order in which a Packer wrote them. The bytes may be damaged: the first value that is
// missing, and all later ones, are left unchanged.
class Unpacker {
 public:
  Unpacker(const char* begin, const char* end) : at_(begin), end_(end) {}
  explicit Unpacker(const std::string& bytes) : Unpacker(bytes.data(), bytes.data() + bytes.size()) {}
  bool good() const { return good_; }                 // true if nothing was missing
  bool done() const { return good_ && at_ == end_; }  // true if, in addition, nothing is left
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
    if (count > 0) std::memcpy(static_cast<void*>(values.data()), at_, count * sizeof(Value));
    at_ += count * sizeof(Value);
  }
  void list(std::vector<std::string>& texts) {
    std::size_t count = 0;
    value(count);
    for (std::size_t i = 0; i < count && good_; ++i) text(texts.emplace_back());
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

}  // namespace remote_touch
