#include "runners/experiment/settings/configuration_difference.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

namespace {

constexpr std::size_t kMaxLength = 60;  // maximum number of bytes that text_from() returns from `first` on

// Returns the text from the byte `first` on, shortened. The first byte of a value, such as [, and "..." stand
// for what is before it. No UTF-8 character is cut.
std::string text_from(const std::string& text, std::size_t first) {
  while (first > 0 && first < text.size() && (static_cast<unsigned char>(text[first]) & 0xC0) == 0x80)
    --first;
  const std::string rest = text.substr(std::min(first, text.size()));
  return (first > 0 ? text.substr(0, 1) + "..." : "") +
         (rest.size() <= kMaxLength ? rest : first_part(rest, kMaxLength - 3));
}

// Returns "3 against 4". Long values are shortened such that the first place at which they differ is shown.
std::string both_texts(const Json* a, const Json* b) {
  constexpr std::size_t kBefore = 20;  // number of bytes that are shown before that place
  const std::string first = a ? a->dump() : "absent", second = b ? b->dump() : "absent";
  const auto equal = static_cast<std::size_t>(
      std::mismatch(first.begin(), first.end(), second.begin(), second.end()).first - first.begin());
  const std::size_t begin = equal < kMaxLength - kBefore ? 0 : equal - kBefore;
  return text_from(first, begin) + " against " + text_from(second, begin);
}

void differences(const std::string& path, const Json* a, const Json* b, std::vector<std::string>& found) {
  if (a && b && *a == *b) return;
  if (!a || !b || !a->is_object() || !b->is_object()) {
    if (path != "title" && path != "experiment.title") found.push_back(path + " " + both_texts(a, b));
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
