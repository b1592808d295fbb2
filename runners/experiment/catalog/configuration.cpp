#include "runners/experiment/catalog/configuration.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "core/parameters/parameter.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

Parameters parameters(RendererChange& change) {
  return {
      {"time_s", &change.time_s, 0, 86400,
       "time of the change; it takes effect in the first tick at or after it"},
      {"parameter", &change.parameter, 0, 0,
       "what changes: a parameter of the renderer that is marked live, for example renderer.stiffness_N_per_m"},
      {"value", &change.value, -1e9, 1e9, "new value; of a switch: 0 or 1"},
  };
}

const Parameter* find_in_changes(const Parameters& live, const std::string& name) {
  const auto found = std::ranges::find_if(
      live, [&](const Parameter& parameter) { return name_in_changes(parameter) == name; });
  return found == live.end() ? nullptr : &*found;
}

void set_number(const Parameter& parameter, double value) {
  if (double* const* number = std::get_if<double*>(&parameter.value)) **number = value;
  if (bool* const* is_on = std::get_if<bool*>(&parameter.value)) **is_on = value != 0;
}

double number_of(const Parameter& parameter) {
  if (double* const* number = std::get_if<double*>(&parameter.value)) return **number;
  bool* const* is_on = std::get_if<bool*>(&parameter.value);
  return is_on && **is_on ? 1 : 0;
}

RendererChanges::RendererChanges(const std::vector<RendererChange>& changes, Renderer& renderer)
    : renderer_(renderer) {
  const Parameters live = renderer.live_parameters();
  for (const RendererChange& change : changes)
    if (const Parameter* const found = find_in_changes(live, change.parameter))
      changes_.push_back({change.time_s, *found, change.value});
}

void RendererChanges::make_until(double time_s) {
  const std::size_t first = next_;
  for (; next_ < changes_.size() && changes_[next_].time_s <= time_s; ++next_)
    set_number(changes_[next_].parameter, changes_[next_].value);
  if (next_ > first) renderer_.parameters_changed();
}

Parameters parameters(RunSettings& s) {
  return {
      {"title", &s.title, 0, 0, "one line that says what this is; shown by list"},
      {"duration_s", &s.duration_s, 0, 86400, "simulated time; 0: duration of the trajectory"},
      {"haptic_rate_hz", &s.haptic_rate_hz, 100, 10000, "haptic ticks per second, f_h of (4.16)"},
      {"frame_latency_s", &s.transport.latency_s, 0, 10,
       "minimum time from the capture of a frame to its arrival"},
      {"frame_jitter_s", &s.transport.jitter_s, 0, 10,
       "maximum additional delay, uniformly distributed for each frame; frames may overtake each other"},
      {"frame_drop_probability", &s.transport.drop_probability, 0, 1,
       "probability that a frame never arrives"},
      {"seed", &s.key.seed, 0, 18446744073709551615.0, "seed of the noise"},
      {"cell", &s.key.cell, 0, 4294967295.0, "second key of the noise: the cell of a sweep"},
      {"replicate", &s.key.replicate, 0, 4294967295.0, "third key of the noise: the replicate of a cell"},
  };
}

