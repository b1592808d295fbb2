#include "analysis/sweeps/sweep_regions.h"

#include <charconv>

namespace remote_touch {

namespace {

constexpr std::size_t kMaxParts = 36;

std::string text_of(const Column& axis, std::size_t index) {
  if (const auto* texts = std::get_if<std::vector<std::string>>(&axis.values)) return (*texts)[index];
  const auto number_at = [index](const auto& values) {
    if constexpr (std::is_same_v<decltype(values), const std::vector<std::string>&>)
      return 0.0;
    else
      return static_cast<double>(values[index]);
  };
  const double number = std::visit(number_at, axis.values);
  if (!axis.value_names.empty()) return axis.value_names[static_cast<std::size_t>(number)];
  char text[32];  // 6 digits: 0.3 for 0.30000000000000004
  return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::general, 6).ptr};
}

}  // namespace

bool Region::contains(const std::vector<std::size_t>& indices) const {
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (indices[i] < ranges[i].first || indices[i] >= ranges[i].second) return false;
  return true;
}

std::vector<Region> regions_of(const std::vector<Column>& axes) {
  std::vector<Region> parts = {{"", {}}};
  Region whole{"all runs", {}};
  for (const Column& axis : axes) {
    const std::size_t length = axis.length();
    const bool named =
        !axis.value_names.empty() || std::holds_alternative<std::vector<std::string>>(axis.values);
    whole.ranges.emplace_back(0, length);
    std::size_t count = length <= 4 ? length : length >= 6 && !named ? 3 : 1;
    if (parts.size() * count > kMaxParts) count = 1;
    std::vector<Region> finer;
    for (const Region& part : parts)
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from = i * length / count, to = (i + 1) * length / count;
        finer.push_back(part);
        finer.back().ranges.emplace_back(from, to);
        if (count == 1) continue;
        std::string& label = finer.back().label;
        label += (label.empty() ? "" : ", ") + axis.name + " " + text_of(axis, from);
        if (to - from > 1) label += " to " + text_of(axis, to - 1);
      }
    parts = std::move(finer);
  }
  if (parts.size() == 1) parts.clear();
  parts.insert(parts.begin(), whole);
  return parts;
}

}  // namespace remote_touch
