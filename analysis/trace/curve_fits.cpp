#include "analysis/trace/curve_fits.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "analysis/trace/interval_estimates.h"
#include "core/parameters/parameter.h"
#include "core/points/noise.h"

namespace remote_touch {
namespace {

double power(double x, int exponent) {
  double product = 1;
  for (int i = 0; i < exponent; ++i) product *= x;
  return product;
}

Eigen::VectorXd terms(double x, const std::vector<int>& powers) {
  Eigen::VectorXd row(static_cast<Eigen::Index>(powers.size()));
  for (std::size_t k = 0; k < powers.size(); ++k) row[static_cast<Eigen::Index>(k)] = power(x, powers[k]);
  return row;
}

constexpr double kLimitTail = 0.025;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Events of a rising curve: those of the absence if the event's own curve falls.
RunsAtValue rising(RunsAtValue value, bool rises) {
  if (!rises) std::swap(value.counts.events, value.counts.without);
  return value;
}

// The end of a rising curve at which a walk begins.
enum class End { low, high };

// True if the probability of the event is clearly below (End::low) or above (End::high) the level.
bool is_clear(const EventCounts& c, double level, End end, double tail = kLimitTail) {
  const auto n = static_cast<double>(c.runs());
  if (end == End::low)
    return probability_of_at_most(static_cast<double>(c.events + c.unknown), n, level) <= tail;
  return probability_of_at_least(static_cast<double>(c.events), n, level) <= tail;
}

// The same for the one run of a fixed value.
bool is_certain(const EventCounts& c, End end) {
  return (end == End::low ? c.events : c.without) + c.unknown == 0;
}

// True if the curve clearly crosses the level both ways: at some value it is clearly on one side, at a later
// one on the other, and back. All values are asked, so each has its share of the tail.
bool rises_and_falls(const std::vector<RunsAtValue>& values, double level) {
  const double tail = kLimitTail / static_cast<double>(values.size());
  bool was_low = false, was_high = false, rises = false, falls = false;
  for (const RunsAtValue& v : values) {
    const auto is = [&](End end) {
      return v.is_fixed ? is_certain(v.counts, end) : is_clear(v.counts, level, end, tail);
    };
    const bool is_low = is(End::low), is_high = is(End::high);
    rises |= is_high && was_low, falls |= is_low && was_high;
    was_low |= is_low, was_high |= is_high;
  }
  return rises && falls;
}

// A walk over values in the order from one end.
class Walk {
 public:
  Walk(std::vector<RunsAtValue> values, double level, End end, bool are_independent)
      : values_(std::move(values)),
        level_(level),
        end_(end),
        needed_(runs_for_level(end == End::low ? level : 1 - level)),
        borrows_(are_independent) {}

  // Returns the last value that is clear; NaN if the first is not.
  double last_clear() const {
    double last = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < values_.size() && is_clear_at(i); ++i) last = values_[i].x;
    return last;
  }
  std::int64_t needed() const { return needed_; }
  // True if the first value has too few runs of its own to be clear.
  bool lacks_runs() const {
    return !values_.empty() && !values_.front().is_fixed && values_.front().counts.runs() < needed_;
  }

 private:
  bool is_clear_at(std::size_t i) const {
    EventCounts counts = values_[i].counts;
    if (values_[i].is_fixed) return is_certain(counts, end_);
    for (std::size_t next = i + 1; borrows_ && next < values_.size() && counts.runs() < needed_; ++next)
      counts.add(values_[next].counts);
    return counts.runs() >= needed_ && is_clear(counts, level_, end_);
  }