namespace {

// Returns the values of a rule without building it: some rules read files when they are built.
FixtureValues values_of(const Part<FixtureEntry>& rule) {
  Json all = Json::object(), own = Json::object();
  write_parameters(rule.factory->settings(), all);
  FixtureValues values;
  for (const Parameter& p : parameters(values)) own[p.name] = all[p.name];
  read_parameters(own, parameters(values), rule.name);
  return values;
}

// Returns true if the button of the step can be pressed, or if the step needs none. A simulated device has
// only those buttons that the operator's settings press.
bool can_be_pressed(const ExperimentConfiguration& configuration, const SequenceStep& step) {
  if (step.start != StepStart::button && step.end != StepEnd::button) return true;
  const std::string& hand = configuration.trajectory.name;
  if (configuration.live || find_entry(trajectories(), hand, "trajectory.name").has_buttons)
    return true;  // the device has buttons of its own
  if (!configuration.operator_settings) return false;
  const std::vector<double>& presses = configuration.operator_settings->presses;
  for (std::size_t i = 1; i < presses.size(); i += 3)
    if (presses[i] == step.button) return true;
  return false;
}

std::unique_ptr<RendererFactory> copy_of(const Part<RendererEntry>& renderer) {
  auto copy = find_entry(renderers(), renderer.name, "renderer.name").make();
  Json values = Json::object();
  write_parameters(renderer.factory->settings(), values);
  read_parameters(values, copy->settings(), "renderer");
  return copy;
}

[[noreturn]] void refuse(const std::string& where, const Parameters& live, const std::string& given) {
  std::string known;
  for (const Parameter& parameter : live) known += (known.empty() ? "" : ", ") + name_in_changes(parameter);
  throw InputError(where + ".parameter = " + given,
                   known.empty() ? "this renderer has no live parameters" : "expected one of " + known);
}

void make(const RendererChange& change, const Parameters& live, const std::string& where) {
  const Parameter* const found = find_in_changes(live, change.parameter);
  if (found == nullptr) refuse(where, live, change.parameter);
  const bool is_switch = std::holds_alternative<bool*>(found->value);
  if (!(change.value >= found->low && change.value <= found->high) ||
      (is_switch && change.value != 0 && change.value != 1))
    throw InputError(where + ".value = " + shown(change.value),
                     "expected " + (is_switch ? std::string("0 or 1") : allowed(*found)) + ", the range of " +
                         change.parameter);
  set_number(*found, change.value);
}

// Returns the first tick at or after the time of a change. The change takes effect in this tick.
double first_tick(const ExperimentConfiguration& configuration, const RendererChange& change) {
  const double rate_hz = configuration.run.haptic_rate_hz;
  double tick = std::floor(change.time_s * rate_hz);
  while (tick / rate_hz < change.time_s)
    ++tick;  // the same comparison as in a run, because the product above is rounded
  return tick;
}

// Throws InputError if an earlier change sets the same parameter in the same tick: the earlier one would have
// no effect, whatever its value.
void refuse_change_without_effect(const ExperimentConfiguration& configuration, std::size_t later) {
  const std::vector<RendererChange>& changes = configuration.changes;
  for (std::size_t i = 0; i < later; ++i)
    if (changes[i].parameter == changes[later].parameter &&
        first_tick(configuration, changes[i]) == first_tick(configuration, changes[later]))
      throw InputError("changes." + std::to_string(later) + ".parameter = " + changes[later].parameter,
                       "changes." + std::to_string(i) + " sets it in the same tick: expected one of them");
}

// Applies the changes in order. After the last change of each time, calls visit(factory, where) with the
// settings of that time. Throws InputError for a change that is invalid, out of order or without effect.
template <class Visit>
void after_changes(const ExperimentConfiguration& configuration, Visit visit) {
  const std::vector<RendererChange>& changes = configuration.changes;
  if (changes.empty()) return;
  const auto factory = copy_of(configuration.renderer);
  const Parameters live = live_ones(factory->settings());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const std::string where = "changes." + std::to_string(i);
    if (i > 0 && changes[i].time_s < changes[i - 1].time_s)
      throw InputError(where + ".time_s = " + shown(changes[i].time_s),
                       "expected the time of the change before it or later");
    make(changes[i], live, where);
    refuse_change_without_effect(configuration, i);
    if (i + 1 == changes.size() || changes[i + 1].time_s > changes[i].time_s) visit(*factory, where);
  }
}

// Throws InputError if the stiffness is none: the force of a real device is scaled by it.
double stiffness_of(const auto& factory, const std::string& renderer) {
  const double stiffness = factory.stiffness_N_per_m();
  if (stiffness >= 0 && std::isfinite(stiffness)) return stiffness;
  throw InputError("max_stiffness_N_per_m of the renderer " + renderer + " = " + std::to_string(stiffness),
                   "expected a finite number, 0 or more");
}

