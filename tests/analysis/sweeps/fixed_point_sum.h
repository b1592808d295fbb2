// Exact sums in fixed point, by other means than UnroundedSum: one long integer in units of 2^-2148, which
// holds every double and the square of every double.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace remote_touch {

class FixedPointSum {
 public:
  void add(double value) {
    int power = 0;
    const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &power), 53));
    add_shifted(mantissa, power - 53 + kUnit);
  }
  void add_square(double value) { add_product(value, value); }
  void add_product(double a, double b) {
    int power_of_a = 0, power_of_b = 0;
    const auto x = static_cast<std::int64_t>(std::ldexp(std::frexp(a, &power_of_a), 53));
    const auto y = static_cast<std::int64_t>(std::ldexp(std::frexp(b, &power_of_b), 53));
    add_shifted(static_cast<__int128>(x) * y, power_of_a + power_of_b - 106 + kUnit);
  }
  void add(const FixedPointSum& other, std::int64_t times) {
    for (std::size_t i = 0; i < digits_.size(); ++i) digits_[i] += times * other.digits_[i];
    carry();
  }

  bool operator==(const FixedPointSum&) const = default;

  // The nearest double, even if two are as near.
  double rounded() const {
    FixedPointSum magnitude = *this;
    const bool is_negative = digits_.back() < 0;
    if (is_negative) magnitude = FixedPointSum(), magnitude.add(*this, -1);
    int top = static_cast<int>(32 * kDigits) - 1;
    while (top >= 0 && !magnitude.bit(top)) --top;
    // The last bit that the double has: 53 bits from the top, or 2^-1074.
    const int last = std::max(top - 52, kUnit - 1074);
    std::uint64_t mantissa = 0;
    for (int i = top; i >= last; --i) mantissa = 2 * mantissa + (magnitude.bit(i) ? 1 : 0);
    bool is_above_half = false;
    for (int i = last - 2; i >= 0 && !is_above_half; --i) is_above_half = magnitude.bit(i);
    if (magnitude.bit(last - 1) && (is_above_half || mantissa % 2 == 1)) ++mantissa;
    const double size = std::ldexp(static_cast<double>(mantissa), last - kUnit);
    return is_negative ? -size : size;
  }

 private:
  static constexpr int kUnit = 2148;
  static constexpr std::size_t kDigits =
      140;  // digits of 32 bits: 2^-2148 to 2^2331; the last one has the sign

  // Adds number 2^shift. A number below the unit is a multiple of it after all.
  void add_shifted(__int128 number, int shift) {
    while (shift < 0) number /= 2, ++shift;
    const bool is_negative = number < 0;
    auto left = static_cast<unsigned __int128>(is_negative ? -number : number);
    const auto first = static_cast<std::size_t>(shift / 32);
    auto low = static_cast<std::uint64_t>(left & 0xffffffffu) << (shift % 32);
    for (std::size_t i = first; left != 0 || low != 0; ++i) {
      const auto digit = static_cast<std::int64_t>(low & 0xffffffffu);
      digits_.at(i) += is_negative ? -digit : digit;
      left >>= 32;
      low = (low >> 32) + (static_cast<std::uint64_t>(left & 0xffffffffu) << (shift % 32));
    }
    carry();
  }
  // All digits but the last become 0 .. 2^32 - 1.
  void carry() {
    for (std::size_t i = 0; i + 1 < digits_.size(); ++i) {
      const std::int64_t over = digits_[i] >> 32;
      digits_[i] -= over * (std::int64_t{1} << 32);
      digits_[i + 1] += over;
    }
  }
  bool bit(int i) const { return i >= 0 && (digits_[static_cast<std::size_t>(i / 32)] >> (i % 32) & 1) != 0; }
  std::array<std::int64_t, kDigits> digits_{};
};

}  // namespace remote_touch
