// `inspect` of a folder with the shards of a sweep, and of a tally: its measures over all runs, and what each
// of its arrays is.
#include <algorithm>
#include <cstdio>
#include <initializer_list>

#include "analysis/tally/tally_file.h"
#include "core/parameters/input_error.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/sweep_summary.h"
#include "runners/sweep/shards/shard_folder.h"
#include "runners/sweep/tally_outline.h"

namespace remote_touch {

namespace {

// "40 s", "12 min", "3.5 h"
std::string duration_text(double seconds) {
  char text[32];
  if (seconds < 90)
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  else if (seconds < 5400)
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60);
  else
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
  return text;
}

}  // namespace

int inspect_folder(const std::string& folder) {
  const SweepProgress all = progress_of_shards(folder);
  std::printf("%s: %s\n", printable(folder).c_str(), printable(all.title).c_str());
  std::printf("  %d shards: %zu finished, %zu running, %zu stopped, %zu not begun\n", all.shard_count,
              all.count(ShardState::finished), all.count(ShardState::running), all.count(ShardState::stopped),
              all.count(ShardState::absent));
  std::printf("  %zu of %zu runs done, %zu failed", all.done(), all.runs, all.failed());
  if (const auto left = all.left_s())
    std::printf(", about %s left at the present speed", duration_text(*left).c_str());
  std::puts("");
  for (const ShardProgress& shard : all.files)
    if (shard.state == ShardState::running || shard.state == ShardState::stopped)
      std::printf("  %s: shard %s, %s: %zu of %zu runs, written %s ago\n",
                  shard.state == ShardState::running ? "running" : "stopped", shard.shards.text().c_str(),
                  printable(shard.file).c_str(), shard.done + shard.failed, shard.runs,
                  duration_text(shard.written_s_ago).c_str());
  for (const ShardProgress& shard : all.files)
    if (!shard.distrust.empty())
      std::printf("  %s: %s\n", printable(shard.file).c_str(), printable(shard.distrust).c_str());
  for (const std::string& line : all.unread) std::printf("  not read: %s\n", printable(line).c_str());
  return all.unread.empty() ? kDone : kCheckFailed;
}

namespace {

bool ends_with_one_of(const std::string& name, std::initializer_list<const char*> ends) {
  return std::any_of(ends.begin(), ends.end(), [&](const char* end) { return name.ends_with(end); });
}

// True for an array whose numbers mean nothing by themselves: numbers of runs and buckets, parts of sums.
bool is_code(const std::string& name) {
  return name.find("/far_buckets/") != std::string::npos ||
         ends_with_one_of(name,
                          {"/part", "/held_runs", "/note_kind", "/note_first", "/sum", "/sum_of_squares",
                           "/median_bucket", "/bucket_offset", "/bucket_values", "/run", "/cell"});
}

// True for a list, or for the values along a dimension.
bool is_list(const std::string& name, const SweepTally& tally) {
  for (const Column& axis : tally.axes)
    if (name == "/" + axis.name) return true;
  return name.starts_with("/errors/") || name.find("/far_buckets/") != std::string::npos ||
         ends_with_one_of(name, {"/part", "/held_runs", "/note_kind", "/bucket_offset", "/run", "/cell"});
}

// Returns "3 x 4" for an array with one value for each cell, "27 x 3 x 4" for one with 27 values for each
// cell, and the length of a list.
std::string extent_of(const std::string& name, const Column& column, const SweepTally& tally,
                      const std::string& cells) {
  const std::size_t size = column.length() * static_cast<std::size_t>(column.width);
  if (is_list(name, tally)) return std::to_string(size);
  return size == tally.cells.size() ? cells : std::to_string(size / tally.cells.size()) + " x " + cells;
}

void print_arrays(const SweepTally& tally, const Hdf5Content& content) {
  const bool is_whole = tally.cells.size() == tally.cell_count();
  const std::string cells =
      is_whole ? extent_text(outline_of(tally)) : std::to_string(tally.cells.size()) + " cells";
  std::printf(
      "  arrays below /tally: extent (%s: a value of each cell%s), unit, meaning, and range of the values\n",
      cells.c_str(), is_whole ? "" : " with runs");
  std::size_t width = 0;
  for (const auto& dataset : content.datasets) width = std::max(width, dataset.first.size());
  for (const auto& [path, column] : content.datasets) {
    const std::string name = path.substr(path.find('/', 1));
    std::printf("    %-*s  %-14s  %-6s %s", static_cast<int>(width - 7), name.c_str() + 1,
                extent_of(name, column, tally, cells).c_str(),
                column.units == "1" ? "" : column.units.c_str(), printable(column.long_name).c_str());
    if (is_code(name))
      std::puts("");
    else
      std::putchar(':'), print_values(column);
  }
}

}  // namespace

void print_tally(const std::string& file, const Hdf5Content& content) {
  const StoredTally stored = read_tally(Hdf5Reader(file));
  const SweepTally& tally = stored.tally;
  const CellTally all = over_all_cells(tally);
  std::printf("  tally        %s cells, %d replicates each: %lld of %llu runs done, %lld failed\n",
              extent_text(outline_of(tally)).c_str(), tally.replicates, static_cast<long long>(all.done),
              static_cast<unsigned long long>(tally.run_count()), static_cast<long long>(all.failed));
  std::puts("  measures over all of these runs: mean, least .. greatest, unit, median, meaning");
  for (std::size_t i = 0; i < all.measures.size(); ++i)
    std::printf("    %-22s %s; %s\n", tally.measures[i].name.c_str(),
                measure_text(all.measures[i], tally.measures[i].units).c_str(),
                tally.measures[i].long_name.c_str());
  print_equal_runs(outline_of(tally), attribute(stored.attributes, "config"));
  print_arrays(tally, content);
}

}  // namespace remote_touch