// The word of feedback.force.
std::string name_of(FeedbackSettings feedback) {
  for (const Parameter& p : parameters(feedback))
    if (p.name == "force")
      if (const Choice* const words = std::get_if<Choice>(&p.value))
        return words->names[static_cast<std::size_t>(words->get())];
  return {};
}

// The slave has the tool of the renderer.
void check_slave_tool(const ExperimentConfiguration& configuration) {
  if (!configuration.renderer.factory->tool())
    throw InputError("slave", "the tool of the renderer " + configuration.renderer.name +
                                  " is not known: expected a built-in renderer, or one without a tool");
  const double radius_m = configuration.slave->radius_m;
  if (radius_m != SlaveSettings{}.radius_m)
    throw InputError("slave.radius_m = " + shown(radius_m),
                     "expected the default for a slave with a tool, whose surface touches the scene");
  const Feedback force = configuration.feedback->force;
  if (feels_slave(force) && force != Feedback::slave_force)
    throw InputError(
        "feedback.force = " + name_of(*configuration.feedback),
        "expected another for a slave with a tool: it couples force and position, not torque and "
        "rotation");
}

// Passivity control and waves balance the work of the force on the hand with the motion that the device
// measures, and predict this motion from the force that they command.
void check_exact_device(const ExperimentConfiguration& configuration) {
  const Feedback force = configuration.feedback->force;
  if (!configuration.device || (force != Feedback::passive_slave_force && force != Feedback::wave)) return;
  const DeviceSettings& d = *configuration.device;
  const std::pair<std::string, bool> changed[] = {
      {"force_x = false", !d.motors.force_x},
      {"force_y = false", !d.motors.force_y},
      {"force_z = false", !d.motors.force_z},
      {"position_resolution_m = " + shown(d.position_resolution_m), d.position_resolution_m > 0},
      {"delay_ticks = " + std::to_string(d.delay_ticks), d.delay_ticks > 0},
      {"contact_damping_Ns_per_m = " + shown(d.contact_damping_Ns_per_m), d.contact_damping_Ns_per_m != 0}};
  for (const auto& [setting, is_changed] : changed)
    if (is_changed)
      throw InputError(
          "device." + setting,
          "expected the default with feedback.force = " + name_of(*configuration.feedback) +
              ": it needs the exact motion, and a device that exerts the force in the same tick, in all "
              "directions");
}

// Dead-bands look at the position of the hand and at the force of the scene. What else an architecture sends
// may change while these do not.
void check_links(const ExperimentConfiguration& configuration) {
  const Feedback force = configuration.feedback->force;
  const bool is_wave = force == Feedback::wave;
  const std::tuple<const char*, const DeadBandSettings&, bool> links[] = {
      {"command_link", configuration.command_link->dead_band, is_wave},
      {"force_link", configuration.force_link->dead_band, is_wave || force == Feedback::position_position}};
  for (const auto& [name, band, needs_all] : links)
    if (needs_all && (band.weber_fraction > 0 || band.least > 0))
      throw InputError(std::string(name) + (band.least > 0 ? ".least = " : ".weber_fraction = ") +
                           shown(band.least > 0 ? band.least : band.weber_fraction),
                       "expected 0 with feedback.force = " + name_of(*configuration.feedback) +
                           ", which needs every packet");
  if (const double limit = configuration.slave->max_speed_m_per_s; is_wave && limit > 0)
    throw InputError("slave.max_speed_m_per_s = " + shown(limit),
                     "expected 0 with feedback.force = wave, whose waves move the reference of the slave");
}

}  // namespace

std::vector<FixtureValues> ExperimentConfiguration::fixture_values() const {
  std::vector<FixtureValues> values;
  for (const auto& rule : fixtures) values.push_back(values_of(rule));
  return values;
}

