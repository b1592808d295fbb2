#include "runners/regression/verification/metamorphic_relation.h"
#include "runners/regression/verification/relation_variations.h"

namespace remote_touch {

namespace {

constexpr OutputTolerance kSameTool;
// A tick ends when steps get shorter than the rest threshold or come no nearer to the device, and leaves
// depths of up to 0.1 mm. Which of the poses within that it ends in depends on rounding, on the tiles and
// cubes into which the cloud is divided along the world's axes, and on lengths of the rules that are
// constants, as the cells of 4 mm in which contacts are thinned. 0.5 mm is half a voxel of the bar; 0.1 rad
// about its long axis moves its edges (10 mm) by 0.5 mm. In the groove it turned by up to 0.09 rad. 0.5 mm is
// a force of 0.3 N, of 4 to 6 N in these scenes.
constexpr OutputTolerance kSolved{.position_m = 5e-4,
                                  .force_fraction = 0.1,
                                  .velocity_m_per_s = 0.05,
                                  .rounded = true,
                                  .rotation_rad = 0.1,
                                  .torque_fraction = 0.2,
                                  .pose_only = true};
// Where the points stay in their places and tiles.
constexpr OutputTolerance kSamePlaces{.position_m = 1e-4,
                                      .force_fraction = 0.02,
                                      .velocity_m_per_s = 0.05,
                                      .rounded = true,
                                      .rotation_rad = 0.02,
                                      .torque_fraction = 0.05,
                                      .pose_only = true};
// A bar twice as large, and half as large: the same 0.5 mm of its edges turns it by twice as much.
constexpr OutputTolerance kSolvedTwice{.position_m = 1e-3,
                                       .force_fraction = 0.1,
                                       .velocity_m_per_s = 0.1,
                                       .rounded = true,
                                       .rotation_rad = 0.1,
                                       .torque_fraction = 0.2,
                                       .pose_only = true};
constexpr OutputTolerance kSolvedHalf{.position_m = 5e-4,
                                      .force_fraction = 0.2,
                                      .velocity_m_per_s = 0.05,
                                      .rounded = true,
                                      .rotation_rad = 0.2,
                                      .torque_fraction = 0.4,
                                      .pose_only = true};

constexpr const char* kSameNumbers = "the same numbers in the same order: equal bits";
constexpr const char* kFactors = "factors are powers of two, so no product rounds anew: equal bits";
constexpr const char* kVoxel = "a tick may end in any pose within half a voxel of the nearest";
constexpr const char* kRest = "a tick may end in any pose within 0.1 mm of the nearest";

const MetamorphicRelation kToolRelations[] = {
    {"repeat", "a second renderer answers the same", kSameTool, kSameNumbers, vary::repeat},
    {"instruction-set", "the kernels of another x86-64 level answer the same", kSameTool, kSameNumbers,
     vary::other_instructions},
    {"search-all", "looking at every point finds what a search finds", kSameTool, kSameNumbers,
     vary::search_all_points},
    {"order", "the order of the points does not matter", kSameTool,
     "points are sorted by where they are: equal bits", vary::shuffle},
    {"missing-points", "points without a measurement change nothing", kSameTool, kSameNumbers,
     vary::add_missing},
    {"far-points", "points beyond ten times the largest length change nothing", kSolved, kVoxel,
     vary::add_far},
    {"zero-regions", "forbidden regions of radius 0 are none", kSameTool, kSameNumbers,
     vary::add_radius_column},
    {"mirror-x", "a world with left and right exchanged is felt so: x to -x", kSolved, kVoxel,
     vary::mirror_x},
    {"mirror-y", "y to -y", kSolved, kVoxel, vary::mirror_y},
    {"mirror-z", "z to -z", kSolved, kVoxel, vary::mirror_z},
    {"rigid-motion", "a scene that is turned and moved is felt turned and moved", kSolved, kVoxel,
     vary::move},
    {"size-2", "all lengths twice as large at equal stiffness: so are positions and forces", kSolvedTwice,
     kVoxel, vary::enlarge},
    {"size-1/2", "half as large", kSolvedHalf, kVoxel, vary::halve},
    {"speed-2", "all twice as fast: positions and forces stay", kSameTool, kFactors, vary::speed_up},
    {"force-1/2", "half the stiffness and damping: half the force", kSameTool, kFactors,
     vary::soften_renderer},
    {"clock", "a clock that is 1024 s ahead changes nothing", kSameTool,
     "all times are multiples of 1/1024 s: equal bits", vary::start_later},
    {"sent-twice", "a frame with the time of the newest is dropped: only the status tells", kSameTool,
     kSameNumbers, vary::send_twice},
    {"sent-late", "a frame older than the newest is dropped: only the status tells", kSameTool, kSameNumbers,
     vary::send_late},
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
