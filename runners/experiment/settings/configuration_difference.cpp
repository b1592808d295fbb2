#include "runners/experiment/settings/configuration_difference.h"

#include <nlohmann/json.hpp>

#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

namespace {

std::string text(const Json* value) {
  constexpr std::size_t kMaxLength = 60;
  const std::string all = value ? value->dump() : "absent";
  return all.size() <= kMaxLength ? all : first_part(all, kMaxLength - 3);
}

void differences(const std::string& path, const Json* a, const Json* b, std::vector<std::string>& found) {
  if (a && b && *a == *b) return;
  if (!a || !b || !a->is_object() || !b->is_object()) {
    if (path != "title" && path != "experiment.title")
      found.push_back(path + " " + text(a) + " against " + text(b));
    return;
  }
  const auto member = [](const Json& object, const std::string& key) {
    const auto place = object.find(key);
    return place == object.end() ? nullptr : &*place;
  };
  const std::string prefix = path.empty() ? "" : path + ".";
  for (const auto& [key, value] : a->items()) differences(prefix + key, &value, member(*b, key), found);
  for (const auto& [key, value] : b->items())
    if (!a->contains(key)) differences(prefix + key, nullptr, &value, found);
}

}  // namespace

std::vector<std::string> configuration_differences(const std::string& first, const std::string& second) {
  const Json a = parse_json(first, "configuration"), b = parse_json(second, "configuration");
  std::vector<std::string> found;
  differences("", &a, &b, found);
  return found;
}

}  // namespace remote_touch