  std::vector<RunsAtValue> values_;
  double level_;
  End end_;
  std::int64_t needed_;
  bool borrows_;
};

// Returns why an end of an interval is open: "5 % needs 72 runs at one value".
std::string reason_of(const Walk& walk, const LimitRule& rule, const char* end) {
  if (!walk.lacks_runs()) return formatted("not clear at the %s value", end);
  return formatted("%.4g %% needs %lld runs", 100 * rule.level, static_cast<long long>(walk.needed()));
}

// Sets value and place from the known runs.
void set_crossing(const std::vector<RunsAtValue>& values, double level, Limit& limit) {
  std::vector<double> x, negative, weights;  // a rising share is a falling share with the other sign
  for (const RunsAtValue& v : values) {
    const auto known = static_cast<double>(v.counts.known());
    if (known == 0) continue;
    x.push_back(v.x), weights.push_back(known);
    negative.push_back(-static_cast<double>(v.counts.events) / known);
  }
  if (x.empty()) return;
  const std::vector<double> falling = isotonic_falling(negative, weights);
  constexpr double kEqual = 1e-12;
  limit.place = falling.front() < -level - kEqual  ? LimitPlace::below_the_first
                : falling.back() > -level + kEqual ? LimitPlace::above_the_last
                                                   : LimitPlace::inside;
  if (limit.place == LimitPlace::inside) limit.estimate.value = crossing(x, falling, -level);
}

constexpr int kDraws = 1999;
constexpr std::size_t kEnd = 50;  // rank of the ends among the draws: 0.025 (kDraws + 1)

// Returns the number of times that each replicate is in a draw. The streams of simulations encode their
// purpose in the upper bits of the first word of the counter. Here all of its bits are set, which no stream
// of a simulation has.
std::vector<double> drawn_weights(std::size_t replicates, int draw) {
  const NoiseStream stream{{0x6c696d69u, 0x74u}, {0xFFFFFFFFu, static_cast<std::uint32_t>(draw), 0}};
  std::vector<double> weights(replicates, 0);
  std::array<double, 4> words{};
  for (std::size_t i = 0; i < replicates; ++i) {
    if (i % 4 == 0) words = uniforms(stream, static_cast<std::uint32_t>(i / 4));
    const double place = words[i % 4] * static_cast<double>(replicates);
    weights[std::min(replicates - 1, static_cast<std::size_t>(place))] += 1;
  }
  return weights;
}

// The values between which a limit lies: the last with a share below the level, or `least`, and the first
// with one above it, or infinity.
struct Bracket {
  double below, above;
};

Bracket bracket_of(const std::vector<OutcomesAtValue>& curve, const std::vector<double>& drawn,
                   const LimitRule& rule, double least) {
  constexpr double kEqual = 1e-12;
  const double level = rule.rises ? rule.level : 1 - rule.level;
  // Each end takes the unknown outcomes in its less favourable way.
  std::vector<double> x, most, fewest, weights;
  for (const OutcomesAtValue& value : curve) {
    double runs = 0, events = 0, unknown = 0;
    for (std::size_t r = 0; r < drawn.size(); ++r) {
      const EventOutcome outcome = value.outcomes[r];
      if (outcome == EventOutcome::missing) continue;
      runs += drawn[r];
      unknown += outcome == EventOutcome::unknown ? drawn[r] : 0;
      events += outcome == (rule.rises ? EventOutcome::event : EventOutcome::without) ? drawn[r] : 0;
    }
    if (runs == 0) continue;
    x.push_back(value.x), weights.push_back(runs);
    most.push_back(-(events + unknown) / runs), fewest.push_back(-events / runs);
  }
  Bracket bracket{least, kInfinity};
  if (x.empty()) return bracket;
  const std::vector<double> high = isotonic_falling(most, weights), low = isotonic_falling(fewest, weights);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (high[i] > -level + kEqual) bracket.below = x[i];
  for (std::size_t i = x.size(); i-- > 0;)
    if (low[i] < -level - kEqual) bracket.above = x[i];
  return bracket;
}

Limit limit_of(const std::vector<OutcomesAtValue>& curve, const LimitRule& rule) {
  std::vector<RunsAtValue> runs;
  for (const OutcomesAtValue& value : curve) runs.push_back(value.runs());
  return estimated_limit(runs, rule);
}

// Returns the number of replicates that have a run in both curves.
std::int64_t replicates_of(const std::vector<OutcomesAtValue>& a, const std::vector<OutcomesAtValue>& b) {
  const auto has_run = [](const std::vector<OutcomesAtValue>& curve, std::size_t replicate) {
    return std::ranges::any_of(curve, [&](const OutcomesAtValue& value) {
      return value.outcomes[replicate] != EventOutcome::missing;
    });
  };
  std::int64_t count = 0;
  for (std::size_t r = 0; !a.empty() && r < a.front().outcomes.size(); ++r)
    count += has_run(a, r) && has_run(b, r) ? 1 : 0;
  return count;
}

bool are_fixed(const std::vector<OutcomesAtValue>& curve) {
  return std::ranges::all_of(curve, [](const OutcomesAtValue& v) { return v.is_fixed; });
}

}  // namespace

double polynomial(const std::vector<double>& coefficients, const std::vector<int>& powers, double x) {
  double sum = 0;
  for (std::size_t k = 0; k < powers.size(); ++k) sum += coefficients[k] * power(x, powers[k]);
  return sum;
}

double PolynomialFit::at(double x) const {
  return polynomial(coefficients, powers, x);
}

