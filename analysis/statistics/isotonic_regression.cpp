#include "analysis/statistics/isotonic_regression.h"

#include <cstddef>

namespace remote_touch {

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

}  // namespace remote_touch
