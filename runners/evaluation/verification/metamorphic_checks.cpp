#include "runners/evaluation/verification/metamorphic_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>

#include "core/parameters/parameter.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch {
namespace {

using Outputs = std::vector<RenderOutput>;

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

std::vector<Deviation> none_yet(const Outputs& expected, const OutputTolerance& tolerance) {
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

// pre: as many outputs as expected. until_velocity: ends as soon as either run has estimated a surface
// velocity.
Comparison compare(const Outputs& expected, const Outputs& outputs, const OutputTolerance& tolerance,
                   bool until_velocity) {
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

constexpr CheckName kTouch{
    "touch", "the renderer pushes back in most ticks, or in some if its contact model loses contact"};

constexpr CheckName kFinite{"finite", "all positions, directions, forces and torques are finite numbers"};

// Makes the renderer under test, as often as it is needed.
class Subject {
 public:
  Subject(const RendererEntry& entry, const std::vector<std::string>& assignments, const Kernels& kernels)
      : entry_(entry), model_(contact_model_of(entry.name)), assignments_(assignments), kernels_(kernels) {}

  std::unique_ptr<RendererFactory> factory() const {
    Json configuration = Json::object();
    if (is_tool())
      for (const char* assignment : kVerifiedTool) apply_override(configuration, assignment);
    for (const std::string& assignment : assignments_) apply_override(configuration, assignment);
    auto factory = entry_.make();
    read_parameters(configuration, factory->settings(), "");
    const std::string problem = factory->validate();
    if (!problem.empty()) throw InputError(problem);
    return factory;
  }
  Outputs play(const Variation& run) const {
    const auto changed = factory();
    change_units(changed->settings(), run.units);
    if (run.other_stiffness_N_per_m) *stiffness(changed->settings()) = *run.other_stiffness_N_per_m;
    const auto renderer = changed->build(run.scene.haptic_rate_hz, *run.kernels);
    return remote_touch::play(run.scene, *renderer);
  }
  // True if the scene determines the output of a renderer of tools; always true for other renderers.
  bool is_for(const MetamorphicScene& scene) const {
    if (!is_tool()) return true;
    if (model_.renders_only_regions && scene.views.front().cloud.fixture_radius_m.empty()) return false;
    if (model_.motion_amplifies_rounding && !scene.cloud_rests) return false;
    return !(model_.smooths_creases && scene.has_crease);
  }
  DegreesOfFreedom degrees_of_freedom() const { return entry_.degrees_of_freedom; }
  bool is_tool() const { return degrees_of_freedom() == DegreesOfFreedom::six; }
  // Returns the smallest fraction of the ticks that must have a force.
  double min_touch_fraction() const { return model_.may_lose_contact ? 0.02 : 0.5; }
  Variation unvaried(const MetamorphicScene& scene) const {
    const auto settings_of = factory();
    const Parameters parameters = settings_of->settings();
    Variation run{scene, {}, &kernels_};
    run.reach_m = max_length_m(parameters);
    run.contact_model = model_;
    run.can_be_mirrored = !is_tool() || (!run.contact_model.renders_only_regions && !names_a_tool());
    if (const double* value = stiffness(parameters)) run.stiffness_N_per_m = *value;
    run.expected = play(run);
    return run;
  }

 private:
  bool names_a_tool() const {
    return std::any_of(assignments_.begin(), assignments_.end(),
                       [](const std::string& assignment) { return assignment.starts_with("tool_mesh="); });
  }
  // Returns the renderer's parameter stiffness_N_per_m, or null if it has none.
  static double* stiffness(const Parameters& parameters) {
    for (const Parameter& p : parameters)
      if (double* const* value = std::get_if<double*>(&p.value); value && p.name == "stiffness_N_per_m")
        return *value;
    return nullptr;
  }

  const RendererEntry& entry_;
  const ContactModel model_;
  const std::vector<std::string>& assignments_;
  const Kernels& kernels_;
};

// Counts the ticks for which is_bad(output) is true. The check is violated in the tick in which the count
// exceeds the allowed number.
template <class IsBad>
Comparison counted(const char* what, double allowed, const Outputs& outputs, IsBad&& is_bad) {
  Comparison count{.deviations = {{what, "1", allowed}}};
  count.ticks = static_cast<int>(outputs.size());
  for (std::size_t tick = 0; tick < outputs.size(); ++tick) {
    if (!is_bad(outputs[tick])) continue;
    if (++count.deviations.front().max > allowed && count.first_violation < 0)
      count.first_violation = static_cast<int>(tick);
  }
  return count;
}

// An unknown force is no force.
CheckResult touch(const MetamorphicScene& scene, const Outputs& outputs, double min) {
  const Comparison count =
      counted("ticks without force", (1 - min) * static_cast<double>(outputs.size()), outputs,
              [](const RenderOutput& out) { return !out.force_N.allFinite() || out.force_N.isZero(0); });
  return {kTouch.name, kTouch.meaning, scene.name, "the other checks mean little without touch", count, {}};
}

// The other checks compare two runs, and numbers that are unknown in both count as equal there. Nothing may
// be near the proxy, and no command may have been sent yet, so nearest_distance_m and slave_W are not
// checked.
bool is_finite(const RenderOutput& out) {
  return out.proxy_W.allFinite() && out.force_N.allFinite() && out.normal_W.allFinite() &&
         out.frame_correction_m.allFinite() && std::isfinite(out.surface_velocity_m_per_s) &&
         (!out.tool || (out.tool->orientation_W.coeffs().allFinite() && out.tool->torque_Nm.allFinite() &&
                        std::isfinite(out.tool->tool_penetration_m)));
}

CheckResult finite(const MetamorphicScene& scene, const Outputs& outputs) {
  const Comparison count = counted("ticks with a value that is not finite", 0, outputs,
                                   [](const RenderOutput& out) { return !is_finite(out); });
  return {kFinite.name, kFinite.meaning, scene.name, "a device cannot exert any other force", count, {}};
}

// Returns a remark if a HIP that is moved by 1e-13 m along each axis violates the tolerance no later than the
// failed check does. Differences as small as rounding then grow, so a tolerance for rounding cannot decide
// the check. The check counts as failed all the same. Returns an empty text otherwise.
std::string remark_on(const CheckResult& failed, const Subject& subject, const Variation& unvaried,
                      const OutputTolerance& tolerance) {
  constexpr double kSmall_m = 1e-13;  // below every tolerance
  Variation moved = unvaried;
  for (Vec3& hip : moved.scene.hip_W) hip.array() += kSmall_m;
  const int tick = compare(unvaried.expected, subject.play(moved), tolerance, false).first_violation;
  if (tick < 0 || tick > failed.comparison.first_violation) return {};
  return "undecided: moving the HIP by 1e-13 m changes the answers as much, from tick " +
         std::to_string(tick) + " on";
}

std::vector<CheckResult> verify_scene(const Subject& subject, const MetamorphicScene& scene) {
  const Variation unvaried = subject.unvaried(scene);
  std::vector<CheckResult> results{touch(scene, unvaried.expected, subject.min_touch_fraction()),
                                   finite(scene, unvaried.expected)};
  for (const MetamorphicRelation& relation : relations_of(subject.degrees_of_freedom())) {
    Variation run = unvaried;
    if (!relation.vary(run)) continue;
    CheckResult result{relation.name, relation.meaning, scene.name, relation.reason, {}, {}};
    result.comparison = compare(run.expected, subject.play(run), relation.tolerance, run.until_velocity);
    if (!result.passed() && relation.tolerance.rounded)
      result.remark = remark_on(result, subject, unvaried, relation.tolerance);
    results.push_back(std::move(result));
  }
  return results;
}

// The built-in renderers that not all checks apply to.
constexpr std::pair<const char*, ContactModel> kBuiltIn[] = {
    {"penalty", ContactModel::nothing},
    {"tool-god-object", ContactModel::resting_points},
    {"tracked-sheet", ContactModel::sheet},
    {"tracked-tool", ContactModel::sheet}};
// The model of a built-in renderer that needs more than points in its frames.
constexpr std::pair<FrameNeed, ContactModel> kModelOfNeed[] = {{FrameNeed::view, ContactModel::oriented},
                                                               {FrameNeed::organised, ContactModel::mesh},
                                                               {FrameNeed::regions, ContactModel::regions}};

// A static of a function: programs may declare models before main() begins.
std::map<std::string, ContactModel>& declared() {
  static std::map<std::string, ContactModel> models;
  return models;
}

}  // namespace

std::vector<CheckResult> verify_renderer(const RendererEntry& entry,
                                         const std::vector<std::string>& assignments, const Kernels& kernels,
                                         const std::atomic<bool>* stop) {
  const bool is_tool = entry.degrees_of_freedom == DegreesOfFreedom::six;
  return verify_renderer(entry, assignments, kernels,
                         is_tool ? tool_scenes(kernels) : verification_scenes(kernels), stop);
}

std::vector<CheckResult> verify_renderer(const RendererEntry& entry,
                                         const std::vector<std::string>& assignments, const Kernels& kernels,
                                         const std::vector<MetamorphicScene>& scenes,
                                         const std::atomic<bool>* stop) {
  const Subject subject(entry, assignments, kernels);
  std::vector<CheckResult> results;
  for (const MetamorphicScene& scene : scenes) {
    if (stop && *stop) throw Interrupted{};
    if (!subject.is_for(scene)) continue;
    for (CheckResult& result : verify_scene(subject, scene)) results.push_back(std::move(result));
  }
  return results;
}

std::vector<CheckName> check_names(DegreesOfFreedom degrees_of_freedom) {
  std::vector<CheckName> names{kTouch, kFinite};
  for (const MetamorphicRelation& relation : relations_of(degrees_of_freedom))
    names.push_back({relation.name, relation.meaning});
  return names;
}

ContactModel contact_model_of(const std::string& renderer) {
  for (const auto& [name, model] : kBuiltIn)
    if (renderer == name) return model;
  for (const RendererEntry& entry : built_in_catalog().renderers())
    for (const auto& [need, model] : kModelOfNeed)
      if (renderer == entry.name && std::ranges::count(entry.needs, need) > 0) return model;
  const auto found = declared().find(renderer);
  return found == declared().end() ? ContactModel() : found->second;
}

void declare_contact_model(const std::string& renderer, const ContactModel& model) {
  declared().insert_or_assign(renderer, model);
}

}  // namespace remote_touch
