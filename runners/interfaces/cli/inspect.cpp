#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/report/report.h"
#include "analysis/storage/block_journal.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_session.h"

namespace remote_touch {
namespace {

struct InspectRequest {
  std::string file;
  bool all = false;
};

// "867 x 3": rows, and numbers in a row. An array of a sweep has one value for each cell and replicate. Its
// text is the lengths of the axes and the number of replicates instead: "3 x 7 x 3".
class Extents {
 public:
  explicit Extents(const Hdf5Content& content) {
    scales_ = split_names(attribute(content.attributes, "axes"));
    scales_.emplace_back("replicate");
    for (const std::string& scale : scales_)
      for (const auto& [path, column] : content.datasets)
        if (path == "/sweep/" + scale) {
          text_ += (text_.empty() ? "" : " x ") + std::to_string(column.length());
          runs_ *= column.length(), ++dimensions_;
        }
  }
  std::string of(const std::string& path, const Column& column) const {
    const bool is_scale = std::any_of(scales_.begin(), scales_.end(),
                                      [&](const std::string& scale) { return path == "/sweep/" + scale; });
    const std::size_t size = column.length() * static_cast<std::size_t>(column.width);
    if (path.starts_with("/sweep/") && !is_scale && dimensions_ > 1 && size == runs_) return text_;
    return std::to_string(column.length()) + " x " + std::to_string(column.width);
  }
  const std::string& of_sweep() const { return text_; }

 private:
  std::vector<std::string> scales_;
  std::string text_;
  std::size_t runs_ = 1;
  int dimensions_ = 0;
};

// Returns the least, the greatest and the mean of the finite values, and how many values are not finite.
std::string numbers_text(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;
  std::size_t finite = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    low = std::min(low, v), high = std::max(high, v), sum += v;
    ++finite;
  }
  std::string text;
  if (finite > 0) text = formatted("%.6g .. %.6g, mean %.6g", low, high, sum / static_cast<double>(finite));
  if (finite < values.size()) text += formatted("  (%zu not finite)", values.size() - finite);
  return text;
}

// Returns how many of the values each name has, unless it is none. has(value, i): true if it has the i-th
// name.
template <class Value, class Has>
std::string counts_text(const std::vector<std::string>& names, const std::vector<Value>& values,
                        const Has& has) {
  std::vector<std::string> counts;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const auto count =
            std::count_if(values.begin(), values.end(), [&](const Value& value) { return has(value, i); });
        count > 0)
      counts.push_back(names[i] + " " + std::to_string(count));
  return joined(counts, "  ");
}

// Returns the number of texts that are not empty, and the first of them.
std::string texts_text(const std::vector<std::string>& texts) {
  std::size_t count = 0;
  const std::string* first = nullptr;
  for (const std::string& text : texts)
    if (!text.empty() && ++count == 1) first = &text;
  return std::to_string(count) + " not empty" + (first ? ": " + *first : "");
}

// Returns what a column holds: the range and the mean of numbers, the counts of names, the number of texts
// that are not empty and the first of them, or the last of hashes.
std::string values_text(const Column& column) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&column.values)) return numbers_text(*numbers);
  if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values)) return texts_text(*texts);
  if (const auto* hashes = std::get_if<std::vector<std::uint64_t>>(&column.values))
    return hashes->empty() ? "" : formatted("last %016" PRIx64, hashes->back());
  const auto& integers = std::get<std::vector<std::int32_t>>(column.values);
  if (column.value_names.empty()) return numbers_text({integers.begin(), integers.end()});
  return counts_text(column.value_names, integers,
                     [](std::int32_t value, std::size_t i) { return static_cast<std::size_t>(value) == i; });
}

// The unit is told only of columns whose values are told as numbers.
ReportTable table_of_datasets(const Hdf5Content& content) {
  const Extents extents(content);
  const std::vector<std::string> note_kinds = split_names(attribute(content.attributes, "note_kinds"));
  ReportTable table{.has_headings = false};
  for (const auto& [path, column] : content.datasets) {
    const bool has_unit =
        std::holds_alternative<std::vector<double>>(column.values) ||
        (std::holds_alternative<std::vector<std::int32_t>>(column.values) && column.value_names.empty());
    const auto* const bits = std::get_if<std::vector<std::uint64_t>>(&column.values);
    const auto has_bit = [](std::uint64_t notes, std::size_t bit) {
      return bit < 64 && (notes >> bit & 1) != 0;
    };
    const bool has_notes = bits && path == "/sweep/notes";
    ReportRow& row = table.rows.emplace_back();
    row.show("path", path).show("extent", extents.of(path, column), 0);
    row.show("unit", has_unit ? column.units : "");
    row.show("values", has_notes ? counts_text(note_kinds, *bits, has_bit) : values_text(column));
  }
  return table;
}

