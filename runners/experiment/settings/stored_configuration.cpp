#include "runners/experiment/settings/stored_configuration.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

namespace {

constexpr double kUsualRate_hz = 30;

struct Count {
  const char* frames;
  const char* time;
};
constexpr Count kCounts[] = {{"wait_frames", "wait_s"},
                             {"rise_frames", "rise_s"},
                             {"acceleration_frames", "acceleration_s"},
                             {"vanish_at_frame", "vanish_at_s"},
                             {"empty_frame", "empty_frame_at_s"}};

bool is_moving_scene(const Json& value) {
  if (!value.is_object()) return false;
  const auto name = value.find("name");
  return name != value.end() && (*name == "moving-lift" || *name == "moving-shape");
}

double number_or(const Json& scenario, const char* name, double otherwise) {
  const auto found = scenario.find(name);
  return found != scenario.end() && found->is_number() ? found->get<double>() : otherwise;
}

// Returns null if the key is not a count, or its value not a number. A count of -1 means never.
const Count* count_of(const std::string& key, const Json& value) {
  const auto found =
      std::find_if(std::begin(kCounts), std::end(kCounts), [&](const Count& c) { return key == c.frames; });
  return found != std::end(kCounts) && value.is_number() ? found : nullptr;
}

// Keeps the order of the keys, because configurations are also compared as texts.
Json in_seconds(const Json& scenario) {
  const double rate_hz = number_or(scenario, "frame_rate_hz", kUsualRate_hz);
  Json converted = Json::object();
  bool has_counts = false;
  for (const auto& [key, value] : scenario.items()) {
    const Count* const count = count_of(key, value);
    has_counts |= count != nullptr;
    if (count)
      converted[count->time] = value.get<double>() < 0 ? -1.0 : value.get<double>() / rate_hz;
    else
      converted[key] = value;
  }
  // Older versions updated the motion at each frame, and made it linear between frames. These settings keep
  // that, because other updates would give other bits.
  const bool accelerates = number_or(scenario, "acceleration_m_per_s2", 0) != 0;
  const bool moves = accelerates || number_or(scenario, "start_velocity_m_per_s", 0) != 0;
  if (has_counts && moves && rate_hz != kUsualRate_hz) converted["update_rate_hz"] = rate_hz;
  if (has_counts && accelerates && scenario.value("truth", Json()) == "moving")
    converted["between_updates"] = "line";
  return converted;
}

void convert_to_seconds(Json& value) {
  if (!value.is_structured()) return;
  for (Json& part : value) convert_to_seconds(part);
  if (is_moving_scene(value)) value = in_seconds(value);
}

}  // namespace

std::string stored_configuration(const std::string& text) {
  Json configuration;
  try {
    configuration = parse_json(text, "config");
  } catch (const InputError&) {
    return text;
  }
  const Json before = configuration;
  convert_to_seconds(configuration);
  return configuration == before ? text : configuration.dump();
}

}  // namespace remote_touch
