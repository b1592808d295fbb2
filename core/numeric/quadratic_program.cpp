#include "core/numeric/quadratic_program.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numeric/active_rows.h"

namespace remote_touch {

namespace {

constexpr int kLanes = 8;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kMax = 1e150;         // its square is finite
constexpr double kInfeasible = 5e-13;  // smaller violations may be rounding errors of rows that nearly agree

// Violations in two lanes. distance: the violation; row: the number of the first row of the pair that it came
// from.
struct PairOfRows {
  Pair distance = both(-kInfinite), row = both(0);
};
PairOfRows worse(const PairOfRows& a, const PairOfRows& b) {
  const auto is_larger = a.distance > b.distance;
  return {is_larger ? a.distance : b.distance, is_larger ? a.row : b.row};
}

}  // namespace

template <int N>
QuadraticProgram<N>::QuadraticProgram(int capacity)
    : capacity_(capacity),
      stride_((capacity + kLanes - 1) / kLanes * kLanes),
      rows_(static_cast<std::size_t>(stride_ * N)),
      bounds_(static_cast<std::size_t>(stride_), -kInfinite),
      lengths_(static_cast<std::size_t>(stride_), 1) {}

template <int N>
void QuadraticProgram<N>::clear() {
  std::fill_n(bounds_.begin(), count_, -kInfinite);
  count_ = 0;
}

template <int N>
bool QuadraticProgram<N>::add(const Vector& row, double bound) {
  if (count_ == capacity_ || !row.allFinite() || !std::isfinite(bound)) return false;
  const auto i = static_cast<std::size_t>(count_++);
  const double max = row.cwiseAbs().maxCoeff();
  Vector scaled = row;
  double scale = 1;
  if (!(max > 1e-150 && max < kMax) && max > 0) {  // its square would vanish or overflow
    scale = max;
    scaled /= scale, bound /= scale;
  }
  const double length = max > 0 ? scaled.norm() : 1;
  for (int k = 0; k < N; ++k) rows_[i + static_cast<std::size_t>(k * stride_)] = scaled[k] / length;
  bounds_[i] = max > 0 ? bound / length : bound > 0 ? kInfinite : -kInfinite;
  lengths_[i] = scale * length;
  return true;
}

namespace {

// Adds the squares in the order in which Eigen adds them.
template <int kFirst, int kCount>
Pair sum_of_squares(const Pair* terms) {
  if constexpr (kCount == 1)
    return terms[kFirst] * terms[kFirst];
  else
    return sum_of_squares<kFirst, kCount / 2>(terms) +
           sum_of_squares<kFirst + kCount / 2, kCount - kCount / 2>(terms);
}

}  // namespace

// Reads, checks and scales the rows in pairs.
template <int N>
bool QuadraticProgram<N>::add_all(const double* const (&column)[N], const double* bounds, int count) {
  if (count > capacity_ - count_ || count_ % 2 != 0) return false;
  const auto is_usual = [](Pair a, Pair min, Pair max) { return (a > min) & (a < max); };
  auto usual = both(0) == both(0);
  for (int i = 0; i < count; i += 2) {
    Pair row[N], max = both(0);
    for (int k = 0; k < N; ++k) {
      row[k] = pair_at(column[k] + i);
      max = row[k] > max ? row[k] : max;
      max = -row[k] > max ? -row[k] : max;
    }
    const Pair squared = sum_of_squares<0, N>(row), length = root(squared), bound = pair_at(bounds + i);
    auto fine = is_usual(max, both(1e-150), both(kMax)) & (squared < both(kInfinite)) &
                is_usual(bound, both(-kInfinite), both(kInfinite));
    if (i + 1 == count) fine[1] = -1;
    usual &= fine;
    double* place = rows_.data() + count_ + i;
    for (int k = 0; k < N; ++k) put(row[k] / length, i + 1 < count, place + k * stride_);
    put(bound / length, i + 1 < count, bounds_.data() + count_ + i);
    put(length, i + 1 < count, lengths_.data() + count_ + i);
  }
  if (usual[0] == 0 || usual[1] == 0) {
    std::fill_n(bounds_.begin() + count_, count, -kInfinite);
    return false;
  }
  count_ += count;
  return true;
}

// Padding rows have the bound minus infinity, so they are never violated.
template <int N>
typename QuadraticProgram<N>::Violation QuadraticProgram<N>::max_violation(const double* y) const {
  Pair y_twice[N];
  for (int k = 0; k < N; ++k) y_twice[k] = both(y[k]);
  PairOfRows worst[kLanes / 2];
  for (int first = 0; first < count_; first += kLanes)
    for (int p = 0; p < kLanes / 2; ++p) {
      const int row = first + 2 * p;
      Pair distance = pair_at(bounds_.data() + row);
      for (int k = 0; k < N; ++k) distance -= pair_at(rows_.data() + k * stride_ + row) * y_twice[k];
      worst[p] = worse({distance, both(row)}, worst[p]);
    }
  const PairOfRows last = worse(worse(worst[0], worst[1]), worse(worst[2], worst[3]));
  const int lane = last.distance[0] > last.distance[1] ? 0 : 1;
  return {last.distance[lane], static_cast<int>(last.row[lane]) + lane};
}

template <int N>
ProgramResult<N> QuadraticProgram<N>::nearest(const Vector& target) const {
  ProgramResult<N> result;
  result.status = ProgramStatus::stalled;
  if (!target.allFinite() || target.cwiseAbs().maxCoeff() > kMax) return result;
  const auto unit_row = [this](int i) {
    Packed<N> row;
    for (int k = 0; k < N; ++k) row.set(k, rows_[static_cast<std::size_t>(k * stride_ + i)]);
    return row;
  };
  const auto bound = [this](int i) { return bounds_[static_cast<std::size_t>(i)]; };
  Packed<N> start;
  for (int k = 0; k < N; ++k) start.set(k, target[k]);
  Packed<N> y = start;
  ActiveRows<N> held;
  const double start_scale = start.max_abs();
  double min = 0;  // violations up to this value are due to rounding
  bool settled = false;
  const int max = 8 * (N + count_);
  while (result.iterations++ < max) {
    double plain[2 * Packed<N>::kPairs];
    std::memcpy(plain, y.pair, sizeof plain);
    const Violation worst = max_violation(plain);
    const double scale = std::max(start_scale, y.max_abs());
    if (worst.distance <= std::max(min, kRounding * scale)) {
      result.status = ProgramStatus::optimal;
      Packed<N> distance;
      for (int j = 0; j < held.count; ++j)
        distance.set(j, bound(held.number[j]) - unit_row(held.number[j]).dot(y));
      if (settled || distance.max_abs() <= kRounding * scale) break;
      held.settle(distance, start, y);
      settled = true;
      continue;
    }
    settled = false;
    const int before = held.count;
    if (held.activate(worst.row, unit_row(worst.row), bound(worst.row), y)) continue;
    if (held.count == before && worst.distance <= kInfeasible * scale) {
      min = worst.distance;
      continue;
    }
    result.status = ProgramStatus::infeasible;
    break;
  }
  for (int k = 0; k < N; ++k) result.y[k] = y[k];
  if (!result.y.allFinite()) return {ProgramStatus::stalled};
  result.active_count = held.count;
  for (int j = 0; j < held.count; ++j) {
    result.active[j] = held.number[j];
    result.multiplier[j] = held.multiplier[j] / lengths_[static_cast<std::size_t>(held.number[j])];
  }
  return result;
}

template class QuadraticProgram<6>;
template class QuadraticProgram<7>;

}  // namespace remote_touch
