#include "runners/live/loop/live_controls.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/parameters/parameter.h"

namespace remote_touch {

LiveControls::LiveControls(const Experiment& experiment, const Kernels& kernels, Camera camera)
    : kernels_(kernels),
      configuration_(experiment.to_json()),
      max_stiffness_N_per_m_(experiment.max_stiffness_N_per_m()) {
  std::vector<LiveParameter> live = experiment.live_parameters();
  if (!experiment.changes().empty()) live.clear();
  for (LiveParameter& parameter : live) {
    if (parameter.of == LiveParameter::Of::renderer) ++of_renderer_;
    if (parameter.of == LiveParameter::Of::scenario && camera == Camera::other) continue;
    values_.push_back(parameter.value);
    parameters_.push_back(std::move(parameter));
  }
  if (camera == Camera::simulated)
    shown_ = std::make_shared<ShownScenario>(experiment.build_scenario(kernels));
}

bool LiveControls::has_changed() const {
  return !std::equal(values_.begin(), values_.end(), parameters_.begin(),
                     [](double value, const LiveParameter& parameter) { return value == parameter.value; });
}

std::string LiveControls::change(const ParameterChanges& changes) try {
  std::vector<double> values = values_;
  for (const ParameterChange& change : changes.all()) {
    if (change.parameter < 0 || static_cast<std::size_t>(change.parameter) >= parameters_.size())
      return "there is no live parameter " + std::to_string(change.parameter);
    values[static_cast<std::size_t>(change.parameter)] = change.value;
  }
  ParameterChanges* const slot = requested_.next_slot();
  if (slot == nullptr) return "the haptic loop has not yet applied the earlier changes";
  const Experiment changed = checked(values);
  if (has_stiffness_limit_ && changed.max_stiffness_N_per_m() > max_stiffness_N_per_m_)
    return "this device allows no greater stiffness than at the start of the run";
  if (shown_ && is_of_scenario(changes)) shown_->replace(changed.build_scenario(kernels_));
  *slot = changes;
  requested_.push();
  values_ = std::move(values);
  return {};
} catch (const InputError& error) {
  return error.what();
}

// Returns the whole experiment with all changes so far, checked. Throws InputError.
Experiment LiveControls::checked(const std::vector<double>& values) const {
  std::vector<std::string> settings;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (values[i] == parameters_[i].value) continue;
    char number[40] = {};
    std::to_chars(number, number + sizeof number - 1, values[i]);  // the shortest text of this number
    const bool is_off_or_on = parameters_[i].is_switch && (values[i] == 0 || values[i] == 1);
    settings.push_back(parameters_[i].name + "=" +
                       (is_off_or_on ? (values[i] == 1 ? "true" : "false") : number));
  }
  return Experiment::from_json(configuration_, "the changed experiment", settings);
}

bool LiveControls::is_of_scenario(const ParameterChanges& changes) const {
  const auto all = changes.all();
  return std::any_of(all.begin(), all.end(), [this](const ParameterChange& change) {
    return static_cast<std::size_t>(change.parameter) >= of_renderer_;
  });
}

}  // namespace remote_touch
