#include "analysis/sweeps/sweep_tally.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numeric>

namespace remote_touch {
namespace {

// No term is larger than kLargest in magnitude. So the sum of two terms is finite.
constexpr double kUnit = 0x1p1023, kLargest = 0x1p1022;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Replaces a sum by its rounded sum with the value, and returns the exact error (Knuth's TwoSum).
double add_and_return_error(double& sum, double value) {
  const double before = sum;
  sum = before + value;
  const double of_value = sum - before;
  return (before - (sum - of_value)) + (value - of_value);
}

// If the number is larger than kLargest, it loses one unit, which is returned. This is exact.
std::int64_t unit_taken_from(double& number) {
  if (std::abs(number) <= kLargest) return 0;
  const std::int64_t unit = number > 0 ? 1 : -1;
  number -= static_cast<double>(unit) * kUnit;
  return unit;
}

// Parts are nonoverlapping and by increasing magnitude. The value is added from the least part up; errors
// that are 0 are dropped.
void grow(std::vector<double>& parts, double value) {
  std::size_t kept = 0;
  for (const double part : parts) {
    const double error = add_and_return_error(value, part);
    if (error != 0) parts[kept++] = error;
  }
  parts.resize(kept);
  if (value != 0) parts.push_back(value);
}

// Returns the nearest double to the sum of parts. The largest parts decide, down to the first sum that is not
// exact. The sign of the next part decides where its error is half an ulp.
double rounded(const std::vector<double>& parts) {
  std::size_t left = parts.size();
  double sum = 0, error = 0;
  while (left > 0 && error == 0) error = add_and_return_error(sum, parts[--left]);
  if (error == 0 || left == 0 || (error < 0) != (parts[left - 1] < 0)) return sum;
  const double further = sum + 2 * error;
  return further - sum == 2 * error ? further : sum;
}

// Afterwards each part is the rounded sum of itself and all smaller ones: at most 40 parts, because each is
// at most half an ulp of the next one, and doubles have 2098 bits.
void make_short(std::vector<double>& parts) {
  std::vector<double> few;
  for (double part = rounded(parts); part != 0; part = rounded(parts))
    few.push_back(part), grow(parts, -part);
  parts.assign(few.rbegin(), few.rend());
}

// A sum as parts and units. No part is larger than kLargest.
struct Total {
  std::vector<double> parts = {};
  std::int64_t units = 0;

  void add(double value) {
    units += unit_taken_from(value);
    units += unit_taken_from(value);  // it was almost two units
    grow(parts, value);
    if (!parts.empty()) units += unit_taken_from(parts.back());
    if (!parts.empty() && parts.back() == 0) parts.pop_back();
  }
  double value() const;
  std::vector<double> beyond_doubles() const;
};

double Total::value() const {
  if (units == 0) return rounded(parts);
  if (std::abs(units) > 4) return units > 0 ? kInfinity : -kInfinity;
  // The sum of 1/16 of everything, which is at least 2^1018. Of the parts that would lose bits only the sign
  // of the largest one matters, where the rest is half an ulp.
  double tiny = 0;
  std::vector<double> small;
  for (const double part : parts)
    if (std::abs(part) < 0x1p-1000)
      tiny = std::copysign(std::numeric_limits<double>::denorm_min(), part);
    else
      grow(small, part / 16);
  grow(small, tiny);
  grow(small, static_cast<double>(units) * (kUnit / 16));
  return 16 * rounded(small);
}

// The same sum may have parts of slightly more than 2^1022, or of -2^1022 and one unit more.
std::vector<double> Total::beyond_doubles() const {
  std::vector<double> rest = parts;
  make_short(rest);
  const double largest = rest.empty() ? 0 : rest.back();
  const double next = rest.size() < 2 ? 0 : rest[rest.size() - 2];
  int more = 0;
  if (largest > kLargest || (largest == kLargest && next > 0)) more = 1;
  if (largest < -kLargest || (largest == -kLargest && next <= 0)) more = -1;
  grow(rest, -more * kUnit);
  make_short(rest);
  std::vector<double> all = {units > 0 ? kInfinity : -kInfinity, static_cast<double>(units + more)};
  all.insert(all.end(), rest.rbegin(), rest.rend());
  return all;
}

Total total_of(std::vector<double> others, const std::array<double, 3>& largest, std::int64_t units) {
  Total total{std::move(others), units};
  for (const double value : largest) total.add(value);
  return total;
}

}  // namespace

void UnroundedSum::add(double value) {
  constexpr std::size_t kMaxOthers = 64;  // more than make_short() leaves
  if (std::abs(value) > kLargest) {
    units_ += unit_taken_from(value);
    units_ += unit_taken_from(value);
  }
  value = add_and_return_error(largest_[0], value);
  value = add_and_return_error(largest_[1], value);
  if (value != 0) value = add_and_return_error(largest_[2], value);
  if (value != 0) {
    grow(others_, value);
    if (others_.size() > kMaxOthers) make_short(others_);
  }
  units_ += unit_taken_from(largest_[0]);
}

void UnroundedSum::add_product(double a, double b) {
  const double product = a * b;
  add(product);
  add(std::fma(a, b, -product));
}

void UnroundedSum::add_square(double value) {
  if (std::isinf(value * value))
    is_infinite_ = true;
  else
    add_product(value, value);
}

void UnroundedSum::add(const UnroundedSum& other) {
  const UnroundedSum terms = other;  // it may be this sum
  for (const double term : terms.largest_) add(term);
  for (const double term : terms.others_) add(term);
  units_ += terms.units_;
  is_infinite_ = is_infinite_ || terms.is_infinite_;
}

double UnroundedSum::value() const {
  return is_infinite_ ? kInfinity : total_of(others_, largest_, units_).value();
}

std::vector<double> UnroundedSum::parts() const {
  if (is_infinite_) return {kInfinity};
  Total rest = total_of(others_, largest_, units_);
  if (std::isinf(rest.value())) return rest.beyond_doubles();
  std::vector<double> parts;
  for (double part = rest.value(); part != 0; part = rest.value()) parts.push_back(part), rest.add(-part);
  return parts;
}

std::optional<UnroundedSum> UnroundedSum::from_parts(std::span<const double> parts) {
  UnroundedSum sum;
  std::size_t first = 0;
  if (!parts.empty() && std::isinf(parts[0])) {
    sum.is_infinite_ = parts.size() == 1;
    constexpr double kMostUnits = 0x1p53;
    if (parts.size() > 1 && !(std::abs(parts[1]) <= kMostUnits)) return {};
    if (parts.size() > 1) sum.units_ = static_cast<std::int64_t>(parts[1]);
    first = std::min<std::size_t>(2, parts.size());
  }
  for (const double part : parts.subspan(first)) {
    if (!std::isfinite(part)) return {};
    sum.add(part);
  }
  const std::vector<double> canonical = sum.parts();
  if (!std::equal(canonical.begin(), canonical.end(), parts.begin(), parts.end())) return {};
  return sum;
}

namespace {

constexpr int kDroppedBits = 47;  // number of the bits, of the 52 of the mantissa
constexpr std::int32_t kLastBucket = 0x7ff << 5;

}  // namespace

std::int32_t QuantileSketch::bucket_of(double value) {
  if (value == 0) return 0;
  const auto bits = std::bit_cast<std::uint64_t>(std::abs(value));
  const auto bucket = static_cast<std::int32_t>(bits >> kDroppedBits) + 1;
  return value > 0 ? bucket : -bucket;
}

double QuantileSketch::middle_of(std::int32_t bucket) {
  if (bucket == 0) return 0;
  const auto first = static_cast<std::uint64_t>(std::abs(bucket) - 1) << kDroppedBits;
  const auto middle = std::bit_cast<double>(first | std::uint64_t{1} << (kDroppedBits - 1));
  return bucket > 0 ? middle : -middle;
}

void QuantileSketch::add(double value) {
  const std::int32_t bucket = bucket_of(value);
  const auto at = std::lower_bound(buckets_.begin(), buckets_.end(), bucket);
  const auto i = at - buckets_.begin();
  if (at == buckets_.end() || *at != bucket) {
    buckets_.insert(at, bucket);
    counts_.insert(counts_.begin() + i, 0);
  }
  ++counts_[static_cast<std::size_t>(i)];
}

void QuantileSketch::add(const QuantileSketch& other) {
  QuantileSketch both;
  std::size_t i = 0, j = 0;
  while (i < buckets_.size() || j < other.buckets_.size()) {
    const bool here = j == other.buckets_.size() || (i < buckets_.size() && buckets_[i] <= other.buckets_[j]);
    const bool there =
        i == buckets_.size() || (j < other.buckets_.size() && other.buckets_[j] <= buckets_[i]);
    both.buckets_.push_back(here ? buckets_[i] : other.buckets_[j]);
    both.counts_.push_back((here ? counts_[i++] : 0) + (there ? other.counts_[j++] : 0));
  }
  *this = std::move(both);
}

std::int64_t QuantileSketch::count() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0});
}

