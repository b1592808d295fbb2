#include "runners/experiment/catalog/renderer_changes.h"

#include <algorithm>

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

}  // namespace remote_touch
