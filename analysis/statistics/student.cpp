#include "analysis/statistics/student.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "analysis/statistics/mean.h"

namespace remote_touch {

namespace {

// The critical value of more degrees differs from the normal one by 1e-5 at most.
constexpr double kMostDegrees = 1e5;
constexpr double kHallNumbers = 6, kHallDegrees = 5;  // the fewest for Hall's correction

// Returns the strata with one that has all numbers which are alone in theirs, the first; fixed ones have no
// scatter and count once.
std::vector<Moments> strata_with_scatter(const std::vector<StratumMoments>& strata) {
  std::vector<double> lone;
  std::vector<Moments> all(1);
  for (const StratumMoments& s : strata) {
    if (s.moments.count == 0) continue;
    if (s.is_fixed)
      all.push_back({1, s.moments.mean, 0, 0});
    else if (s.moments.count == 1)
      lone.push_back(s.moments.mean);
    else
      all.push_back(s.moments);
  }
  all.front() = moments_of(lone);
  return all;
}

// Returns the power of 2 below the largest deviation; 1 if nothing scatters. Its square and cube neither
// overflow nor vanish beside those of the deviations, and dividing by it rounds nothing.
double scale_of(const std::vector<Moments>& strata) {
  double most = 0;
  for (const Moments& m : strata) most = std::max(most, std::sqrt(m.variance));
  return most > 0 && std::isfinite(most) ? std::exp2(std::ilogb(most)) : 1;
}

// The mean of strata, its scatter, and what follows from them.
struct PooledMoments {
  double count = 0, sum = 0;
  double scale, scatter = 0, squares = 0, cubes = 0;  // sums over the deviations in units of `scale`

  explicit PooledMoments(const std::vector<Moments>& strata) : scale(scale_of(strata)) {
    for (const Moments& m : strata) {
      count += m.count, sum += m.count * m.mean;
      if (m.count < 2) continue;
      const double part = m.count * (m.variance / scale / scale);
      scatter += part, squares += part * part / (m.count - 1);
      cubes += m.count * (m.third / scale / scale / scale);
    }
  }
  double standard_error() const { return scale * std::sqrt(scatter) / count; }
  double degrees() const {
    // A whole number may be missed by a rounding.
    return std::floor(std::clamp(scatter * scatter / squares * (1 + 1e-12), 1.0, kMostDegrees));
  }
  double skewness() const { return cubes / (scatter * std::sqrt(scatter)); }
};

// Hall's transformation: the t of a mean whose skewness is g.
double hall(double y, double g) {
  if (std::abs(g) < 1e-9) return y;
  return 3 / g * (std::cbrt(1 + g * (y - g / 6)) - 1);
}

}  // namespace

double student_two_sided(double t, double degrees) {
  if (std::isinf(t)) return 0;
  return 2 * boost::math::cdf(complement(boost::math::students_t(degrees), std::abs(t)));
}

double student_quantile(double probability, double degrees) {
  return boost::math::quantile(complement(boost::math::students_t(degrees), probability / 2));
}

Estimate estimated_mean(const std::vector<StratumMoments>& strata, bool has_third) {
  const PooledMoments all(strata_with_scatter(strata));
  Estimate e;
  bool are_fixed = true;
  for (const StratumMoments& s : strata) {
    e.unknown += s.unknown;
    are_fixed &= s.is_fixed || s.moments.count == 0;
  }
  e.clusters = static_cast<std::int64_t>(all.count);
  if (all.count == 0) return e;
  e.value = all.sum / all.count;
  if (are_fixed) e.method = kExactMethod;
  if (are_fixed) return e;
  const bool has_scatter = all.scatter > 0 && std::isfinite(all.scatter);
  if (!has_scatter) e.add_note(all.count > 1 ? "no scatter" : "one run");
  if (!has_scatter) return e;
  const double se = all.standard_error(), d = all.degrees(), t = student_quantile(0.05, d);
  e.low = e.value - t * se, e.high = e.value + t * se, e.method = "Student's t";
  if (all.count < kHallNumbers) e.add_note("assumes a normal distribution");
  if (all.count < kHallNumbers || d < kHallDegrees) return e;
  if (!has_third) e.add_note("no correction for a skewed distribution: needs all runs");
  if (!has_third) return e;
  const double g = all.skewness();
  e.low = std::min(e.low, e.value - se * hall(t, g));
  e.high = std::max(e.high, e.value - se * hall(-t, g));
  e.method = "Student's t, Hall";
  return e;
}

Estimate estimated_mean(const std::vector<Stratum>& strata) {
  std::vector<StratumMoments> moments;
  for (const Stratum& s : strata) {
    StratumMoments& m = moments.emplace_back(StratumMoments{moments_of(s.numbers), s.is_fixed});
    m.unknown = static_cast<std::int64_t>(s.numbers.size()) - static_cast<std::int64_t>(m.moments.count);
  }
  return estimated_mean(moments, true);
}

Estimate estimated_mean(const std::vector<double>& numbers) {
  return estimated_mean(std::vector<Stratum>{{numbers}});
}

}  // namespace remote_touch
