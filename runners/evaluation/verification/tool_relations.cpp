#include "runners/evaluation/verification/metamorphic_relation.h"
#include "runners/evaluation/verification/relation_variations.h"

namespace remote_touch {

namespace {

constexpr OutputTolerance kSameTool;
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

constexpr const char* kSameNumbers = "the same numbers in the same order: equal bits";
constexpr const char* kFactors = "factors are powers of two, so multiplication does not round: equal bits";
constexpr const char* kVoxel = "a tick may end in any pose within half a voxel of the nearest";
constexpr const char* kRest = "a tick may end in any pose within 0.1 mm of the nearest";

const MetamorphicRelation kToolRelations[] = {
    {"repeat", "a second renderer gives the same output", kSameTool, kSameNumbers, vary::repeat},
    {"instruction-set", "the kernels of another x86-64 level give the same output", kSameTool, kSameNumbers,
     vary::other_instructions},
    {"search-all", "a query of every point gives the same result as the search", kSameTool, kSameNumbers,
     vary::search_all_points},
    {"order", "the order of the points does not matter", kSameTool,
     "points are sorted by position: equal bits", vary::shuffle},
    {"missing-points", "points without a measurement change nothing", kSameTool, kSameNumbers,
     vary::add_missing},
    {"far-points", "points beyond ten times the largest length change nothing", kSolved, kVoxel,
     vary::add_far},
    {"zero-regions", "forbidden regions of radius 0 change nothing", kSameTool, kSameNumbers,
     vary::add_radius_column},
    {"mirror-x", "a scene with left and right exchanged is rendered exchanged: x to -x", kSolved, kVoxel,
     vary::mirror<0>},
    {"mirror-y", "y to -y", kSolved, kVoxel, vary::mirror<1>},
    {"mirror-z", "z to -z", kSolved, kVoxel, vary::mirror<2>},
    {"rigid-motion", "a scene that is turned and moved is rendered turned and moved", kSolved, kVoxel,
     vary::move},
    {"size-2", "all lengths twice as large at equal stiffness: positions and forces are twice as large",
     kSolvedTwice, kVoxel, vary::resize<2>},
    {"size-1/2", "half as large", kSolvedHalf, kVoxel, vary::resize<1, 2>},
    {"speed-2", "everything twice as fast: positions and forces are the same", kSameTool, kFactors,
     vary::speed_up},
    {"force-1/2", "half the stiffness and damping: half the force", kSameTool, kFactors,
     vary::soften_renderer},
    {"clock", "a clock that is 1024 s ahead changes nothing", kSameTool,
     "all times are multiples of 1/1024 s: equal bits", vary::start_later},
    {"sent-twice", "a frame with the time of the newest is dropped: only the status reports it", kSameTool,
     kSameNumbers, vary::send_twice},
    {"sent-late", "a frame older than the newest is dropped: only the status reports it", kSameTool,
     kSameNumbers, vary::send_late},
    {"frame-rate", "a cloud at rest may be sent twice as often, until a velocity is estimated", kSamePlaces,
     kRest, vary::double_rate},
    {"frame-rate-held", "a cloud at rest under a HIP at rest may be sent twice as often", kSamePlaces, kRest,
     vary::double_rate_at_rest},
};

}  // namespace

std::span<const MetamorphicRelation> tool_relations() {
  return kToolRelations;
}

}  // namespace remote_touch
