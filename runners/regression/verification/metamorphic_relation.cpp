#include "runners/regression/verification/metamorphic_relation.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <utility>

#include "core/kernels/isa.h"

namespace remote_touch {

namespace {

bool repeat(Variation&) {
  return true;
}

bool other_instructions(Variation& run) {
  const bool oldest = std::string(run.kernels->isa) == kernels_for(Isa::x86_64).isa;
  run.kernels = &kernels_for(oldest ? best_isa() : Isa::x86_64);
  return true;
}

// --- the points ---

// Whether a search by grid takes from the renderer what it has to know.
bool needs_its_images(const Variation& run) {
  return run.view_matters && std::any_of(run.scene.views.begin(), run.scene.views.end(),
                                         [](const CloudView& view) { return view.cloud.image.has_value(); });
}

bool search_all_points(Variation& run) {
  if (needs_its_images(run)) return false;
  search_by_grid(run, 0);
  return true;
}

bool use_other_grid(Variation& run) {
  if (needs_its_images(run)) return false;
  search_by_grid(run, 2.7 * run.scene.cell_m);
  return true;
}

bool shuffle(Variation& run) {
  if (run.order_matters || needs_its_images(run)) return false;
  search_by_grid(run, 0);
  reorder(run, [](int size) {
    std::vector<int> order(static_cast<std::size_t>(size));
    std::iota(order.begin(), order.end(), 0);
    std::mt19937 random(1);  // its numbers are the same everywhere; those of std::shuffle are not
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
    return order;
  });
  return true;
}

bool add_missing(Variation& run) {
  if (run.order_matters || needs_its_images(run)) return false;
  search_by_grid(run, run.scene.cell_m);
  reorder(run, [](int size) {
    std::vector<int> order{-1};
    for (int i = 0; i < size; ++i) {
      order.push_back(i);
      if (i % 7 == 3) order.push_back(-1);
    }
    return order;
  });
  return true;
}

bool add_far(Variation& run) {
  if (needs_its_images(run)) return false;
  constexpr double kSceneRadius_m = 0.5, kReaches = 10;
  const Vec3 middle = run.scene.hip_W.front();
  const double distance = kSceneRadius_m + kReaches * run.reach_m;
  std::vector<Vec3> points;
  for (int i = 0; i < 27; ++i) {
    const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
    if (i != 13) points.push_back(middle + distance * Vec3(x, y, z));
  }
  search_by_grid(run, run.scene.cell_m);
  add_points(run, points);
  return true;
}

bool add_radius_column(Variation& run) {
  for (CloudView& view : run.scene.views) {
    if (!view.cloud.fixture_radius_m.empty()) return false;
    view.cloud.fixture_radius_m.assign(view.cloud.size(), 0);
  }
  return true;
}

// A point whose stiffness is NaN has the renderer's.
bool add_empty_stiffness_column(Variation& run) {
  for (CloudView& view : run.scene.views) {
    if (!view.cloud.stiffness_N_per_m.empty()) return false;
    view.cloud.stiffness_N_per_m.assign(view.cloud.size(), std::numeric_limits<double>::quiet_NaN());
  }
  return true;
}

bool add_stiffness_column(Variation& run) {
  if (!run.stiffness_N_per_m) return false;
  for (CloudView& view : run.scene.views) {
    if (!view.cloud.stiffness_N_per_m.empty()) return false;
    view.cloud.stiffness_N_per_m.assign(view.cloud.size(), *run.stiffness_N_per_m);
  }
  return true;
}

// --- space, time and force ---

template <int kAxis>
bool mirror_axis(Variation& run) {
  if (run.fits_a_sheet) return false;
  mirror(run, kAxis);
  return true;
}

bool move(Variation& run) {
  if (run.fits_a_sheet) return false;
  RigidTransform motion = RigidTransform::Identity();
  motion.linear() = Eigen::Quaterniond(0.6, 0.3, -0.5, 0.4).normalized().toRotationMatrix();
  motion.translation() = Vec3(0.31, -0.42, 0.27);
  move_rigidly(run, motion);
  return true;
}

// Larger at equal stiffness: forces grow with lengths, so N/m and Ns/m stay.
constexpr UnitChange sized(double factor) {
  return {factor, 1, factor};
}

bool enlarge(Variation& run) {
  change_units(run, sized(2));
  return true;
}

bool shrink(Variation& run) {
  change_units(run, sized(0.25));
  return true;
}

bool enlarge_unevenly(Variation& run) {
  change_units(run, sized(3));
  return true;
}

bool speed_up(Variation& run) {
  change_units(run, {1, 0.5, 1});
  return true;
}

bool soften(Variation& run) {
  change_units(run, {1, 1, 0.5});
  return true;
}

bool points_are_stiff(const Variation& run) {
  return !run.scene.views.front().cloud.stiffness_N_per_m.empty();
}

bool change_renderer_only(Variation& run) {
  if (!points_are_stiff(run) || !run.stiffness_N_per_m) return false;
  run.other_stiffness_N_per_m = 0.5 * *run.stiffness_N_per_m;
  return true;
}

bool soften_renderer(Variation& run) {
  return !points_are_stiff(run) && soften(run);
}

bool soften_points(Variation& run) {
  return points_are_stiff(run) && soften(run);
}

bool start_later(Variation& run) {
  constexpr double kLater_s = 1024;
  run.scene.start_s += kLater_s;
  for (CloudView& view : run.scene.views) view.captured_s += kLater_s, view.arrives_s += kLater_s;
  return true;
}

// --- the stream ---

constexpr int kTicksAfter = 16;  // half way to the next view

// The first tick at or after its arrival tells that a view was dropped.
void expect_dropped(Variation& run, const std::vector<std::size_t>& views) {
  for (const std::size_t view : views) {
    std::size_t tick = 0;
    while (tick < run.expected.size() && run.scene.time_s(tick) < run.scene.views[view].arrives_s) ++tick;
    if (tick == run.expected.size()) return;
    run.expected[tick].status = std::max(run.expected[tick].status, RenderStatus::stale_frame_dropped);
  }
}

// A view that must not be used, and shows it: its number and its points are others.
CloudView stale(CloudView view, double captured_s, double shift_m) {
  view.index += 1000;
  view.captured_s = captured_s;
  view.cloud.image.reset();
  for (double& x : view.cloud.x) x += shift_m;
  for (double& y : view.cloud.y) y -= shift_m;
  return view;
}

bool send_twice(Variation& run) {
  const double shift_m = run.reach_m;
  expect_dropped(run, follow_views(run, 0, kTicksAfter, [=](const CloudView& view, const CloudView&) {
                   return stale(view, view.captured_s, shift_m);
                 }));
  return true;
}

bool send_late(Variation& run) {
  const double shift_m = run.reach_m;
  expect_dropped(run,
                 follow_views(run, 1, kTicksAfter, [=](const CloudView& view, const CloudView& previous) {
                   return stale(previous, 0.5 * (previous.captured_s + view.captured_s), shift_m);
                 }));
  return true;
}

// The follower keeps the number: it is the same view, captured again.
void send_more_often(Variation& run, std::size_t first) {
  const double period_s = kTicksAfter / run.scene.haptic_rate_hz;
  follow_views(run, first, kTicksAfter, [=](CloudView view, const CloudView&) {
    view.captured_s += period_s;
    return view;
  });
}

// A step to the side over bumps has a part along the normal, and (4.13) takes that for a motion of the cloud.
bool double_rate(Variation& run) {
  if (run.fits_a_sheet) return false;
  if (!run.scene.cloud_rests || run.scene.hip_rests) return false;
  send_more_often(run, 0);
  run.until_velocity = true;
  return true;
}

bool double_rate_at_rest(Variation& run) {
  if (run.fits_a_sheet) return false;
  if (!run.scene.cloud_rests || !run.scene.hip_rests) return false;
  send_more_often(run, 1);
  return true;
}

// --- the table ---

constexpr OutputTolerance kExact;
// Rounding moves a coordinate of 1 m by 1e-16 m. On a crest small differences grow until the proxy has left
// it, by 1e5 with fixed steps; 1e8 is allowed. What is left is 1/2000 of the contact region of Table 4.2, the
// smallest length of the method. A force of 10 N is a spring of 1e-2 m; a normal turns by a position's error
// over r_c; a velocity is positions over a frame's 1/32 s.
constexpr OutputTolerance kRounded{1e-8, 1e-5, 1e-6, 1e-5, true};
constexpr OutputTolerance kRoundedThreefold{3e-8, 1e-5, 3e-6, 1e-5, true};
// k_s psi is rounded to 1e-7 N/m a point, (5.8).
constexpr OutputTolerance kRoundedForce{0, 1e-6, 0, 0, false};
// Below this an estimate is the rounding of the proxy's last step over a frame's time.
constexpr OutputTolerance kRestsEvenSo{1e-12, 1e-9, 1e-12, 1e-9, true};

constexpr const char* kSameSum = "the same numbers in the same sums: equal bits";
constexpr const char* kPowerOfTwo = "factors are powers of two, so no product rounds anew: equal bits";
constexpr const char* kRounding =
    "coordinates round to 1e-16 m; differences may grow 1e8 times, to 1/2000 of the contact region";

const MetamorphicRelation kRelations[] = {
    {"repeat", "a second renderer answers the same", kExact, kSameSum, repeat},
    {"instruction-set", "the kernels of another x86-64 level answer the same", kExact, kSameSum,
     other_instructions},
    {"search-all", "looking at every point finds what a search finds", kExact, kSameSum, search_all_points},
    {"search-grid", "another grid finds the same", kExact, kSameSum, use_other_grid},
    {"order", "the order of the points does not matter", kExact, "sums do not depend on order: equal bits",
     shuffle},
    {"missing-points", "points without a measurement change nothing", kExact, kSameSum, add_missing},
    {"far-points", "points beyond ten times the largest length change nothing", kExact, kSameSum, add_far},
    {"zero-regions", "forbidden regions of radius 0 are none", kExact, kSameSum, add_radius_column},
    {"own-stiffness", "points as stiff as the renderer are points without a stiffness", kRoundedForce,
     "a mean of stiffnesses rounds to a fixed grid", add_stiffness_column},
    {"no-own-stiffness", "points with a column of stiffness and nothing in it are as stiff as the renderer",
     kRoundedForce, "a mean of stiffnesses rounds to a fixed grid", add_empty_stiffness_column},
    {"renderer-stiffness", "where all points have a stiffness the renderer's does not matter", kExact,
     kSameSum, change_renderer_only},
    {"mirror-x", "a world with left and right exchanged is felt so: x to -x", kExact,
     "signs do not round: equal bits", mirror_axis<0>},
    {"mirror-y", "y to -y", kExact, "signs do not round: equal bits", mirror_axis<1>},
    {"mirror-z", "z to -z", kExact, "signs do not round: equal bits", mirror_axis<2>},
    {"rigid-motion", "a scene that is turned and moved is felt turned and moved", kRounded, kRounding, move},
    {"size-2", "all lengths twice as large at equal stiffness: so are positions and forces", kExact,
     kPowerOfTwo, enlarge},
    {"size-1/4", "a quarter as large", kExact, kPowerOfTwo, shrink},
    {"size-3", "three times as large", kRoundedThreefold, kRounding, enlarge_unevenly},
    {"speed-2", "all twice as fast: positions and forces stay", kExact, kPowerOfTwo, speed_up},
    {"force-1/2", "half the stiffness and damping: half the force", kExact, kPowerOfTwo, soften_renderer},
    {"force-1/2-points", "the same with points half as stiff", kRoundedForce,
     "a mean of stiffnesses rounds to a fixed grid", soften_points},
    {"clock", "a clock that is 1024 s ahead changes nothing", kExact,
     "all times are multiples of 1/1024 s: equal bits", start_later},
    {"sent-twice", "a frame with the time of the newest is dropped: only the status tells", kExact, kSameSum,
     send_twice},
    {"sent-late", "a frame older than the newest is dropped: only the status tells", kExact, kSameSum,
     send_late},
    {"frame-rate", "a cloud at rest may be sent twice as often, until a velocity is estimated", kExact,
     kSameSum, double_rate},
    {"frame-rate-held", "a cloud at rest under a HIP at rest may be sent twice as often", kRestsEvenSo,
     "the velocity estimate takes the last step's rounding for a motion", double_rate_at_rest},
};

}  // namespace

std::span<const MetamorphicRelation> metamorphic_relations() {
  return kRelations;
}

}  // namespace remote_touch
