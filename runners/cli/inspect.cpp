#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/storage/file_digest.h"
#include "analysis/storage/hdf5_file.h"
#include "runners/cli/commands.h"
#include "runners/settings/json_parameters.h"

namespace remote_touch {

namespace {

// Least, mean and greatest of the finite values, and how many are not.
void print_numbers(const std::string& path, const Column& column, const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;
  std::size_t finite = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    low = std::min(low, v), high = std::max(high, v), sum += v;
    ++finite;
  }
  std::printf("  %-32s %8zu x %d  %-6s", path.c_str(), column.length(), column.width, column.units.c_str());
  if (finite > 0) std::printf("  %.6g .. %.6g, mean %.6g", low, high, sum / static_cast<double>(finite));
  if (finite < values.size()) std::printf("  (%zu not finite)", values.size() - finite);
  std::puts("");
}

void print_states(const std::string& path, const Column& column, const std::vector<std::int32_t>& values) {
  std::printf("  %-32s %8zu x %d  %-6s", path.c_str(), column.length(), column.width, "");
  for (std::size_t i = 0; i < column.value_names.size(); ++i) {
    const auto count = std::count(values.begin(), values.end(), static_cast<std::int32_t>(i));
    if (count > 0) std::printf("  %s %td", column.value_names[i].c_str(), count);
  }
  std::puts("");
}

// How many are not empty, and the first of them.
void print_texts(const std::string& path, const Column& column, const std::vector<std::string>& texts) {
  const auto is_empty = [](const std::string& text) { return text.empty(); };
  const auto first = std::find_if_not(texts.begin(), texts.end(), is_empty);
  std::printf("  %-32s %8zu x %d  %-6s  %td not empty%s%s\n", path.c_str(), column.length(), column.width, "",
              static_cast<std::ptrdiff_t>(texts.size()) - std::count_if(texts.begin(), texts.end(), is_empty),
              first == texts.end() ? "" : ": ", first == texts.end() ? "" : first->c_str());
}

void print_hashes(const std::string& path, const Column& column, const std::vector<std::uint64_t>& values) {
  std::printf("  %-32s %8zu x %d  %-6s", path.c_str(), column.length(), column.width, "");
  if (!values.empty()) std::printf("  last %016" PRIx64, values.back());
  std::puts("");
}

void print(const std::string& path, const Column& column) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&column.values)) {
    print_numbers(path, column, *numbers);
    return;
  }
  if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values)) {
    print_texts(path, column, *texts);
    return;
  }
  if (const auto* hashes = std::get_if<std::vector<std::uint64_t>>(&column.values)) {
    print_hashes(path, column, *hashes);
    return;
  }
  const auto& integers = std::get<std::vector<std::int32_t>>(column.values);
  if (column.value_names.empty())
    print_numbers(path, column, {integers.begin(), integers.end()});
  else
    print_states(path, column, integers);
}

// A text of several lines, as input files make it, stays in its column.
void print_attribute(const std::string& name, std::string value) {
  constexpr const char* kNextLine = "\n               ";
  for (std::size_t at = value.find('\n'); at != std::string::npos; at = value.find('\n', at + 1))
    value.replace(at, 1, kNextLine);
  std::printf("  %-12s %s\n", name.c_str(), value.c_str());
}

}  // namespace

int command_inspect(const CommandLine&, const InspectRequest& request) {
  const std::string& file = request.file;
  const Hdf5Content content = read_hdf5(file);
  std::printf("%s\n", file.c_str());
  if (was_opened_for_writing(file))
    std::puts(
        "  note         another program opened it for writing; every value is as it was written (SHA-256)");
  for (const auto& [name, value] : content.attributes) {
    if (name == "config" && !value.empty())
      std::printf("  config\n%s\n", parse_json(value, file + " config").dump(2).c_str());
    else
      print_attribute(name, value);
  }
  for (const auto& [path, column] : content.datasets) print(path, column);
  return kDone;
}

}  // namespace remote_touch
