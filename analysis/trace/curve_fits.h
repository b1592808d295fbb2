// Curves and waves that are fitted to noisy values, and limits: the value on an axis at which an event has a
// given probability.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/interval_estimates.h"

namespace remote_touch {

// Least squares with chosen powers, and its confidence interval.

// Returns the sum of c_k x^power_k. It multiplies instead of calling pow(), whose last bit depends on the C
// library. pre: powers >= 0.
double polynomial(const std::vector<double>& coefficients, const std::vector<int>& powers, double x);

struct PolynomialFit {
  std::vector<int> powers;
  std::vector<double> coefficients;
  std::vector<double> covariance;  // covariance matrix of the coefficients, row by row
  double residual_rms = 0;

  double at(double x) const;
  // Half the width of the 95 % confidence interval of the fitted curve at x.
  double half_width(double x) const;
};

// Fits sum of c_k x^power_k to independent observations. The covariance allows observations of different
// variance (White 1980, HC1). pre: more observations than powers, and enough different x.
PolynomialFit fit_polynomial(const std::vector<double>& x, const std::vector<double>& y,
                             std::vector<int> powers);

// A decreasing curve from noisy values.

// Returns the decreasing values nearest to the given ones by weighted least squares (pool adjacent
// violators). Equal neighbours count as decreasing.
std::vector<double> isotonic_falling(const std::vector<double>& values, const std::vector<double>& weights);

// Returns the x at which a decreasing curve over increasing x crosses the level, by linear interpolation: the
// first x if the curve starts below the level, the last x if it ends above. Where the curve equals the level
// over several x (within 1e-12 of it), this is the middle between the first and the last of them: another
// choice would be wrong for the mirrored curve.
double crossing(const std::vector<double>& x, const std::vector<double>& falling, double level);

// The part of a signal that has a given frequency.
struct Sinusoid {
  double amplitude = 0;
  double phase_rad = 0;  // phi in amplitude * cos(2 pi f t + phi), from -pi to pi
};

// Returns the sinusoid of frequency hz that is nearest to the values by least squares, beside their mean:
// the Fourier coefficient at that frequency. NaN if there are no values. Pre: as many times as values, which
// are evenly spaced and cover whole periods.
Sinusoid sinusoid_in(const std::vector<double>& time_s, const std::vector<double>& values, double hz);

// The value on an axis at which an event has a given probability, and the difference of two such values.

// The curve of an event's probability along an axis.
struct LimitRule {
  double level = 0.5;  // probability of the event at the limit, in (0, 1)
  bool rises = true;   // true: the event becomes more probable along the axis
  // True if runs at different values share no random numbers, so that values may be taken together.
  bool values_are_independent = true;
};

// The runs at one value of the axis. is_fixed: they draw no random number and count as one run, whose outcome
// is certain.
struct RunsAtValue {
  double x = 0;
  EventCounts counts;
  bool is_fixed = false;

  // Returns this value of the axis; if it is fixed, with one run, whose outcome is unknown if that of any run
  // is.
  RunsAtValue of_one_run_if_fixed() const;
};

// Returns the fewest runs n with (1 - level)^n <= 0.025: ceil(ln 0.025 / ln(1 - level)). If none of so many
// runs has the event, its probability is clearly below the level. If all runs have it, the probability is
// clearly above a level if there are as many runs as for 1 - level. pre: 0 < level < 1.
std::int64_t runs_for_level(double level);

enum class LimitPlace : std::int32_t { inside, below_the_first, above_the_last, no_runs, rises_and_falls };

struct Limit {
  // value: the limit; NaN if the curve of the known runs does not cross the level. low, high: values of the
  // axis; an end without evidence is open (NaN), and the note has the reason. clusters: number of runs.
  Estimate estimate;
  LimitPlace place = LimitPlace::no_runs;  // place of the limit by the known runs
};

// Returns the limit. Its value is where the monotone curve that is nearest to the shares of the known runs
// crosses the level, with linear interpolation, moved into [low, high]. The interval consists of values of
// the axis, so that interpolation cannot make it too narrow. On a rising curve `low` is the last value, from
// the low end of the axis on, up to which the probability of the event is clearly below the level, by the
// binomial distribution at 0.025; `high` is its counterpart from the other end. The first value that is not
// clear ends each walk, so there is no correction for several values, and values may share random numbers. A
// value must be clear with the less favourable assignment of its unknown outcomes. A value with too few runs
// takes those of the following values, inwards, if these are independent. A falling curve is a rising curve
// of the event's absence. A curve that clearly crosses the level both ways has a note, and no limit unless
// both walks end. values: by increasing x; those without runs are skipped.
Limit estimated_limit(const std::vector<RunsAtValue>& values, const LimitRule& rule);

// The outcome of an event in a run; missing: there is no such run, or it is not finished.
enum class EventOutcome : std::int8_t { missing, without, event, unknown };

// The runs at one value of the axis, one for each replicate.
struct OutcomesAtValue {
  double x = 0;
  std::vector<EventOutcome> outcomes;
  bool is_fixed = false;

  RunsAtValue runs() const;  // one run if they are fixed
};

enum class LimitComparison { difference, ratio };

// Difference b - a, or ratio b / a, of the limits of two curves over the same replicates. 1999 times,
// replicates are drawn with replacement, the same for all values and both curves, from a fixed key. In each
// draw a limit lies between the last value whose isotonic share is below the level and the first whose share
// is above it, so a draw has a least and a greatest difference. low: the 50th smallest of the least
// differences; high: the 50th largest of the greatest ones. Neither end belongs to the interval. p is that of
// no difference; it is NaN for a ratio, whose p is that of the difference. There is neither interval nor p,
// but a note, with fewer than 6 replicates, if the interval of a limit is open, or if all runs are fixed.
// pre: both have the same number of replicates; for a ratio all x are above 0.
Estimate estimated_limit_comparison(const std::vector<OutcomesAtValue>& a,
                                    const std::vector<OutcomesAtValue>& b, const LimitRule& rule,
                                    LimitComparison comparison);

}  // namespace remote_touch
