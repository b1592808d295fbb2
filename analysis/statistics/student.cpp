#include "analysis/statistics/student.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/statistics/mean.h"

namespace remote_touch {

namespace {

// Hall's transformation of t, which increases with the mean whatever the skewness is.
double hall_t(const Moments& m) {
  const double sd = std::sqrt(m.variance), u = m.mean / sd, skewness = m.third / (m.variance * sd);
  const double y = skewness * u;
  return std::sqrt(m.count) * (u * (1 + y / 3 + y * y / 27) + skewness / (6 * m.count));
}

constexpr double kMostDegrees =
    1e5;  // with more, the critical value differs from the normal one by 1e-5 at most

}  // namespace

double student_two_sided(double t, int degrees) {
  const double angle = std::atan(std::abs(t) / std::sqrt(static_cast<double>(degrees)));
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const bool is_odd = degrees % 2 == 1;
  double term = is_odd ? cosine : 1, sum = degrees == 1 ? 0 : term;
  for (int k = is_odd ? 3 : 2; k <= degrees - 2; k += 2) term *= cosine * cosine * (k - 1) / k, sum += term;
  const double within = is_odd ? 2 / std::numbers::pi * (angle + sine * sum) : sine * sum;
  return std::max(1 - within, 0.0);
}

double student_quantile(double probability, int degrees) {
  double low = 0, high = 1;
  while (high < 1e12 && student_two_sided(high, degrees) > probability) high *= 2;
  for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high))
    (student_two_sided(middle, degrees) > probability ? low : high) = middle;
  return high;
}

MeanDifference student_mean(const std::vector<std::vector<double>>& groups,
                            const std::vector<bool>& without_scatter) {
  std::vector<Moments> moments;
  for (const std::vector<double>& group : groups) moments.push_back(moments_of(group));
  return student_mean_of_moments(moments, without_scatter);
}

MeanDifference student_mean_of_moments(const std::vector<Moments>& groups,
                                       const std::vector<bool>& without_scatter) {
  std::vector<double> lone;
  std::vector<Moments> all_groups(1);  // the first is that of the lone numbers
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const bool is_lone = groups[i].count == 1 && !(i < without_scatter.size() && without_scatter[i]);
    if (is_lone)
      lone.push_back(groups[i].mean);
    else
      all_groups.push_back(groups[i]);
  }
  all_groups.front() = moments_of(lone);
  double all = 0, sum = 0, scatter = 0, squares = 0;
  bool has_scatter = false;
  for (const Moments& m : all_groups) {
    if (m.count == 0) continue;
    all += m.count, sum += m.count * m.mean;
    if (m.count < 2) continue;
    const double part = m.count * m.variance;
    scatter += part, squares += part * part / (m.count - 1), has_scatter = true;
  }
  const auto pairs = static_cast<std::int64_t>(all);
  if (!has_scatter) return mean_of_sum(sum, pairs);
  const int degrees =
      scatter > 0 ? static_cast<int>(std::clamp(scatter * scatter / squares, 1.0, kMostDegrees)) : 1;
  return mean_of_sum(sum, pairs,
                     scatter > 0 ? student_quantile(0.05, degrees) * std::sqrt(scatter) / all : 0);
}

double mean_test(const std::vector<double>& differences) {
  const Moments m = moments_of(differences);
  if (m.count < 2 || m.mean == 0) return 1;
  const double least = std::exp2(1 - m.count);
  if (!(m.variance > 0)) return least;
  const int degrees = static_cast<int>(m.count) - 1;
  const double t = m.mean * std::sqrt(m.count / m.variance), corrected = hall_t(m);
  if (!(t * corrected > 0)) return 1;
  return std::max(least, student_two_sided(std::min(std::abs(t), std::abs(corrected)), degrees));
}

}  // namespace remote_touch