std::int32_t QuantileSketch::bucket_at(double p) const {
  const double rank = std::max(1.0, std::ceil(p * static_cast<double>(count())));
  std::int64_t below = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    below += counts_[i];
    if (static_cast<double>(below) >= rank) return buckets_[i];
  }
  return buckets_.empty() ? 0 : buckets_.back();
}

double QuantileSketch::quantile(double p) const {
  return buckets_.empty() ? std::numeric_limits<double>::quiet_NaN() : middle_of(bucket_at(p));
}

std::vector<std::pair<std::int32_t, std::int64_t>> QuantileSketch::pairs() const {
  std::vector<std::pair<std::int32_t, std::int64_t>> pairs;
  pairs.reserve(buckets_.size());
  for (std::size_t i = 0; i < buckets_.size(); ++i) pairs.emplace_back(buckets_[i], counts_[i]);
  return pairs;
}

std::optional<QuantileSketch> QuantileSketch::from_pairs(
    const std::vector<std::pair<std::int32_t, std::int64_t>>& pairs) {
  QuantileSketch sketch;
  std::int64_t total = 0;
  for (const auto& [bucket, count] : pairs) {
    if (bucket < -kLastBucket || bucket > kLastBucket || count < 1) return {};
    if (!sketch.buckets_.empty() && bucket <= sketch.buckets_.back()) return {};
    if (__builtin_add_overflow(total, count, &total)) return {};
    sketch.buckets_.push_back(bucket);
    sketch.counts_.push_back(count);
  }
  return sketch;
}

namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void MeasureTally::add(double value) {
  if (!std::isfinite(value)) {
    ++(std::isnan(value) ? unknown : infinite);
    return;
  }
  value += 0.0;  // -0 becomes 0: the order would decide which of both is the least value
  ++values;
  least = std::min(least, value), greatest = std::max(greatest, value);
  sum.add(value);
  squares.add_square(value);
  sketch.add(value);
}

void MeasureTally::add(const MeasureTally& other) {
  values += other.values, unknown += other.unknown, infinite += other.infinite;
  least = std::min(least, other.least), greatest = std::max(greatest, other.greatest);
  sum.add(other.sum);
  squares.add(other.squares);
  sketch.add(other.sketch);
}

double MeasureTally::mean() const {
  return values == 0 ? kNoNumber : sum.value() / static_cast<double>(values);
}

// The parts are scaled by a power of two, so that the largest value is about 1: no product overflows. What is
// lost of parts below 2^-1022 then does not matter.
double MeasureTally::variance() const {
  if (values < 2 || std::isinf(sum.value()) || std::isinf(squares.value())) return kNoNumber;
  const double largest = std::max(std::abs(least), std::abs(greatest));
  if (largest == 0) return 0;
  const int power = std::ilogb(largest);
  const auto n = static_cast<double>(values);
  std::vector<double> scaled = sum.parts();
  for (double& part : scaled) part = std::ldexp(part, -power);
  UnroundedSum numerator;
  for (const double part : squares.parts()) numerator.add_product(n, std::ldexp(part, -2 * power));
  for (const double a : scaled)
    for (const double b : scaled) numerator.add_product(-a, b);
  return std::ldexp(std::max(0.0, numerator.value()) / (n * (n - 1)), 2 * power);
}