double PolynomialFit::half_width(double x) const {
  const auto size = static_cast<Eigen::Index>(powers.size());
  const Eigen::Map<const Eigen::MatrixXd> spread(covariance.data(), size, size);
  const Eigen::VectorXd row = terms(x, powers);
  return kTwoSided95 * std::sqrt(std::max(0.0, row.dot(spread * row)));
}

// The fit is computed in units of the largest x, because powers of small numbers differ by many orders.
PolynomialFit fit_polynomial(const std::vector<double>& x, const std::vector<double>& y,
                             std::vector<int> powers) {
  const auto rows = static_cast<Eigen::Index>(x.size()), columns = static_cast<Eigen::Index>(powers.size());
  double scale = 0;
  for (const double value : x) scale = std::max(scale, std::abs(value));
  Eigen::MatrixXd design(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    design.row(i) = terms(x[static_cast<std::size_t>(i)] / scale, powers);
  const Eigen::Map<const Eigen::VectorXd> observed(y.data(), rows);
  const Eigen::VectorXd scaled = design.colPivHouseholderQr().solve(observed);
  const Eigen::VectorXd residual = observed - design * scaled;

  const Eigen::MatrixXd inverse = (design.transpose() * design).inverse();
  const Eigen::MatrixXd scatter =
      design.transpose() * residual.array().square().matrix().asDiagonal() * design;
  const double correction = static_cast<double>(rows) / static_cast<double>(rows - columns);
  Eigen::MatrixXd spread = correction * inverse * scatter * inverse;
  PolynomialFit fit;
  for (Eigen::Index k = 0; k < columns; ++k) {
    const double unit = 1 / power(scale, powers[static_cast<std::size_t>(k)]);
    fit.coefficients.push_back(scaled[k] * unit);
    spread.row(k) *= unit, spread.col(k) *= unit;
  }
  fit.covariance.assign(spread.data(), spread.data() + spread.size());
  fit.residual_rms = std::sqrt(residual.squaredNorm() / static_cast<double>(rows));
  fit.powers = std::move(powers);
  return fit;
}

std::vector<double> isotonic_falling(const std::vector<double>& values, const std::vector<double>& weights) {
  struct Pool {
    double mean, weight;
    std::size_t count;
  };
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < values.size(); ++i) {
    pools.push_back({values[i], weights[i], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean < pools.back().mean) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& joined = pools.back();
      const double weight = joined.weight + last.weight;
      joined = {(joined.mean * joined.weight + last.mean * last.weight) / weight, weight,
                joined.count + last.count};
    }
  }
  std::vector<double> falling;
  for (const Pool& pool : pools) falling.insert(falling.end(), pool.count, pool.mean);
  return falling;
}

double crossing(const std::vector<double>& x, const std::vector<double>& falling, double level) {
  constexpr double kEqual = 1e-12;  // a pooled share may miss the level by a rounding
  std::size_t above = 0, not_below = 0;
  for (const double value : falling) {
    above += value > level + kEqual ? 1 : 0;
    not_below += value >= level - kEqual ? 1 : 0;
  }
  if (not_below > above) return 0.5 * (x[above] + x[not_below - 1]);
  if (above == 0) return x.front();
  if (above == x.size()) return x.back();
  const double from = falling[above - 1], to = falling[above];
  return x[above - 1] + (x[above] - x[above - 1]) * (from - level) / (from - to);
}

Sinusoid sinusoid_in(const std::vector<double>& time_s, const std::vector<double>& values, double hz) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {kNaN, kNaN};
  double with_cosine = 0, with_sine = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double angle_rad = 2 * std::numbers::pi * hz * time_s[i];
    with_cosine += values[i] * std::cos(angle_rad);
    with_sine += values[i] * std::sin(angle_rad);
  }
  const double half_count = 0.5 * static_cast<double>(values.size());
  return {std::hypot(with_cosine, with_sine) / half_count, std::atan2(-with_sine, with_cosine)};
}

std::int64_t runs_for_level(double level) {
  const double runs = std::ceil(std::log(kLimitTail) / std::log1p(-level) - 1e-12);
  return static_cast<std::int64_t>(std::min(runs, 1e18));  // far beyond the runs of any sweep
}

RunsAtValue RunsAtValue::of_one_run_if_fixed() const {
  if (!is_fixed || counts.runs() == 0) return *this;
  return {x,
          counts.unknown > 0  ? EventCounts{0, 0, 1}
          : counts.events > 0 ? EventCounts{1}
                              : EventCounts{0, 1},
          true};
}

