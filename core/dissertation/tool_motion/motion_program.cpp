#include "core/dissertation/tool_motion/motion_program.h"

#include <emmintrin.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace remote_touch {
namespace {

// Small vectors and square matrices, stored in pairs of doubles for SSE2. The bits are the same from every
// compiler and on every x86-64 machine, and the speed is about twice that of scalar code.

using Pair [[gnu::vector_size(16)]] = double;
inline Pair pair_at(const double* p) {
  Pair pair;
  std::memcpy(&pair, p, sizeof pair);
  return pair;
}
// Writes both numbers, or only the first.
inline void put(Pair pair, bool two, double* p) {
  std::memcpy(p, &pair, two ? sizeof pair : sizeof(double));
}
inline Pair root(Pair pair) {
  return _mm_sqrt_pd(pair);
}
inline Pair both(double value) {
  return Pair{value, value};
}

// A vector of N numbers in pairs. If N is odd, the second half of the last pair is zero.
template <int N>
struct Packed {
  static constexpr int kPairs = (N + 1) / 2;
  Pair pair[kPairs] = {};

  double operator[](int i) const { return pair[i / 2][i % 2]; }
  void set(int i, double value) { pair[i / 2][i % 2] = value; }
  void add(double factor, const Packed& other) {
    for (int p = 0; p < kPairs; ++p) pair[p] += both(factor) * other.pair[p];
  }
  double dot(const Packed& other) const {
    Pair sum = pair[0] * other.pair[0];
    for (int p = 1; p < kPairs; ++p) sum += pair[p] * other.pair[p];
    return sum[0] + sum[1];
  }
  double max_abs() const {
    double result = 0;
    for (int i = 0; i < N; ++i) result = std::max(result, std::abs((*this)[i]));
    return result;
  }
};

template <int N>
struct Square {
  Packed<N> column[N];

  Packed<N> times(const Packed<N>& x) const {
    Packed<N> sum;
    for (int j = 0; j < N; ++j) sum.add(x[j], column[j]);
    return sum;
  }
  Packed<N> transposed_times(const Packed<N>& x) const {
    Packed<N> result;
    for (int j = 0; j < N; ++j) result.set(j, column[j].dot(x));
    return result;
  }
  // Reflects all rows (multiplication from the right) in the hyperplane normal to v; factor is 2 / |v|^2.
  void reflect(const Packed<N>& v, double factor) {
    const Packed<N> along = times(v);
    for (int j = 0; j < N; ++j) column[j].add(-factor * v[j], along);
  }
};

// The active rows, which are the rows that the solution of a quadratic program fulfils with equality, and
// their changes: the inner part of the method of Goldfarb and Idnani (1983).

// The rounding error of row . y, for a row of unit length and coordinates of y up to 1.
constexpr double kRowRounding = 1e-14;
// A row counts as a linear combination of other rows if the squared length of its component normal to them is
// at most this value.
constexpr double kParallelSquared = 1e-16;

// The active rows as the columns of a matrix q R: q is orthonormal, and R is stored as its inverse. The
// columns beyond count are zero, so that all products run over N columns and need no branches.
template <int N>
struct ActiveRows {
  int count = 0;
  int number[N] = {};
  double multiplier[N] = {};
  Square<N> q, inverse;

  // Moves y until it fulfils a row, and makes that row active. The other active rows stay fulfilled with
  // equality, with multipliers of 0 or more. An active row whose multiplier reaches 0 on the way is removed.
  // Returns false if no such y exists.
  bool activate(int row, const Packed<N>& unit_row, double bound, Packed<N>& y) {
    double its_multiplier = 0;
    for (;;) {
      Packed<N> inside = q.transposed_times(unit_row), outside = unit_row;
      outside.add(-1, q.times(inside));
      if (outside.dot(outside) < 0.5) {  // large cancellation; a second pass is enough (Daniel et al. 1976)
        const Packed<N> more = q.transposed_times(outside);
        inside.add(1, more), outside.add(-1, q.times(more));
      }
      const Packed<N> coefficient = inverse.times(inside);  // coefficients of the active rows in unit_row
      const double squared = outside.dot(outside);
      const bool is_free = squared > kParallelSquared;
      double step = is_free ? std::max(0.0, bound - unit_row.dot(y)) / squared
                            : std::numeric_limits<double>::infinity();
      int leaving = -1;
      for (int j = 0; j < count; ++j)
        if (coefficient[j] > kRowRounding && multiplier[j] < step * coefficient[j])
          step = multiplier[j] / coefficient[j], leaving = j;
      if (!(step < std::numeric_limits<double>::infinity())) return false;
      if (is_free) y.add(step, outside);
      for (int j = 0; j < count; ++j) multiplier[j] = std::max(0.0, multiplier[j] - step * coefficient[j]);
      its_multiplier += step;
      if (leaving < 0) {
        append(row, its_multiplier, outside, coefficient, 1 / std::sqrt(squared));
        return true;
      }
      remove(leaving);
    }
  }

