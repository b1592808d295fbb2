#include "runners/sweep/shard.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

constexpr int kMaxShards = 1000000;

std::optional<int> integer_value(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Returns the value of a variable as an integer; nothing if it is not set or empty. Throws InputError for
// other texts.
std::optional<int> integer_variable(const char* name, const char* text) {
  if (text == nullptr || *text == '\0') return std::nullopt;
  const auto value = integer_value(text);
  if (!value || *value < 0) throw InputError(std::string(name) + " = " + text, "expected integers from 0");
  return value;
}

Shard checked(int index, int count, const std::string& source) {
  if (count < 1 || count > kMaxShards || index < 1 || index > count)
    throw InputError(source, "expected i/N with 1 <= i <= N <= " + std::to_string(kMaxShards));
  return {index, count};
}

// Returns the integers of "3" or "1-3" as a range; {0, 0} for other texts.
std::pair<int, int> range_of(const std::string& text) {
  const std::size_t dash = text.find('-');
  const auto first = integer_value(text.substr(0, dash));
  const auto last = dash == std::string::npos ? first : integer_value(text.substr(dash + 1));
  return {first.value_or(0), last.value_or(0)};
}

}  // namespace

std::string ShardSet::text() const {
  std::string text;
  for (auto at = indices.begin(); at != indices.end();) {
    const int first = *at;
    int last = first;
    for (++at; at != indices.end() && *at == last + 1; ++at) last = *at;
    text +=
        (text.empty() ? "" : ",") + std::to_string(first) + (last > first ? "-" + std::to_string(last) : "");
  }
  return text + "/" + std::to_string(count);
}

ShardSet parse_shards(const std::string& text, const std::string& source) {
  const std::string what = source + ": shard " + text;
  const std::size_t slash = text.find('/');
  ShardSet set;
  set.count = slash == std::string::npos ? 0 : integer_value(text.substr(slash + 1)).value_or(0);
  for (std::size_t at = 0; at <= std::min(slash, text.size());) {
    const std::size_t end = std::min({text.find(',', at), slash, text.size()});
    const auto [first, last] = range_of(text.substr(at, end - at));
    checked(first, set.count, what), checked(last, set.count, what);
    for (int i = first; i <= last; ++i) set.indices.insert(i);
    at = end + 1;
  }
  return set;
}

Shard parse_shard(const std::string& text) {
  const auto slash = text.find('/');
  const auto index = integer_value(text.substr(0, slash));
  const auto count = slash == std::string::npos ? std::nullopt : integer_value(text.substr(slash + 1));
  return checked(index.value_or(0), count.value_or(0), "--shard " + text);
}

std::optional<Shard> shard_from_environment(const std::function<const char*(const char*)>& value_of) {
  const auto variable = [&](const char* name) { return integer_variable(name, value_of(name)); };
  if (const auto id = variable("SLURM_ARRAY_TASK_ID")) {
    const auto count = variable("SLURM_ARRAY_TASK_COUNT");
    if (!count) return std::nullopt;
    const int first = variable("SLURM_ARRAY_TASK_MIN").value_or(0);
    const int step = variable("SLURM_ARRAY_TASK_STEP").value_or(1);
    const int index = (*id - first) / std::max(1, step) + 1;
    return checked(index, *count, "SLURM_ARRAY_TASK_ID = " + std::to_string(*id));
  }
  const auto rank = variable("OMPI_COMM_WORLD_RANK"), size = variable("OMPI_COMM_WORLD_SIZE");
  if (!rank || !size) return std::nullopt;
  return checked(*rank + 1, *size, "OMPI_COMM_WORLD_RANK = " + std::to_string(*rank));
}

}  // namespace remote_touch