double MeasureTally::standard_deviation() const {
  return std::sqrt(variance());
}

double MeasureTally::quantile(double p) const {
  if (values == 0) return kNoNumber;
  if (p * static_cast<double>(values) <= 1) return least;
  if (std::ceil(p * static_cast<double>(values)) >= static_cast<double>(values)) return greatest;
  return std::clamp(sketch.quantile(p), least, greatest);
}

std::string MeasureTally::contradiction() const {
  if (values < 0 || unknown < 0 || infinite < 0) return "a count is negative";
  if (sketch.count() != values) return "the sketch has another number of values";
  const auto pairs = sketch.pairs();
  if (values == 0) {
    MeasureTally empty;
    empty.unknown = unknown, empty.infinite = infinite;
    return *this == empty ? "" : "there is a sum without values";
  }
  if (!(least <= greatest) || std::isinf(least) || std::isinf(greatest)) return "the extremes are no range";
  if (QuantileSketch::bucket_of(least) != pairs.front().first ||
      QuantileSketch::bucket_of(greatest) != pairs.back().first)
    return "the extremes are outside the sketch";
  return "";
}

namespace {

void count_note(NoteTally& note, std::int64_t runs, std::uint64_t first) {
  if (runs == 0) return;
  note.first = note.runs == 0 ? first : std::min(note.first, first);
  note.runs += runs;
}

bool is_increasing(const std::vector<std::uint64_t>& numbers) {
  return std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) == numbers.end();
}

}  // namespace

void CellTally::add_done(const TallyLayout& layout, std::uint64_t run, std::span<const double> values,
                         std::uint64_t note_bits) {
  ++done;
  for (std::size_t i = 0; i < measures.size(); ++i) measures[i].add(values[i]);
  for (std::size_t kind = 0; kind < notes.size(); ++kind) count_note(notes[kind], note_bits >> kind & 1, run);
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (!(values[layout.events[i]] > 0.5)) continue;
    events[i].insert(std::upper_bound(events[i].begin(), events[i].end(), run), run);
  }
}

void CellTally::add_failed(std::uint64_t run, const std::string& error) {
  if (failed == 0 || run < first_failed) first_failed = run, first_error = error;
  ++failed;
}

void CellTally::add(const CellTally& other) {
  done += other.done;
  if (other.failed > 0) add_failed(other.first_failed, other.first_error), failed += other.failed - 1;
  for (std::size_t i = 0; i < measures.size(); ++i) measures[i].add(other.measures[i]);
  for (std::size_t kind = 0; kind < notes.size(); ++kind)
    count_note(notes[kind], other.notes[kind].runs, other.notes[kind].first);
  for (std::size_t i = 0; i < events.size(); ++i) {
    std::vector<std::uint64_t> both;
    std::merge(events[i].begin(), events[i].end(), other.events[i].begin(), other.events[i].end(),
               std::back_inserter(both));
    events[i] = std::move(both);
  }
}

std::string CellTally::contradiction() const {
  if (done < 0 || failed < 0) return "a count is negative";
  if (failed == 0 && (first_failed != 0 || !first_error.empty()))
    return "no run failed, but there is an error";
  for (const MeasureTally& measure : measures) {
    if (measure.values + measure.unknown + measure.infinite != done)
      return "a measure has another number of runs";
    if (std::string wrong = measure.contradiction(); !wrong.empty()) return wrong;
  }
  for (const NoteTally& note : notes)
    if (note.runs < 0 || note.runs > done || (note.runs == 0 && note.first != 0))
      return "a note has a wrong number of runs";
  for (const auto& runs : events)
    if (static_cast<std::int64_t>(runs.size()) > done || !is_increasing(runs))
      return "the runs of an event are not increasing";
  return "";
}

}  // namespace remote_touch