  void append(int row, double its_multiplier, const Packed<N>& outside, const Packed<N>& coefficient,
              double scale) {
    number[count] = row, multiplier[count] = its_multiplier;
    q.column[count].add(scale, outside);
    inverse.column[count].add(-scale, coefficient);
    inverse.column[count].set(count, scale);
    ++count;
  }

  // Removes the active row at `index`. A reflection turns the basis so that its last direction is the
  // one that only this row needs. That direction is dropped, and the last active row moves to the free index.
  void remove(int index) {
    --count;
    Packed<N> v;
    for (int j = 0; j < N; ++j) v.set(j, inverse.column[j][index]);
    const double length = std::sqrt(v.dot(v)), last = v[count];
    v.set(count, last + std::copysign(length, last));
    const double factor = 1 / (length * (length + std::abs(last)));
    q.reflect(v, factor), inverse.reflect(v, factor);
    q.column[count] = inverse.column[count] = {};
    number[index] = number[count], multiplier[index] = multiplier[count];
    for (int j = 0; j < N; ++j) {
      inverse.column[j].set(index, inverse.column[j][count]);
      inverse.column[j].set(count, 0);
    }
  }

  // Corrects y for its distances to the active rows, which are rounding errors of the steps, and computes the
  // multipliers that belong to the corrected y.
  void settle(const Packed<N>& distance, const Packed<N>& target, Packed<N>& y) {
    y.add(1, q.times(inverse.transposed_times(distance)));
    Packed<N> moved = y;
    moved.add(-1, target);
    const Packed<N> exact = inverse.times(q.transposed_times(moved));
    for (int j = 0; j < count; ++j) multiplier[j] = std::max(0.0, exact[j]);
  }
};

constexpr int kRowLanes = 8;
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

// Adds the squares in the order in which Eigen adds them.
template <int kFirst, int kCount>
Pair sum_of_squares(const Pair* terms) {
  if constexpr (kCount == 1)
    return terms[kFirst] * terms[kFirst];
  else
    return sum_of_squares<kFirst, kCount / 2>(terms) +
           sum_of_squares<kFirst + kCount / 2, kCount - kCount / 2>(terms);
}

// The slack s of all rows is kSlackScale z and costs z^2 / 2 + kSlackCost z. Per metre that is far more than
// any contact can gain, because a desired motion is metres long at most. So the slack stays zero if the rows
// are feasible.
constexpr double kSlackScale = 0.01, kSlackCost = 0.1;

}  // namespace

