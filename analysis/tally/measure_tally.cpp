#include "analysis/tally/measure_tally.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

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

}  // namespace remote_touch