bool ExperimentConfiguration::has_guidance() const {
  const std::vector<FixtureValues> values = fixture_values();
  return std::ranges::any_of(values, [](const FixtureValues& v) { return v.role == FixtureRole::guidance; });
}

void check_changes(ExperimentConfiguration& configuration) {
  after_changes(configuration, [](const auto& factory, const std::string& where) {
    const std::string problem = factory.validate();
    if (!problem.empty()) throw InputError(where, "after this change renderer." + problem);
  });
  max_renderer_stiffness(configuration);
}

double max_renderer_stiffness(const ExperimentConfiguration& configuration) {
  const std::string& name = configuration.renderer.name;
  double max = stiffness_of(*configuration.renderer.factory, name);
  after_changes(configuration, [&](const auto& factory, const std::string&) {
    max = std::max(max, stiffness_of(factory, name));
  });
  return max;
}

void check_fixtures(ExperimentConfiguration& configuration) {
  const std::string problem = validate(configuration.fixture_values(), configuration.sequence);
  if (!problem.empty()) throw InputError(problem);
}

void complete_guidance(ExperimentConfiguration& configuration) {
  const bool needed = configuration.has_guidance();
  if (configuration.guidance && !needed)
    throw InputError("guidance", "expected only when a fixture has role = guidance");
  if (needed && !configuration.guidance) configuration.guidance.emplace();
}

void check_sequence(ExperimentConfiguration& configuration) {
  for (std::size_t i = 0; i < configuration.sequence.size(); ++i)
    if (!can_be_pressed(configuration, configuration.sequence[i]))
      throw InputError(
          "sequence." + std::to_string(i) + ".button = " + std::to_string(configuration.sequence[i].button),
          "expected a button of operator.presses (any button in experiments with a section live)");
}

bool renders_tool(const ExperimentConfiguration& configuration) {
  return find_entry(renderers(), configuration.renderer.name, "renderer.name").degrees_of_freedom ==
         DegreesOfFreedom::six;
}

void check_slave(ExperimentConfiguration& configuration) {
  if (!configuration.slave) {
    const std::pair<const char*, bool> needing[] = {{"command_link", configuration.command_link.has_value()},
                                                    {"force_link", configuration.force_link.has_value()},
                                                    {"frame_link", configuration.frame_link.has_value()},
                                                    {"feedback", configuration.feedback.has_value()},
                                                    {"registration", configuration.registration.has_value()}};
    for (const auto& [name, is_given] : needing)
      if (is_given) throw InputError(name, "expected only in an experiment with the section slave");
    return;
  }
  if (!configuration.command_link) configuration.command_link.emplace();
  if (!configuration.force_link) configuration.force_link.emplace();
  if (!configuration.frame_link) configuration.frame_link.emplace();
  if (!configuration.feedback) configuration.feedback.emplace();
  if (!configuration.registration) configuration.registration.emplace();
  if (const double fraction = configuration.command_link->dead_band.weber_fraction; fraction > 0)
    throw InputError("command_link.weber_fraction = " + shown(fraction),
                     "expected 0, and a length as command_link.least: the size of a position depends on the "
                     "origin");
  if (renders_tool(configuration)) check_slave_tool(configuration);
  check_exact_device(configuration);
  check_links(configuration);
}

void check_device(ExperimentConfiguration& configuration) {
  if (!configuration.device || configuration.operator_settings) return;
  const DeviceResistance& r = configuration.device->resistance;
  const std::pair<const char*, double> without_effect[] = {
      {"friction_N", r.friction_N},
      {"friction_torque_Nm", r.friction_torque_Nm},
      {"damping_Ns_per_m", r.damping_Ns_per_m},
      {"rotational_damping_Nms_per_rad", r.rotational_damping_Nms_per_rad}};
  for (const auto& [name, value] : without_effect)
    if (value > 0)
      throw InputError(std::string("device.") + name + " = " + shown(value),
                       "expected 0 in an experiment without the section operator, whose hand has a mass");
}

}  // namespace remote_touch
