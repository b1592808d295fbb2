// The exact sum of doubles, which does not depend on the order of the terms.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace remote_touch {

// The sum is kept as a short list of doubles; added exactly they give the sum. Adding a double changes the
// list without a rounding. Source: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast
// robust geometric predicates", Discrete & Computational Geometry 18 (1997), theorem 10. Most sums fit into
// three doubles, which are added to from the largest down. Only what these cannot hold goes to a list like
// Shewchuk's. Sums above 2^1022 are exact, too: whole multiples of 2^1023 are counted apart.
class UnroundedSum {
 public:
  // pre: the value is finite.
  void add(double value);
  // Adds the square of a finite value: its rounded square and, by std::fma, the rest. This is exact if value
  // is 0 or |value| is at least 2^-485 (1e-146). The square of a smaller value is rounded to a multiple of
  // 2^-1074, the least double. If the rounded square is infinite, |value| >= 2^512 (1.34e154), the sum
  // becomes infinite and remains so. In both cases the result depends on the values alone, not on their
  // order.
  void add_square(double value);
  // Adds a product of finite values. Exact if it is 0, or at least 2^-968 in magnitude; else it is rounded as
  // a square is. pre: the rounded product is finite.
  void add_product(double a, double b);
  void add(const UnroundedSum& other);

  // Returns the sum, correctly rounded to nearest (even), so infinity if it is above the largest double. The
  // sum of nothing is +0.
  double value() const;
  // True after the square of a value was too large.
  bool is_infinite() const { return is_infinite_; }

  // Returns value(), then the rounded rest, and so on until nothing is left; empty if the sum is 0. Equal
  // sums have equal parts, and the exact sum of the parts is the sum. At most 42. If value() is infinite, the
  // parts are: that infinity; a whole number u; and the parts of the sum minus u 2^1023, which is in
  // (-2^1022, 2^1022]. They are infinity alone if is_infinite().
  std::vector<double> parts() const;
  // Returns nothing unless the numbers are what parts() returns for some sum.
  static std::optional<UnroundedSum> from_parts(std::span<const double> parts);

  bool operator==(const UnroundedSum& other) const { return parts() == other.parts(); }

 private:
  std::array<double, 3> largest_{};  // their exact sum counts; they may overlap
  std::vector<double> others_;  // the rest that largest_ cannot hold: nonoverlapping, by increasing magnitude
  std::int64_t units_ = 0;      // multiples of 2^1023
  bool is_infinite_ = false;
};

}  // namespace remote_touch
