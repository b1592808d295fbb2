#include "analysis/tally/unrounded_sum.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace remote_touch