// Indents the lines of a text, such as the hashes of several inputs, to the column of values.
void add_attribute(Report& report, const std::string& name, const std::string& value) {
  std::istringstream lines(value);
  std::string line;
  std::getline(lines, line);
  report.line(formatted("  %-12s ", printable(name).c_str()) + printable(line));
  while (std::getline(lines, line)) report.line(std::string(15, ' ') + printable(line));
}

// Attributes that only --all prints: programs read them, other lines state them, or they are long.
constexpr std::array kSeldomRead{"axes",          "columns",    "compiler",  "config",     "default",
                                 "flags",         "git_commit", "git_dirty", "isa",        "live_parameters",
                                 "measures",      "note_kinds", "recipe",    "replicates", "schema",
                                 "source_digest", "version",    "view"};
// The attributes of the summary, in its order.
constexpr std::array kInSummary{"title", "command", "made by", "digest"};

// Returns the attributes of the summary; an attribute is empty if the file does not have it.
TextAttributes summary_of(const std::string& file, const TextAttributes& attributes) {
  std::string maker = attribute(attributes, "version");
  if (!maker.empty()) maker += ", " + commit_text(attributes);
  for (const char* const name : {"compiler", "isa"})
    if (const std::string value = attribute(attributes, name); !maker.empty() && !value.empty())
      maker += ", " + value;
  return {{"title", title_of(file, attributes)},
          {"command", attribute(attributes, "command")},
          {"made by", maker},
          {"digest", attribute(attributes, "digest")}};
}

void add_main_attributes(Report& report, const std::string& file, const TextAttributes& attributes) {
  for (const auto& [name, value] : summary_of(file, attributes))
    if (!value.empty()) add_attribute(report, name, value);
  std::size_t more = 0;
  for (const auto& [name, value] : attributes)
    if (std::find(kSeldomRead.begin(), kSeldomRead.end(), name) != kSeldomRead.end())
      ++more;
    else if (std::find(kInSummary.begin(), kInSummary.end(), name) == kInSummary.end())
      add_attribute(report, name, value);
  if (more > 0)
    report.line(formatted("  (%zu more with --all%s)", more,
                          attribute(attributes, "config").empty() ? "" : ", among them the configuration"));
}

void add_attributes(Report& report, const std::string& file, const TextAttributes& attributes, bool all) {
  if (!all) return add_main_attributes(report, file, attributes);
  for (const auto& [name, value] : attributes) {
    if (name == "config" && !value.empty())
      report.line("  config\n" + parse_json(value, file + " config").dump(2));
    else
      add_attribute(report, name, value);
  }
}

// ": trace of 867 ticks", ": sweep of 3 x 4 x 2 runs", ": figure"; empty for a file of another program.
std::string kind_text(const Hdf5Content& content) {
  const std::string schema = attribute(content.attributes, "schema"), ours = "remote-touch-";
  if (!schema.starts_with(ours)) return {};
  const std::string kind = schema.substr(ours.size(), schema.find('/') - ours.size());
  for (const auto& [path, column] : content.datasets)
    if (path == "/trace/time") return ": trace of " + std::to_string(column.length()) + " ticks";
  return ": " + kind + (kind == "sweep" ? " of " + Extents(content).of_sweep() + " runs" : "");
}

// Returns what a user may not expect of a result, a line each.
std::vector<std::string> notes_on(const std::string& file, const Hdf5Content& content) {
  std::vector<std::string> notes;
  if (was_opened_for_writing(file))
    notes.emplace_back("another program opened it for writing; every value is as it was written (SHA-256)");
  const auto is_checksum = [](const auto& dataset) { return dataset.first == "/sweep/checksum"; };
  if (std::any_of(content.datasets.begin(), content.datasets.end(), is_checksum))  // a sweep in progress
    notes.push_back(damage_text(read_sweep(file)));
  notes.push_back(distrust_of(content.attributes));
  std::erase(notes, "");
  return notes;
}

Report report_of_unfinished(const std::string& file, bool all) {
  const UnfinishedSession session = read_unfinished(file);
  Report report;
  report.line(printable(file));
  report.line(formatted("  unfinished, %" PRIu64 " ticks and %" PRIu64 " frames%s", session.ticks,
                        session.frames, session.is_growing ? "; it is being recorded" : ""));
  if (session.has_end) add_attribute(report, "note", "the recording has ended, but its file was not made");
  if (session.left_out_bytes > 0)
    add_attribute(report, "note",
                  "the last " + std::to_string(session.left_out_bytes) +
                      " bytes are left out, from the first damaged or incomplete block on");
  add_attribute(report, "next", "remote-touch recover " + printable(file) + " -o FILE");
  TextAttributes attributes = session.attributes;
  attributes.insert(attributes.end(), session.ending.begin(), session.ending.end());
  add_attributes(report, file, attributes, all);
  return report;
}

