#include "runners/evaluation/verification/metamorphic_relation.h"

#include "runners/evaluation/verification/relation_variations.h"

namespace remote_touch {

namespace {

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

constexpr const char* kSameSum = "the same numbers in the same sums: equal bits";
constexpr const char* kPowerOfTwo = "factors are powers of two, so multiplication does not round: equal bits";
constexpr const char* kRounding =
    "coordinates round to 1e-16 m; differences may grow 1e8 times, to 1/2000 of the contact region";

const MetamorphicRelation kRelations[] = {
    {"repeat", "a second renderer gives the same output", kExact, kSameSum, vary::repeat},
    {"instruction-set", "the kernels of another x86-64 level give the same output", kExact, kSameSum,
     vary::other_instructions},
    {"search-all", "a query of every point gives the same result as the search", kExact, kSameSum,
     vary::search_all_points},
    {"search-grid", "another grid finds the same", kExact, kSameSum, vary::use_other_grid},
    {"order", "the order of the points does not matter", kExact, "sums do not depend on order: equal bits",
     vary::shuffle},
    {"missing-points", "points without a measurement change nothing", kExact, kSameSum, vary::add_missing},
    {"far-points", "points beyond ten times the largest length change nothing", kExact, kSameSum,
     vary::add_far},
    {"zero-regions", "forbidden regions of radius 0 change nothing", kExact, kSameSum,
     vary::add_radius_column},
    {"own-stiffness", "points as stiff as the renderer act like points without a stiffness", kRoundedForce,
     "a mean of stiffnesses rounds to a fixed grid", vary::add_stiffness_column},
    {"no-own-stiffness", "points with an empty column of stiffness are as stiff as the renderer",
     kRoundedForce, "a mean of stiffnesses rounds to a fixed grid", vary::add_empty_stiffness_column},
    {"renderer-stiffness", "if all points have a stiffness, the renderer's does not matter", kExact, kSameSum,
     vary::change_renderer_only},
    {"mirror-x", "a scene with left and right exchanged is rendered exchanged: x to -x", kExact,
     "signs do not round: equal bits", vary::mirror<0>},
    {"mirror-y", "y to -y", kExact, "signs do not round: equal bits", vary::mirror<1>},
    {"mirror-z", "z to -z", kExact, "signs do not round: equal bits", vary::mirror<2>},
    {"rigid-motion", "a scene that is turned and moved is rendered turned and moved", kRounded, kRounding,
     vary::move},
    {"size-2", "all lengths twice as large at equal stiffness: positions and forces are twice as large",
     kExact, kPowerOfTwo, vary::resize<2>},
    {"size-1/4", "a quarter as large", kExact, kPowerOfTwo, vary::resize<1, 4>},
    {"size-3", "three times as large", kRoundedThreefold, kRounding, vary::resize<3>},
    {"speed-2", "everything twice as fast: positions and forces are the same", kExact, kPowerOfTwo,
     vary::speed_up},
    {"force-1/2", "half the stiffness and damping: half the force", kExact, kPowerOfTwo,
     vary::soften_renderer},
    {"force-1/2-points", "the same with points half as stiff", kRoundedForce,
     "a mean of stiffnesses rounds to a fixed grid", vary::soften_points},
    {"clock", "a clock that is 1024 s ahead changes nothing", kExact,
     "all times are multiples of 1/1024 s: equal bits", vary::start_later},
    {"sent-twice", "a frame with the time of the newest is dropped: only the status reports it", kExact,
     kSameSum, vary::send_twice},
    {"sent-late", "a frame older than the newest is dropped: only the status reports it", kExact, kSameSum,
     vary::send_late},
    {"frame-rate", "a cloud at rest may be sent twice as often, until a velocity is estimated", kExact,
     kSameSum, vary::double_rate},
    {"frame-rate-held", "a cloud at rest under a HIP at rest may be sent twice as often", kRestsEvenSo,
     "the velocity estimate treats the last step's rounding as a motion", vary::double_rate_at_rest},
};

}  // namespace

std::span<const MetamorphicRelation> metamorphic_relations() {
  return kRelations;
}

}  // namespace remote_touch
