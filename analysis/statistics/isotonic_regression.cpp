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
  if (falling.front() < level) return x.front();
  for (std::size_t i = 1; i < x.size(); ++i)
    if (falling[i] < level)
      return x[i - 1] + (x[i] - x[i - 1]) * (falling[i - 1] - level) / (falling[i - 1] - falling[i]);
  return x.back();
}

}  // namespace remote_touch