Limit estimated_limit(const std::vector<RunsAtValue>& values, const LimitRule& rule) {
  const double level = rule.rises ? rule.level : 1 - rule.level;
  std::vector<RunsAtValue> used;
  Limit limit;
  Estimate& e = limit.estimate;
  for (const RunsAtValue& value : values) {
    if (value.counts.runs() == 0) continue;
    used.push_back(rising(value.of_one_run_if_fixed(), rule.rises));
    e.clusters += used.back().counts.runs(), e.unknown += used.back().counts.unknown;
  }
  if (used.empty()) return limit;
  set_crossing(used, level, limit);
  const Walk up(used, level, End::low, rule.values_are_independent);
  std::ranges::reverse(used);
  const Walk down(used, level, End::high, rule.values_are_independent);
  e.low = up.last_clear(), e.high = down.last_clear();
  const bool are_fixed = std::ranges::all_of(used, [](const RunsAtValue& value) { return value.is_fixed; });
  e.method = are_fixed ? kExactMethod : "binomial walks";
  if (std::isnan(e.low)) e.add_note("low: " + reason_of(up, rule, "first"));
  if (std::isnan(e.high)) e.add_note("high: " + reason_of(down, rule, "last"));
  if (!std::isnan(e.low)) e.value = e.value < e.low ? e.low : e.value;
  if (!std::isnan(e.high)) e.value = e.value > e.high ? e.high : e.value;
  if (rises_and_falls(used, level)) {
    e.add_note("the curve rises and falls");
    if (std::isnan(e.low + e.high)) {
      e.value = e.low = e.high = std::numeric_limits<double>::quiet_NaN();
      limit.place = LimitPlace::rises_and_falls;
    }
  }
  return limit;
}

RunsAtValue OutcomesAtValue::runs() const {
  RunsAtValue value{x, {}, is_fixed};
  for (const EventOutcome outcome : outcomes) {
    value.counts.events += outcome == EventOutcome::event ? 1 : 0;
    value.counts.without += outcome == EventOutcome::without ? 1 : 0;
    value.counts.unknown += outcome == EventOutcome::unknown ? 1 : 0;
  }
  return value.of_one_run_if_fixed();
}

Estimate estimated_limit_comparison(const std::vector<OutcomesAtValue>& a,
                                    const std::vector<OutcomesAtValue>& b, const LimitRule& rule,
                                    LimitComparison comparison) {
  const bool is_ratio = comparison == LimitComparison::ratio;
  const auto compared = [&](double of_b, double of_a) { return is_ratio ? of_b / of_a : of_b - of_a; };
  const Estimate of_a = limit_of(a, rule).estimate, of_b = limit_of(b, rule).estimate;
  Estimate e;
  e.value = compared(of_b.value, of_a.value);
  e.unknown = of_a.unknown + of_b.unknown;
  const char* const open = "the interval of a limit is open";
  if (are_fixed(a) && are_fixed(b)) {
    e.clusters = 1, e.method = kExactMethod;
    e.low = compared(of_b.low, of_a.high), e.high = compared(of_b.high, of_a.low);
    if (std::isnan(e.low + e.high)) e.add_note(open);
    return e;
  }
  e.clusters = replicates_of(a, b);
  if (e.clusters < kLeastPairs) e.add_note("needs 6 replicates");
  if (std::isnan(of_a.low + of_a.high + of_b.low + of_b.high)) e.add_note(open);
  if (!e.note.empty()) return e;
  std::vector<double> least, greatest;
  std::size_t below = 0, above = 0;  // draws whose difference may be below, above 0
  const double start = is_ratio ? 0 : -kInfinity;
  for (int draw = 0; draw < kDraws; ++draw) {
    const std::vector<double> drawn = drawn_weights(a.front().outcomes.size(), draw);
    const Bracket in_a = bracket_of(a, drawn, rule, start), in_b = bracket_of(b, drawn, rule, start);
    least.push_back(compared(in_b.below, in_a.above)), greatest.push_back(compared(in_b.above, in_a.below));
    below += in_b.below < in_a.above ? 1 : 0, above += in_b.above > in_a.below ? 1 : 0;
  }
  std::ranges::sort(least), std::ranges::sort(greatest);
  e.low = least[kEnd - 1], e.high = greatest[greatest.size() - kEnd];
  if (!is_ratio) e.p = std::min(1.0, 2 * (1 + static_cast<double>(std::min(below, above))) / (kDraws + 1));
  e.method = "bootstrap of replicates";
  return e;
}

}  // namespace remote_touch
