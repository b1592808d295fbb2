#include "runners/evaluation/verification/metamorphic_checks.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "core/kernels/kernels.h"

namespace remote_touch {
namespace {

// The variations of a run. Each changes the scene and the expected outputs, and returns false if it does not
// apply to the scene or the renderer.

// True if the renderer needs the images of the clouds, which a search by grid removes.
bool needs_its_images(const Variation& run) {
  return run.contact_model.uses_camera &&
         std::any_of(run.scene.views.begin(), run.scene.views.end(),
                     [](const CloudView& view) { return view.cloud.image.has_value(); });
}

// False if a cloud has the column already.
bool add_column(Variation& run, std::vector<double> PointCloud::*column, double value) {
  for (CloudView& view : run.scene.views) {
    if (!(view.cloud.*column).empty()) return false;
    (view.cloud.*column).assign(view.cloud.size(), value);
  }
  return true;
}

bool soften(Variation& run) {
  change_units(run, {1, 1, 0.5});
  return true;
}

// True for a renderer that measures how the points move from frame to frame, as a sheet does.
bool tracks_frames(const Variation& run) {
  return run.contact_model.depends_on_axes && !run.contact_model.uses_camera;
}

bool points_are_stiff(const Variation& run) {
  return !run.scene.views.front().cloud.stiffness_N_per_m.empty();
}

constexpr int kTicksAfter = 16;  // half way to the next view

// Expects that the first tick at or after the arrival of each of these views reports a dropped frame.
void expect_dropped(Variation& run, const std::vector<std::size_t>& views) {
  for (const std::size_t view : views) {
    std::size_t tick = 0;
    while (tick < run.expected.size() && run.scene.time_s(tick) < run.scene.views[view].arrives_s) ++tick;
    if (tick == run.expected.size()) return;
    run.expected[tick].status = std::max(run.expected[tick].status, RenderStatus::stale_frame_dropped);
  }
}

// Returns a view that must not be used. Its index and its points differ from those of every real view, so
// that its use would change the outputs.
CloudView stale(CloudView view, double captured_s, double shift_m) {
  view.index += 1000;
  view.captured_s = captured_s;
  view.cloud.image.reset();
  for (double& x : view.cloud.x) x += shift_m;
  for (double& y : view.cloud.y) y -= shift_m;
  return view;
}

// Each view is followed by itself, captured again half a period later. It keeps its index, because it is the
// same view.
void send_more_often(Variation& run, std::size_t first) {
  const double period_s = kTicksAfter / run.scene.haptic_rate_hz;
  follow_views(run, first, kTicksAfter, [=](CloudView view, const CloudView&) {
    view.captured_s += period_s;
    return view;
  });
}

bool repeat(Variation&) {
  return true;
}

bool other_instructions(Variation& run) {
  const bool oldest = std::string(run.kernels->isa) == kernels_for(Isa::x86_64).isa;
  run.kernels = &kernels_for(oldest ? best_isa() : Isa::x86_64);
  return true;
}

// --- the points ---

bool search_all_points(Variation& run) {
  if (needs_its_images(run)) return false;
  replace_search(run, 0);
  return true;
}

bool use_other_grid(Variation& run) {
  if (needs_its_images(run)) return false;
  replace_search(run, 2.7 * run.scene.cell_m);
  return true;
}

bool shuffle(Variation& run) {
  if (run.contact_model.depends_on_point_order || needs_its_images(run)) return false;
  replace_search(run, 0);
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
  if (run.contact_model.depends_on_point_order || needs_its_images(run)) return false;
  replace_search(run, run.scene.cell_m);
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
  replace_search(run, run.scene.cell_m);
  add_points(run, points);
  return true;
}

bool add_radius_column(Variation& run) {
  return add_column(run, &PointCloud::fixture_radius_m, 0);
}

// A point whose stiffness is NaN has the stiffness of the renderer.
bool add_empty_stiffness_column(Variation& run) {
  return add_column(run, &PointCloud::stiffness_N_per_m, std::numeric_limits<double>::quiet_NaN());
}

bool add_stiffness_column(Variation& run) {
  return run.stiffness_N_per_m && add_column(run, &PointCloud::stiffness_N_per_m, *run.stiffness_N_per_m);
}

// --- space, time and force ---

template <int kAxis>
bool mirror(Variation& run) {
  if (run.contact_model.depends_on_axes || !run.can_be_mirrored) return false;
  mirror(run, kAxis);
  return true;
}

// A method that needs the direction to the sensor can be moved together with its camera.
bool move(Variation& run) {
  if (run.contact_model.depends_on_axes && !needs_its_images(run)) return false;
  RigidTransform motion = RigidTransform::Identity();
  motion.linear() = Eigen::Quaterniond(0.6, 0.3, -0.5, 0.4).normalized().toRotationMatrix();
  motion.translation() = Vec3(0.31, -0.42, 0.27);
  move_rigidly(run, motion);
  return true;
}

// Change of size at equal stiffness: forces grow with lengths, so values in N/m and Ns/m do not change. The
// factor is a fraction.
template <int kNumerator, int kDenominator = 1>
bool resize(Variation& run) {
  constexpr double kFactor = static_cast<double>(kNumerator) / kDenominator;
  change_units(run, {kFactor, 1, kFactor});
  return true;
}

bool speed_up(Variation& run) {
  change_units(run, {1, 0.5, 1});
  return true;
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

// A step to the side over bumps has a component along the normal, which (4.13) interprets as a motion of the
// cloud.
bool double_rate(Variation& run) {
  if (tracks_frames(run)) return false;
  if (!run.scene.cloud_rests || run.scene.hip_rests) return false;
  send_more_often(run, 0);
  run.until_velocity = true;
  return true;
}

bool double_rate_at_rest(Variation& run) {
  if (tracks_frames(run)) return false;
  if (!run.scene.cloud_rests || !run.scene.hip_rests) return false;
  send_more_often(run, 1);
  return true;
}

// --- the relations ---

constexpr OutputTolerance kExact;
// Rounding changes a coordinate of 1 m by 1e-16 m. On a crest, small differences grow until the proxy has
// left it: by 1e5 with fixed steps; 1e8 is allowed. The tolerance of positions is thus 1e-8 m, 1/2000 of the
// contact region of Table 4.2, the smallest length of the method. The other tolerances follow from it with a
// margin: a force of 10 N stretches the spring by 1e-2 m; a normal turns by a position's error over r_c; a
// velocity is a difference of positions over a frame's 1/32 s.
constexpr OutputTolerance kRounded{1e-8, 1e-5, 1e-6, 1e-5, true};
constexpr OutputTolerance kRoundedThreefold{3e-8, 1e-5, 3e-6, 1e-5, true};
// k_s psi is rounded to 1e-7 N/m a point, (5.8).
constexpr OutputTolerance kRoundedForce{0, 1e-6, 0, 0, false};
// A velocity estimate below these tolerances is only the rounding of the proxy's last step, divided by the
// time of a frame.
constexpr OutputTolerance kRestsEvenSo{1e-12, 1e-9, 1e-12, 1e-9, true};

// Returns tolerances for a tool's pose and surface velocity, and for its force and torque as fractions of the
// largest ones.
constexpr OutputTolerance poses_within(double position_m, double rotation_rad, double force_fraction,
                                       double torque_fraction, double velocity_m_per_s = 0.05) {
  return {.position_m = position_m,
          .force_fraction = force_fraction,
          .velocity_m_per_s = velocity_m_per_s,
          .rounded = true,
          .rotation_rad = rotation_rad,
          .torque_fraction = torque_fraction,
          .without_contact_details = true};
}
// A tick ends when the steps become shorter than the rest threshold, or bring the tool no nearer to the
// device. It may leave depths of up to 0.1 mm. The final pose within these limits depends on rounding, on the
// tiles and cubes into which the cloud is divided along the world's axes, and on constant lengths of the
// rules, such as the cells of 4 mm in which contacts are thinned. 0.5 mm is half a voxel of the bar, and
// corresponds to 0.3 N; forces are 4 to 6 N in these scenes. The rotation is what the groove needs: up to
// 0.09 rad were measured there, which move the ends of the bar by 4 mm.
constexpr OutputTolerance kSolved = poses_within(5e-4, 0.1, 0.1, 0.2);
// Tolerance for variations in which the points keep their positions and tiles.
constexpr OutputTolerance kSamePlaces = poses_within(1e-4, 0.02, 0.02, 0.05);
// Tolerances for a bar twice as large, whose lengths are all doubled, and for one half as large, which the
// same 0.5 mm rotate by twice the angle.
constexpr OutputTolerance kSolvedTwice = poses_within(1e-3, 0.1, 0.1, 0.2, 0.1);
constexpr OutputTolerance kSolvedHalf = poses_within(5e-4, 0.2, 0.2, 0.4);

constexpr const char* kSameSum = "the same numbers in the same sums: equal bits";
constexpr const char* kPowerOfTwo = "factors are powers of two, so multiplication does not round: equal bits";
constexpr const char* kRounding =
    "coordinates round to 1e-16 m; differences may grow 1e8 times, to 1/2000 of the contact region";
constexpr const char* kGrid = "a mean of stiffnesses rounds to a fixed grid";
constexpr const char* kSigns = "signs do not round: equal bits";
constexpr const char* kTimes = "all times are multiples of 1/1024 s: equal bits";
constexpr const char* kSameNumbers = "the same numbers in the same order: equal bits";
constexpr const char* kVoxel = "a tick may end in any pose within half a voxel of the nearest";
constexpr const char* kRest = "a tick may end in any pose within 0.1 mm of the nearest";

struct Allowed {
  OutputTolerance tolerance;
  const char* reason;
};

struct Relation {
  const char* name;
  const char* meaning;
  bool (*vary)(Variation& run);
  std::optional<Allowed> for_hip, for_tool;  // none for renderers that it does not check
};

const Relation kRelations[] = {
    {"repeat", "a second renderer gives the same output", repeat, Allowed{kExact, kSameSum},
     Allowed{kExact, kSameNumbers}},
    {"instruction-set", "the kernels of another x86-64 level give the same output", other_instructions,
     Allowed{kExact, kSameSum}, Allowed{kExact, kSameNumbers}},
    {"search-all", "a query of every point gives the same result as the search", search_all_points,
     Allowed{kExact, kSameSum}, Allowed{kExact, kSameNumbers}},
    {"search-grid", "another grid finds the same", use_other_grid, Allowed{kExact, kSameSum}, {}},
    {"order", "the order of the points does not matter", shuffle,
     Allowed{kExact, "sums do not depend on order: equal bits"},
     Allowed{kExact, "points are sorted by position: equal bits"}},
    {"missing-points", "points without a measurement change nothing", add_missing, Allowed{kExact, kSameSum},
     Allowed{kExact, kSameNumbers}},
    {"far-points", "points beyond ten times the largest length change nothing", add_far,
     Allowed{kExact, kSameSum}, Allowed{kSolved, kVoxel}},
    {"zero-regions", "forbidden regions of radius 0 change nothing", add_radius_column,
     Allowed{kExact, kSameSum}, Allowed{kExact, kSameNumbers}},
    {"own-stiffness",
     "points as stiff as the renderer act like points without a stiffness",
     add_stiffness_column,
     Allowed{kRoundedForce, kGrid},
     {}},
    {"no-own-stiffness",
     "points with an empty column of stiffness are as stiff as the renderer",
     add_empty_stiffness_column,
     Allowed{kRoundedForce, kGrid},
     {}},
    {"renderer-stiffness",
     "if all points have a stiffness, the renderer's does not matter",
     change_renderer_only,
     Allowed{kExact, kSameSum},
     {}},
    {"mirror-x", "a scene with left and right exchanged is rendered exchanged: x to -x", mirror<0>,
     Allowed{kExact, kSigns}, Allowed{kSolved, kVoxel}},
    {"mirror-y", "y to -y", mirror<1>, Allowed{kExact, kSigns}, Allowed{kSolved, kVoxel}},
    {"mirror-z", "z to -z", mirror<2>, Allowed{kExact, kSigns}, Allowed{kSolved, kVoxel}},
    {"rigid-motion", "a scene that is turned and moved is rendered turned and moved", move,
     Allowed{kRounded, kRounding}, Allowed{kSolved, kVoxel}},
    {"size-2", "all lengths twice as large at equal stiffness: positions and forces are twice as large",
     resize<2>, Allowed{kExact, kPowerOfTwo}, Allowed{kSolvedTwice, kVoxel}},
    {"size-1/4", "a quarter as large", resize<1, 4>, Allowed{kExact, kPowerOfTwo}, {}},
    {"size-3", "three times as large", resize<3>, Allowed{kRoundedThreefold, kRounding}, {}},
    {"size-1/2", "half as large", resize<1, 2>, {}, Allowed{kSolvedHalf, kVoxel}},
    {"speed-2", "everything twice as fast: positions and forces are the same", speed_up,
     Allowed{kExact, kPowerOfTwo}, Allowed{kExact, kPowerOfTwo}},
    {"force-1/2", "half the stiffness and damping: half the force", soften_renderer,
     Allowed{kExact, kPowerOfTwo}, Allowed{kExact, kPowerOfTwo}},
    {"force-1/2-points",
     "the same with points half as stiff",
     soften_points,
     Allowed{kRoundedForce, kGrid},
     {}},
    {"clock", "a clock that is 1024 s ahead changes nothing", start_later, Allowed{kExact, kTimes},
     Allowed{kExact, kTimes}},
    {"sent-twice", "a frame with the time of the newest is dropped: only the status reports it", send_twice,
     Allowed{kExact, kSameSum}, Allowed{kExact, kSameNumbers}},
    {"sent-late", "a frame older than the newest is dropped: only the status reports it", send_late,
     Allowed{kExact, kSameSum}, Allowed{kExact, kSameNumbers}},
    {"frame-rate", "a cloud at rest may be sent twice as often, until a velocity is estimated", double_rate,
     Allowed{kExact, kSameSum}, Allowed{kSamePlaces, kRest}},
    {"frame-rate-held", "a cloud at rest under a HIP at rest may be sent twice as often", double_rate_at_rest,
     Allowed{kRestsEvenSo, "the velocity estimate treats the last step's rounding as a motion"},
     Allowed{kSamePlaces, kRest}},
};

}  // namespace

std::vector<MetamorphicRelation> relations_of(DegreesOfFreedom degrees_of_freedom) {
  std::vector<MetamorphicRelation> relations;
  for (const Relation& one : kRelations)
    if (const auto& allowed = degrees_of_freedom == DegreesOfFreedom::six ? one.for_tool : one.for_hip)
      relations.push_back({one.name, one.meaning, allowed->tolerance, allowed->reason, one.vary});
  return relations;
}

}  // namespace remote_touch