template <int N>
QuadraticProgram<N>::QuadraticProgram(int capacity)
    : capacity_(capacity),
      stride_((capacity + kRowLanes - 1) / kRowLanes * kRowLanes),
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
  PairOfRows worst[kRowLanes / 2];
  for (int first = 0; first < count_; first += kRowLanes)
    for (int p = 0; p < kRowLanes / 2; ++p) {
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
    if (worst.distance <= std::max(min, kRowRounding * scale)) {
      result.status = ProgramStatus::optimal;
      Packed<N> distance;
      for (int j = 0; j < held.count; ++j)
        distance.set(j, bound(held.number[j]) - unit_row(held.number[j]).dot(y));
      if (settled || distance.max_abs() <= kRowRounding * scale) break;
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

MotionProgram::MotionProgram(const ToolParameters& parameters, const VoxelTool& tool)
    : MotionProgram(parameters.motion_metric == MotionMetric::tool
                        ? tool.inertia_m2
                        : even_inertia_m2(parameters.gyration_radius_m)) {}

MotionProgram::MotionProgram(const Eigen::Matrix3d& inertia_m2)
    : rigid_(kMaxContacts), elastic_(kMaxContacts + 1) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(inertia_m2);
  root_ = axes.operatorSqrt();
  inverse_root_ = axes.operatorInverseSqrt();
}

Vector6 MotionProgram::row_of(const ToolContact& contact) const {
  Row row;
  row << contact.n_T, inverse_root_ * contact.r_T.cross(contact.n_T);  // (6.3), a row of J M^(-1/2)
  return row;
}

// Adds all rows at once, with the same operations as row_of() in the same order, so that the bits are the
// same. If that fails, adds the rows one by one and leaves out those that the program rejects.
void MotionProgram::add_rows(std::span<const ToolContact> contacts) {
  rigid_.clear();
  const std::size_t count = contacts.size();
  if (count <= static_cast<std::size_t>(kMaxContacts)) {
    double inverse_root[3][3];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) inverse_root[i][k] = inverse_root_(i, k);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 &r = contacts[i].r_T, &n = contacts[i].n_T;
      const double x = r.y() * n.z() - r.z() * n.y(), y = r.z() * n.x() - r.x() * n.z(),
                   z = r.x() * n.y() - r.y() * n.x();
      for (int k = 0; k < 3; ++k) {
        column_[k][i] = n[k];
        column_[3 + k][i] = inverse_root[k][0] * x + (inverse_root[k][1] * y + inverse_root[k][2] * z);
      }
      depth_m_[i] = contacts[i].depth_m;
      number_[i] = static_cast<int>(i);
    }
    if (rigid_.add_all({column_[0], column_[1], column_[2], column_[3], column_[4], column_[5]}, depth_m_,
                       static_cast<int>(count)))
      return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const int row = rigid_.size();
    if (rigid_.add(row_of(contacts[i]), contacts[i].depth_m)) number_[row] = static_cast<int>(i);
  }
}

ConstrainedMotion MotionProgram::read(const Vector6& y, int active_count, const int* active,
                                      const double* multiplier, std::span<const ToolContact> contacts) const {
  ConstrainedMotion motion;
  motion.a_g << y.head<3>(), inverse_root_ * y.tail<3>();  // back from M^(1/2) a_g
  for (int i = 0; i < active_count; ++i) {
    if (!(multiplier[i] > 0)) continue;
    const ToolContact& contact = contacts[static_cast<std::size_t>(number_[active[i]])];
    ++motion.active_count;
    motion.push_T += multiplier[i] * contact.n_T;
    motion.side += multiplier[i] * contact.side;
  }
  return motion;
}

ConstrainedMotion MotionProgram::solve(const Vector6& desired_T, std::span<const ToolContact> contacts) {
  Vector6 target;
  target << desired_T.head<3>(), root_ * desired_T.tail<3>();  // M^(1/2) a_gu, so that (6.4) is a distance
  add_rows(contacts);                                          // (6.5): J a_g >= d
  const ProgramResult<6> result = rigid_.nearest(target);      // (6.4); (6.7) if a_gu = 0, (6.6)
  if (result.status == ProgramStatus::optimal)
    return read(result.y, result.active_count, result.active, result.multiplier, contacts);

  using Vector7 = Eigen::Matrix<double, 7, 1>;
  elastic_.clear();
  Vector7 row7, target7;
  for (int row = 0; row < rigid_.size(); ++row) {
    const ToolContact& contact = contacts[static_cast<std::size_t>(number_[row])];
    row7 << row_of(contact), kSlackScale;
    elastic_.add(row7, contact.depth_m);
  }
  row7 << Vector6::Zero(), 1;
  elastic_.add(row7, 0);  // the slack is never negative
  target7 << target, -kSlackCost;
  ProgramResult<7> loosened = elastic_.nearest(target7);
  int kept = 0;  // number of active rows, not counting the row of the slack
  for (int i = 0; i < loosened.active_count; ++i) {
    if (loosened.active[i] == rigid_.size()) continue;
    loosened.active[kept] = loosened.active[i], loosened.multiplier[kept++] = loosened.multiplier[i];
  }
  ConstrainedMotion motion = read(loosened.y.head<6>(), kept, loosened.active, loosened.multiplier, contacts);
  motion.is_relaxed = true;
  const bool has_motion = loosened.status == ProgramStatus::optimal && motion.a_g.allFinite();
  if (!has_motion) motion.a_g.setZero();
  motion.failed = !has_motion || result.status == ProgramStatus::stalled;
  return motion;
}

}  // namespace remote_touch
