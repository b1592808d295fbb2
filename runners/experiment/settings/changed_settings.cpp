#include "runners/experiment/settings/changed_settings.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/parameters/parameter.h"
#include "runners/experiment/settings/json_parameters.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

bool is_stored(std::span<const EmbeddedText> stored, const std::string& name) {
  return std::any_of(stored.begin(), stored.end(),
                     [&](const EmbeddedText& text) { return name == text.name; });
}

std::string embedded_or_file(std::span<const EmbeddedText> stored, const std::string& name_or_file,
                             const std::string& kind) {
  for (const EmbeddedText& text : stored)
    if (name_or_file == text.name) return text.json;
  return read_text_file(name_or_file, "expected " + kind + " name (see remote-touch list) or a JSON file");
}

namespace {

nlohmann::json table_named(const std::string& name) {
  for (const EmbeddedText& table : embedded_second_implementation())
    if (name == table.name) return nlohmann::json::parse(table.json);
  throw InputError(name, "no table of this name: expected one of data/second_implementation");
}

using Keys = std::vector<std::string>;

struct Assignment {
  std::string path;
  Keys keys;
  Json value;
};

std::vector<Assignment> read_all(const std::vector<std::string>& assignments) {
  std::vector<Assignment> all;
  for (const std::string& text : assignments) {
    auto [path, value] = read_assignment(text);
    Keys keys = normalised_keys(path);
    all.push_back({std::move(path), std::move(keys), std::move(value)});
  }
  return all;
}

bool begins_with(const Keys& keys, const Keys& first) {
  return first.size() <= keys.size() && std::equal(first.begin(), first.end(), keys.begin());
}

// Returns the value that `outer` sets at the path of `inner`; null if it sets none. pre: the keys of inner
// begin with those of outer.
const Json* value_at(const Assignment& outer, const Assignment& inner) {
  return find_value(outer.value, std::span(inner.keys).subspan(outer.keys.size()));
}

std::string option_text(const Assignment& assignment) {
  return "--set " + assignment.path + "=" + shown(assignment.value);
}

// Returns at most the last max bytes of the text, after "..." for the rest. Never cuts a UTF-8 character.
std::string last_part(const std::string& text, std::size_t max) {
  if (text.size() <= max) return text;
  std::size_t begin = text.size() - max;
  while (begin < text.size() && (static_cast<unsigned char>(text[begin]) & 0xC0) == 0x80) ++begin;
  return "..." + text.substr(begin);
}

// Shortens a value for a title. A text is most often a path, and the end of a path is its most informative
// part.
std::string short_text(const Json& value) {
  constexpr std::size_t kMaxLength = 40;
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return value.is_string() ? last_part(text.substr(1, text.size() - 2), kMaxLength)
                           : first_part(text, kMaxLength);
}

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

double second_number(const std::string& table, const std::string& place) {
  return table_named(table).at(nlohmann::json::json_pointer(place)).get<double>();
}

std::vector<double> second_column(const std::string& table, const std::string& list,
                                  const std::string& column) {
  const nlohmann::json all = table_named(table);  // outlives the loop over its rows
  std::vector<double> values;
  for (const auto& row : all.at(nlohmann::json::json_pointer(list)))
    values.push_back(row.at(column).get<double>());
  return values;
}

std::string first_part(const std::string& text, std::size_t max) {
  if (text.size() <= max) return text;
  while (max > 0 && (static_cast<unsigned char>(text[max]) & 0xC0) == 0x80) --max;
  return text.substr(0, max) + "...";
}

std::vector<std::string> normalised_keys(const std::string& path) {
  Keys keys = path_keys(path);
  for (std::string& key : keys)
    if (is_index(key)) key.erase(0, std::min(key.find_first_not_of('0'), key.size() - 1));
  return keys;
}

void refuse_discarded(const std::vector<std::string>& assignments) {
  const std::vector<Assignment> all = read_all(assignments);
  for (std::size_t later = 0; later < all.size(); ++later)
    for (std::size_t i = 0; i < later; ++i) {
      const Assignment &lost = all[i], &outer = all[later];
      if (outer.keys.size() == lost.keys.size() || !begins_with(lost.keys, outer.keys)) continue;
      if (const Json* const kept = value_at(outer, lost); kept && *kept == lost.value) continue;
      throw InputError(option_text(lost), "is overwritten by --set " + outer.path + ": expected one of them");
    }
}

std::vector<std::string> replaced_settings(const std::vector<std::string>& assignments) {
  const std::vector<Assignment> all = read_all(assignments);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t later = i + 1; later < all.size(); ++later) {
      if (!begins_with(all[later].keys, all[i].keys)) continue;
      const Json* const earlier = value_at(all[i], all[later]);
      if (!earlier || *earlier == all[later].value) continue;
      const bool is_whole = all[i].keys.size() == all[later].keys.size();
      lines.push_back(option_text(all[i]) + (is_whole ? " is replaced by " : " is replaced in part by ") +
                      option_text(all[later]));
      break;  // only the first replacement; it may be replaced in turn
    }
  return lines;
}

std::string changed_title(const std::string& title, const std::vector<ChangedSetting>& changes) {
  constexpr std::size_t kMaxLength = 120;
  const std::string mark = ", changed: ";
  if (title.empty() || changes.empty()) return title;
  std::string text;
  std::size_t named = 0;
  for (const auto& [path, value] : changes) {
    const std::string one =
        (named == 0 ? "" : ", ") + last_part(path, kMaxLength / 2) + "=" + short_text(value);
    if (named > 0 && text.size() + one.size() > kMaxLength) break;
    text += one, ++named;
  }
  if (named < changes.size()) text += " and " + std::to_string(changes.size() - named) + " more";
  return title + (title.find(mark) == std::string::npos ? mark : ", ") + text;
}

std::vector<ChangedSetting> changes_of(const Json& before, const std::vector<std::string>& assignments) {
  const std::vector<Assignment> all = read_all(assignments);
  std::vector<ChangedSetting> changes;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].keys.empty() && all[i].keys.front() == "title") return {};
    const auto is_same_place = [&](const Assignment& later) { return later.keys == all[i].keys; };
    const bool is_replaced =
        std::any_of(all.begin() + static_cast<std::ptrdiff_t>(i) + 1, all.end(), is_same_place);
    const Json* const there = find_value(before, all[i].keys);
    if (!is_replaced && !(there && *there == all[i].value)) changes.emplace_back(all[i].path, all[i].value);
  }
  return changes;
}

void apply_overrides(Json& configuration, const std::vector<std::string>& assignments) {
  refuse_discarded(assignments);
  const std::vector<ChangedSetting> changes = changes_of(configuration, assignments);
  for (const std::string& assignment : assignments) apply_override(configuration, assignment);
  if (const auto title = configuration.find("title"); title != configuration.end() && title->is_string())
    *title = changed_title(title->get<std::string>(), changes);
}

std::vector<std::string> configuration_differences(const std::string& first, const std::string& second) {
  const Json a = parse_json(first, "configuration"), b = parse_json(second, "configuration");
  std::vector<std::string> found;
  differences("", &a, &b, found);
  return found;
}

}  // namespace remote_touch
