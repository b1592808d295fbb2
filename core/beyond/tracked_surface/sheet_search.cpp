#include "core/beyond/tracked_surface/sheet_search.h"

#include <algorithm>
#include <utility>

#include "core/numeric/counting_sort.h"

namespace remote_touch {

void SheetSearch::reserve(std::size_t points, bool with_radius, bool with_stiffness) {
  for (Columns* c : {&added_, &sorted_}) {
    c->x.grow(points, count_), c->y.grow(points, count_), c->z.grow(points, count_);
    c->index.grow(points, count_);
    if (with_radius) c->radius.grow(points, frame_ && has_fixture_radius() ? count_ : 0);
    if (with_stiffness) c->stiffness.grow(points, frame_ && has_stiffness() ? count_ : 0);
  }
  cell_of_.grow(points);
}

void SheetSearch::start(const PatchRegion& region, std::shared_ptr<const NeighbourSearch> frame,
                        std::shared_ptr<GatheredPoints> buffer) {
  region_ = region;
  frame_ = std::move(frame), buffer_ = std::move(buffer);
  count_ = 0;
}

int SheetSearch::cell_along(double coordinate) const {
  const double cell = (coordinate + region_.radius) * (kCells / (2 * region_.radius));
  return static_cast<int>(std::clamp(cell, 0.0, kCells - 1.0));
}

void SheetSearch::add(const PatchPlace& place, const GatheredPoints& gathered, std::size_t row) {
  const Vec3 p_W = region_.frame.world(place);
  const PointsView all = gathered.view();
  added_.x[count_] = p_W.x(), added_.y[count_] = p_W.y(), added_.z[count_] = p_W.z();
  added_.index[count_] = gathered.index()[row];
  if (all.radius) added_.radius[count_] = all.radius[row];
  if (all.stiffness) added_.stiffness[count_] = all.stiffness[row];
  cell_of_[count_++] = static_cast<std::uint32_t>(cell_along(place.v) * kCells + cell_along(place.u));
}

void SheetSearch::finish() {
  decltype(start_) next;
  const auto place = [this](std::size_t i, std::uint32_t to) {
    sorted_.x[to] = added_.x[i], sorted_.y[to] = added_.y[i], sorted_.z[to] = added_.z[i];
    sorted_.index[to] = added_.index[i];
    if (has_fixture_radius()) sorted_.radius[to] = added_.radius[i];
    if (has_stiffness()) sorted_.stiffness[to] = added_.stiffness[i];
  };
  sort_by_cell(
      count_, start_, next, [this](std::size_t i) { return cell_of_[i]; }, place);
}

void SheetSearch::gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const {
  if (!ball.centre.allFinite()) return;
  const Ball wide{ball.centre, ball.radius + max_fixture_radius_m()};
  // Points are sorted by their rounded positions, so the reach has a margin.
  const PatchPlace c = region_.frame.place(ball.centre);
  const double reach = wide.radius / region_.frame.unit_m() + 0x1p-10;
  const int first = cell_along(c.u - reach), last = cell_along(c.u + reach);
  for (int row = cell_along(c.v - reach); row <= cell_along(c.v + reach); ++row) {
    const std::uint32_t begin = start_[static_cast<std::size_t>(row * kCells + first)],
                        end = start_[static_cast<std::size_t>(row * kCells + last + 1)];
    if (begin == end) continue;
    out.add({sorted_.x.data() + begin, sorted_.y.data() + begin, sorted_.z.data() + begin,
             has_fixture_radius() ? sorted_.radius.data() + begin : nullptr,
             has_stiffness() ? sorted_.stiffness.data() + begin : nullptr, sorted_.index.data() + begin, 0,
             end - begin},
            ball, kernels);
  }
  if (region_.holds(wide)) return;
  buffer_->clear();
  frame_->gather(ball, kernels, *buffer_);
  buffer_->finish();
  const PointsView all = buffer_->view();
  for (std::size_t i = 0; i < buffer_->size(); ++i) {
    if (region_.holds(region_.frame.place(Vec3(all.x[i], all.y[i], all.z[i])))) continue;
    out.add({all.x + i, all.y + i, all.z + i, has_fixture_radius() ? all.radius + i : nullptr,
             has_stiffness() ? all.stiffness + i : nullptr, buffer_->index() + i, 0, 1},
            ball, kernels);
  }
}

}  // namespace remote_touch