// --- a folder with the shards of a sweep ---

// "40 s", "12 min", "3.5 h"
std::string duration_text(double seconds) {
  return seconds < 90     ? formatted("%.0f s", seconds)
         : seconds < 5400 ? formatted("%.0f min", seconds / 60)
                          : formatted("%.1f h", seconds / 3600);
}

// Prints how far the shards of a sweep in a folder are.
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

// --- a tally ---

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

void add_arrays(Report& report, const SweepTally& tally, const Hdf5Content& content) {
  const bool is_whole = tally.cells.size() == tally.cell_count();
  const std::string cells = is_whole ? extent_text(tally) : std::to_string(tally.cells.size()) + " cells";
  report.line(formatted(
      "  arrays below /tally: extent (%s: a value of each cell%s), unit, meaning, and range of the values",
      cells.c_str(), is_whole ? "" : " with runs"));
  ReportTable table{.indent = "    ", .has_headings = false};
  for (const auto& [path, column] : content.datasets) {
    const std::string name = path.substr(path.find('/', 1));
    ReportRow& row = table.rows.emplace_back();
    row.show("array", name.substr(1)).show("extent", extent_of(name, column, tally, cells));
    row.show("unit", column.units == "1" ? "" : column.units);
    row.show("meaning", column.long_name + (is_code(name) ? "" : ": " + values_text(column)));
  }
  report.add(table);
}

// Adds the runs and the measures of a tally. all_arrays: also the extent, unit, meaning and values of each
// of its arrays.
void add_tally(Report& report, const std::string& file, const Hdf5Content& content, bool all_arrays) {
  const StoredTally stored = read_tally(Hdf5Reader(file));
  const SweepTally& tally = stored.tally;
  const CellTally all = tally.over_all_cells();
  report.line(formatted("  tally        %s cells, %d replicates each: %lld of %llu runs done, %lld failed",
                        extent_text(tally).c_str(), tally.replicates, static_cast<long long>(all.done),
                        static_cast<unsigned long long>(tally.run_count()),
                        static_cast<long long>(all.failed)));
  report.line("  measures over all of these runs: mean, least .. greatest, unit, median, meaning");
  ReportTable table{.indent = "    ", .has_headings = false};
  for (std::size_t i = 0; i < all.measures.size(); ++i)
    table.rows.emplace_back()
        .show("measure", tally.measures[i].name)
        .show("values",
              measure_text(all.measures[i], tally.measures[i].units) + "; " + tally.measures[i].long_name);
  report.add(table);
  report.line(note_on_equal_runs(tally, attribute(stored.attributes, "config")));
  if (all_arrays) add_arrays(report, tally, content);
}

Report report_of_file(const std::string& file, bool all) {
  const Hdf5Content content = read_hdf5(file);
  Report report;
  report.line(printable(file) + printable(kind_text(content)));
  for (const std::string& note : notes_on(file, content)) add_attribute(report, "note", note);
  if (is_tally(content.attributes)) {
    TextAttributes others = content.attributes;  // all but those that add_tally() adds
    std::erase_if(others, [](const auto& each) { return each.first.starts_with("measure_"); });
    add_attributes(report, file, others, all);
    add_tally(report, file, content, all);
    return report;
  }
  add_attributes(report, file, content.attributes, all);
  report.add(table_of_datasets(content));
  if (attribute(content.attributes, "schema") == schema_name("sweep"))
    report.line(note_on_equal_runs(read_sweep_outline(Hdf5Reader(file)).result,
                                   attribute(content.attributes, "config")));
  return report;
}

int command_inspect(const CommandLine&, const InspectRequest& request) {
  std::error_code unreachable;
  if (std::filesystem::is_directory(request.file, unreachable)) return inspect_folder(request.file);
  const Report report = is_journal(request.file) ? report_of_unfinished(request.file, request.all)
                                                 : report_of_file(request.file, request.all);
  std::fputs(report.text().c_str(), stdout);
  return kDone;
}

}  // namespace

void add_inspect(Subcommands& commands) {
  auto [inspect, inspected] =
      commands.add("inspect", "show what a result file contains", command_inspect, kNoThreads);
  inspect->add_option("file", inspected->file, "an HDF5 file, or a folder with the shards of a sweep")
      ->required();
  inspect->add_flag("--all", inspected->all,
                    "also show the configuration, all other attributes, and all arrays of a tally");
}

}  // namespace remote_touch
