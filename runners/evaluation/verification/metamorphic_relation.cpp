#include "runners/evaluation/verification/metamorphic_relation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "runners/evaluation/verification/relation_variations.h"

namespace remote_touch {
namespace {

double difference(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;  // two infinities too
  const double d = std::abs(a - b);
  return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

double difference(const Vec3& a, const Vec3& b) {
  // The squares of the smallest numbers would underflow.
  return std::hypot(difference(a.x(), b.x()), difference(a.y(), b.y()), difference(a.z(), b.z()));
}

// Returns the rotation between the two tools, in radians for small angles; 0 without a tool. Infinite if an
// orientation is not finite, or if only one output has a tool.
double rotation_between(const RenderOutput& a, const RenderOutput& b) {
  if (!a.tool && !b.tool) return 0;
  if (!a.tool || !b.tool) return std::numeric_limits<double>::infinity();
  const Eigen::Vector4d &p = a.tool->orientation_W.coeffs(), &q = b.tool->orientation_W.coeffs();
  if (!p.allFinite() || !q.allFinite()) return std::numeric_limits<double>::infinity();
  return 2 * std::min((p - q).norm(), (p + q).norm());  // q and -q are one rotation
}

double penetration_difference(const RenderOutput& a, const RenderOutput& b) {
  return a.tool && b.tool ? difference(a.tool->tool_penetration_m, b.tool->tool_penetration_m) : 0;
}

double torque_difference(const RenderOutput& a, const RenderOutput& b) {
  return a.tool && b.tool ? difference(a.tool->torque_Nm, b.tool->torque_Nm) : 0;
}

bool tools_agree(const RenderOutput& a, const RenderOutput& b, bool rounded) {
  if (!a.tool || !b.tool) return a.tool.has_value() == b.tool.has_value();
  return rounded ||
         (a.tool->active_constraints == b.tool->active_constraints &&
          a.tool->contact_clusters == b.tool->contact_clusters && a.tool->detections == b.tool->detections &&
          a.tool->budget_exhausted == b.tool->budget_exhausted &&
          a.tool->disabled_points == b.tool->disabled_points);
}

bool others_agree(const RenderOutput& a, const RenderOutput& b, bool rounded) {
  if (!tools_agree(a, b, rounded)) return false;
  return a.state == b.state && a.converged == b.converged && a.contact_count == b.contact_count &&
         a.frame_index == b.frame_index && a.status == b.status && (rounded || a.steps == b.steps);
}

constexpr std::size_t kQuantities = 8;

std::array<double, kQuantities> differences(const RenderOutput& a, const RenderOutput& b,
                                            const OutputTolerance& tolerance) {
  const bool rounded = tolerance.rounded;
  // Far from the points the weights of a normal are as small as their own rounding.
  const bool normal_counts =
      !tolerance.without_contact_details && (!rounded || a.state != ContactState::free);
  const double nearest =
      tolerance.without_contact_details ? 0 : difference(a.nearest_distance_m, b.nearest_distance_m);
  return {std::max({difference(a.proxy_W, b.proxy_W), difference(a.frame_correction_m, b.frame_correction_m),
                    difference(a.slave_W, b.slave_W)}),
          std::max(nearest, penetration_difference(a, b)),
          difference(a.force_N, b.force_N),
          difference(a.surface_velocity_m_per_s, b.surface_velocity_m_per_s),
          normal_counts ? difference(a.normal_W, b.normal_W) : 0,
          rotation_between(a, b),
          torque_difference(a, b),
          tolerance.without_contact_details || others_agree(a, b, rounded) ? 0.0 : 1.0};
}

std::vector<Deviation> none_yet(const std::vector<RenderOutput>& expected, const OutputTolerance& tolerance) {
  double max_force_N = 0, max_torque_Nm = 0;
  for (const RenderOutput& out : expected) {
    max_force_N = std::max(max_force_N, out.force_N.norm());
    if (out.tool) max_torque_Nm = std::max(max_torque_Nm, out.tool->torque_Nm.norm());
  }
  return {{"position", "m", tolerance.position_m},
          {"nearest", "m", tolerance.position_m},
          {"force", "N", tolerance.force_fraction * max_force_N},
          {"velocity", "m/s", tolerance.velocity_m_per_s},
          {"normal", "1", tolerance.normal},
          {"rotation", "rad", tolerance.rotation_rad},
          {"torque", "Nm", tolerance.torque_fraction * max_torque_Nm},
          {"other", "1", 0}};
}

}  // namespace

Comparison compare(const std::vector<RenderOutput>& expected, const std::vector<RenderOutput>& outputs,
                   const OutputTolerance& tolerance, bool until_velocity) {
  Comparison result{.deviations = none_yet(expected, tolerance)};
  for (std::size_t tick = 0; tick < outputs.size(); ++tick) {
    const RenderOutput &a = expected[tick], &b = outputs[tick];
    if (until_velocity && (a.surface_velocity_m_per_s != 0 || b.surface_velocity_m_per_s != 0)) break;
    result.ticks = static_cast<int>(tick) + 1;
    const auto now = differences(a, b, tolerance);
    for (std::size_t i = 0; i < kQuantities; ++i) {
      Deviation& deviation = result.deviations[i];
      deviation.max = std::max(deviation.max, now[i]);
      if (now[i] > deviation.tolerance && result.first_violation < 0)
        result.first_violation = static_cast<int>(tick);
    }
  }
  return result;
}

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
