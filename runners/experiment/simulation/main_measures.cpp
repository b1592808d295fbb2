#include "runners/experiment/simulation/main_measures.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

constexpr std::size_t kMainMeasures = 5;

enum class When { always, fixtures, no_fixtures };

// The first five that apply to the run and have a value are printed. So a run without a known truth or
// without a tool has the next ones instead.
struct Priority {
  const char* measure;
  When when;
  const char* unless = "";  // another measure, with which this one is left out
};
constexpr Priority kPriorities[] = {
    // Did the slave touch, how hard, and what did the hand feel of it?
    {"max_slave_force", When::always},
    {"min_slave_clearance", When::always},
    {"max_device_force", When::always},
    // A region is violated if the slave comes too near to the surface behind it.
    {"min_slave_distance", When::fixtures},
    // Guidance has to lead the hand to its goal.
    {"guidance_error", When::always},
    {"guidance_error_angle", When::always},
    // The first question about a method: does its proxy stay on the right side of the surface? Where a camera
    // measured the surface, the second is on which side of the true one that is.
    {"popped_through", When::no_fixtures},
    {"popped_through_truth", When::no_fixtures},
    {"first_pop_through_time", When::no_fixtures},  // has no value unless it happened
    {"tool_popped_through", When::no_fixtures},
    // How far was it wrong? The depth of points in a tool needs no truth.
    {"max_penetration", When::no_fixtures, "popped_through_truth"},
    {"max_tool_penetration", When::always},
    // How well does the hand feel the shape?
    {"rms_contact_error", When::no_fixtures},
    // The error has two parts, of the camera and of the renderer.
    {"rms_camera_error", When::no_fixtures},
    {"rms_renderer_error", When::no_fixtures},
    // How much does the device have to exert, and how large is the jolt when a frame arrives?
    {"max_force", When::always},
    {"max_force_jump", When::always},
    {"max_torque", When::always},
    // Was there a contact, and did the steps of a tick suffice?
    {"force_fraction", When::always},
    {"unconverged_fraction", When::always},
    {"exhausted_fraction", When::always},
    {"mean_steps", When::always},
};

bool is_wanted(When when, Fixtures fixtures) {
  return when == When::always || (when == When::fixtures) == (fixtures == Fixtures::some);
}

bool is_built_in(const std::string& name) {
  return std::ranges::any_of(built_in_measures(), [&](const Measure& each) { return each.name == name; });
}

struct UnitName {
  const char *unit, *words;
};
constexpr UnitName kUnitNames[] = {
    {"1", ""},
    {"m", "metres"},
    {"s", "seconds"},
    {"N", "newtons"},
    {"J", "joules"},
    {"rad", "radians"},
    {"N m", "newton metres"},
    {"1/s", "per second"},
    {"N/m", "newtons per metre"},
};

}  // namespace

std::vector<MeasuredValue> measured_values(std::span<const Measure> list, const Trace& trace) {
  std::vector<MeasuredValue> values;
  for (const Measure& measure : list)
    if (applies(measure, trace)) values.push_back({&measure, measure.compute(trace)});
  return values;
}

std::vector<MeasuredValue> main_measures(const std::vector<MeasuredValue>& all, Fixtures fixtures) {
  std::vector<MeasuredValue> chosen;
  const auto find = [&](const std::string& name) {
    return std::ranges::find_if(all, [&](const MeasuredValue& each) { return each.measure->name == name; });
  };
  for (const Priority& priority : kPriorities) {
    const auto found = find(priority.measure);
    if (found == all.end() || std::isnan(found->value) || !is_wanted(priority.when, fixtures)) continue;
    if (find(priority.unless) != all.end()) continue;
    chosen.push_back(*found);
    if (chosen.size() == kMainMeasures) break;
  }
  for (const MeasuredValue& each : all)
    if (!is_built_in(each.measure->name)) chosen.push_back(each);
  return chosen;
}

std::string unit_in_words(const std::string& unit) {
  for (const UnitName& name : kUnitNames)
    if (unit == name.unit) return name.words;
  return unit;
}

}  // namespace remote_touch
