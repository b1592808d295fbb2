// Writes two traces of random walks, which are as hard to compress as a trace can be. The traces are
// FOLDER/a.h5 and FOLDER/b.h5, whose forces differ from the middle on.
// Usage: walk_traces FOLDER TICKS
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>

#include "analysis/storage/result_file.h"
#include "analysis/trace/trace.h"

namespace {

using namespace remote_touch;

std::vector<Column> walks(std::size_t ticks) {
  std::mt19937_64 random(1);
  std::vector<Column> columns = Trace{}.columns();
  columns.pop_back();
  for (Column& column : columns) {
    const auto width = static_cast<std::size_t>(column.width);
    if (auto* numbers = std::get_if<std::vector<double>>(&column.values)) {
      numbers->assign(ticks * width, 0.1);
      for (std::size_t i = width; i < numbers->size(); ++i)
        (*numbers)[i] = (*numbers)[i - width] + 1e-3 * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
    } else if (auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values)) {
      integers->resize(ticks);
      for (std::int32_t& value : *integers) value = static_cast<std::int32_t>(random() & 1);
    } else {
      auto& hashes = std::get<std::vector<std::uint64_t>>(column.values);
      hashes.resize(ticks);
      for (std::uint64_t& hash : hashes) hash = random();
    }
  }
  for (std::size_t i = 0; i < ticks; ++i) {
    std::get<std::vector<double>>(columns.front().values)[i] = 0.001 * static_cast<double>(i);
    std::get<std::vector<std::int32_t>>(columns[12].values)[i] = static_cast<std::int32_t>(i / 33);
  }
  return columns;
}

void write(const std::filesystem::path& file, const std::vector<Column>& columns) {
  std::vector<Column> all = columns;
  all.push_back({kRunningHash, "1", "", running_hash(columns), 1, {}});
  write_trace(file, all, {{"config", "{}"}}, {});
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t ticks = 0;
  if (argc != 3 || std::from_chars(argv[2], argv[2] + std::strlen(argv[2]), ticks).ec != std::errc()) {
    std::fprintf(stderr, "usage: walk_traces FOLDER TICKS\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::vector<Column> columns = walks(ticks);
  write(folder / "a.h5", columns);
  auto& force = std::get<std::vector<double>>(columns[3].values);
  for (std::size_t i = 3 * (ticks / 2); i < force.size(); ++i) force[i] += 1e-9;
  write(folder / "b.h5", columns);
  return 0;
}
