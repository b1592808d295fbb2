#include "analysis/tally/packed_tally.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "analysis/trace/hash64.h"

namespace remote_touch {

namespace {

constexpr std::string_view kOpening = "RTt1";

// The chain over the words of 8 bytes; the last one is filled up with zeros, and the length is the first
// word.
std::uint64_t checksum_of(std::string_view bytes) {
  std::uint64_t hash = mixed(0, bytes.size());
  for (std::size_t at = 0; at < bytes.size(); at += sizeof hash) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    hash = mixed(hash, word);
  }
  return hash;
}

// The sign is moved to the lowest bit, so that small numbers of either sign have few digits.
std::uint64_t without_sign(std::int64_t number) {
  return (static_cast<std::uint64_t>(number) << 1) ^ (number < 0 ? ~std::uint64_t{0} : 0);
}
std::int64_t with_sign(std::uint64_t number) {
  return static_cast<std::int64_t>((number >> 1) ^ ((number & 1) != 0 ? ~std::uint64_t{0} : 0));
}

class TallyPacker {
 public:
  void number(std::uint64_t value) {
    for (; value > 0x7f; value >>= 7) bytes_ += static_cast<char>((value & 0x7f) | 0x80);
    bytes_ += static_cast<char>(value);
  }
  void count(std::int64_t value) { number(static_cast<std::uint64_t>(value)); }
  void real(double value) { raw(std::bit_cast<std::uint64_t>(value)); }
  void text(const std::string& text) { number(text.size()), bytes_ += text; }
  void sum(const ExactSum& sum) {
    const std::vector<double> parts = sum.parts();
    number(parts.size());
    for (const double part : parts) real(part);
  }
  void sketch(const QuantileSketch& sketch) {
    const auto pairs = sketch.pairs();
    number(pairs.size());
    std::int64_t before = 0;
    for (const auto& [bucket, values] : pairs) {
      number(without_sign(bucket - before)), count(values);
      before = bucket;
    }
  }
  void runs(const std::vector<std::uint64_t>& runs) {
    number(runs.size());
    std::uint64_t before = 0;
    for (const std::uint64_t run : runs) number(run - before), before = run;
  }
  std::string finished() {
    raw(checksum_of(bytes_));
    return std::move(bytes_);
  }

 private:
  void raw(std::uint64_t bits) { bytes_.append(reinterpret_cast<const char*>(&bits), sizeof bits); }
  std::string bytes_{kOpening};
};

// After the first value that is missing or wrong all others are 0.
class TallyUnpacker {
 public:
  explicit TallyUnpacker(std::string_view bytes) : left_(bytes) {}
  bool is_done() const { return good_ && left_.empty(); }
  bool is_good() const { return good_; }

  std::uint64_t number() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64 && !left_.empty(); shift += 7) {
      const auto digit = static_cast<unsigned char>(left_.front());
      left_.remove_prefix(1);
      value |= std::uint64_t{digit & 0x7fu} << shift;
      if (digit < 0x80) return value;
    }
    return fail();
  }
  std::int64_t count() { return static_cast<std::int64_t>(number()); }
  double real() {
    std::uint64_t bits = 0;
    if (left_.size() < sizeof bits) return static_cast<double>(fail());
    std::memcpy(&bits, left_.data(), sizeof bits);
    left_.remove_prefix(sizeof bits);
    return std::bit_cast<double>(bits);
  }
  // Length of a list: each item has at least one byte, so that no damage claims much memory.
  std::size_t length() {
    const std::uint64_t length = number();
    return length <= left_.size() ? length : fail();
  }
  std::string text() {
    std::string text(left_.substr(0, length()));
    left_.remove_prefix(text.size());
    return text;
  }
  ExactSum sum() {
    std::vector<double> parts(length());
    for (double& part : parts) part = real();
    return known(ExactSum::from_parts(parts));
  }
  QuantileSketch sketch() {
    std::vector<std::pair<std::int32_t, std::int64_t>> pairs(length());
    std::int64_t bucket = 0;
    for (auto& [number_of_bucket, values] : pairs) {
      bucket = static_cast<std::int64_t>(static_cast<std::uint64_t>(bucket) +
                                         static_cast<std::uint64_t>(with_sign(number())));
      number_of_bucket = static_cast<std::int32_t>(bucket);
      values = count();
    }
    return known(QuantileSketch::from_pairs(pairs));
  }
  std::vector<std::uint64_t> runs() {
    std::vector<std::uint64_t> runs(length());
    std::uint64_t before = 0;
    for (std::uint64_t& run : runs) run = before += number();
    return runs;
  }

 private:
  std::uint64_t fail() {
    good_ = false, left_ = {};
    return 0;
  }
  template <class Value>
  Value known(std::optional<Value> value) {
    if (!value) fail();
    return value ? std::move(*value) : Value();
  }
  std::string_view left_;
  bool good_ = true;
};

void pack(TallyPacker& to, const MeasureTally& measure) {
  to.count(measure.values), to.count(measure.unknown), to.count(measure.infinite);
  to.real(measure.least), to.real(measure.greatest);
  to.sum(measure.sum), to.sum(measure.squares);
  to.sketch(measure.sketch);
}

MeasureTally unpacked_measure(TallyUnpacker& from) {
  MeasureTally measure;
  measure.values = from.count(), measure.unknown = from.count(), measure.infinite = from.count();
  measure.least = from.real(), measure.greatest = from.real();
  measure.sum = from.sum(), measure.squares = from.sum();
  measure.sketch = from.sketch();
  return measure;
}

CellTally unpacked(TallyUnpacker& from) {
  CellTally tally;
  tally.done = from.count(), tally.failed = from.count();
  tally.first_failed = from.number(), tally.first_error = from.text();
  for (std::size_t left = from.length(); left > 0 && from.is_good(); --left)
    tally.measures.push_back(unpacked_measure(from));
  tally.notes.resize(from.length());
  for (NoteTally& note : tally.notes) note.runs = from.count(), note.first = from.number();
  for (std::size_t left = from.length(); left > 0 && from.is_good(); --left)
    tally.events.push_back(from.runs());
  return tally;
}

}  // namespace

std::string to_bytes(const CellTally& tally) {
  TallyPacker packer;
  packer.count(tally.done), packer.count(tally.failed);
  packer.number(tally.first_failed), packer.text(tally.first_error);
  packer.number(tally.measures.size());
  for (const MeasureTally& measure : tally.measures) pack(packer, measure);
  packer.number(tally.notes.size());
  for (const NoteTally& note : tally.notes) packer.count(note.runs), packer.number(note.first);
  packer.number(tally.events.size());
  for (const auto& runs : tally.events) packer.runs(runs);
  return packer.finished();
}

std::optional<CellTally> from_bytes(std::string_view bytes) {
  std::uint64_t checksum = 0;
  if (!bytes.starts_with(kOpening) || bytes.size() < kOpening.size() + sizeof checksum) return {};
  const std::string_view content = bytes.substr(0, bytes.size() - sizeof checksum);
  std::memcpy(&checksum, bytes.data() + content.size(), sizeof checksum);
  if (checksum != checksum_of(content)) return {};
  TallyUnpacker unpacker(content.substr(kOpening.size()));
  CellTally tally = unpacked(unpacker);
  // The last comparison refuses what only another program writes, for example a number with needless digits.
  if (!unpacker.is_done() || !tally.contradiction().empty() || to_bytes(tally) != bytes) return {};
  return tally;
}

}  // namespace remote_touch
