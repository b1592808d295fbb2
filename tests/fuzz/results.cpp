// Results, as text (content_text.h): they are read, compared and exported. The list of baselines is read,
// too.
#include <algorithm>
#include <sstream>

#include "analysis/sweeps/sweep_file.h"
#include "runners/evaluation/regression/baselines.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/presentation/export_formats.h"
#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::results {
namespace {

// Two results of any kind, separated by a line "---": they are read and compared.
// Traces are also hashed, and compared within tolerances.

void compare_as_results(std::string_view bytes) {
  const auto [first, second] = two_parts(bytes);
  const Content a = content_of(first), b = content_of(second);
  accepts(bytes, [&] { report_of(compare_results(reader_of(a), reader_of(b), {})); });
  accepts(bytes, [&] {
    const Outcome outcome = compare_results(reader_of(a), reader_of(a), {}).outcome;
    require(outcome == Outcome::same || outcome == Outcome::not_comparable,
            "a result does not differ from itself");
  });
}

void compare_as_traces(std::string_view bytes) {
  compare_as_results(bytes);
  const auto [first, second] = two_parts(bytes);
  const Content a = content_of(first), b = content_of(second);
  accepts(bytes, [&] { hashes_of_trace(StoredTrace(reader_of(a)), 3); });
  accepts(bytes, [&] { compare_results(reader_of(a), reader_of(b), {{{"*", {1e-6, 0.1}}}}); });
}

const Registered of_figures("figure_file", compare_as_results);
const Registered of_hashes("hashes_file", compare_as_results);
const Registered of_traces("trace_file", compare_as_traces);

// Sweeps in result files, finished or not. A digest "right" is replaced by that of the
// content, so that the code after its check is reached.

std::vector<Column> listed(const Content& content, const char* list) {
  std::vector<Column> columns;
  std::istringstream names(attribute(content.attributes, list));
  for (std::string name; std::getline(names, name, ',');)
    if (const auto found = content.datasets.find("/sweep/" + name); found != content.datasets.end())
      columns.push_back(found->second);
  return columns;
}

template <class Value>
std::vector<Value> values_of(const Content& content, const char* name) {
  const auto found = content.datasets.find(name);
  if (found == content.datasets.end()) return {};
  const auto* values = std::get_if<std::vector<Value>>(&found->second.values);
  return values ? *values : std::vector<Value>();
}

// Builds, unchecked, the result that read_sweep() would return for the content.
SweepResult result_of(const Content& content) {
  SweepResult result;
  result.axes = listed(content, "axes"), result.measures = listed(content, "measures");
  for (Column& measure : result.measures) measure.width = 1;
  for (const std::int32_t state : values_of<std::int32_t>(content, "/sweep/state"))
    result.state.push_back(static_cast<RunState>(state));
  result.error = values_of<std::string>(content, "/sweep/error");
  result.round = values_of<std::int32_t>(content, "/sweep/round");
  if (!content.datasets.contains("/sweep/notes")) return result;
  std::istringstream kinds(attribute(content.attributes, "note_kinds"));
  for (std::string kind; std::getline(kinds, kind, ',');) result.note_kinds.push_back(kind);
  return result;
}

Content with_right_digests(Content content) {
  TextAttributes plan;
  for (const auto& [name, value] : content.attributes)
    if (name != "schema" && name != "digest" && name != "plan_digest" && name != "default" &&
        name != "axes" && name != "measures" && name != "note_kinds")
      plan.emplace_back(name, value);
  const SweepResult result = result_of(content);
  for (auto& [name, value] : content.attributes) {
    if (value != "right") continue;
    if (name == "digest") value = digest(result);
    if (name == "plan_digest") value = plan_digest(result, plan);
  }
  return content;
}

void read_sweep_file(std::string_view bytes) {
  const auto [first, second] = two_parts(bytes);
  const Content a = with_right_digests(content_of(first)), b = with_right_digests(content_of(second));
  accepts(bytes, [&] {
    const StoredSweep stored = read_sweep(reader_of(a));
    const std::size_t runs = stored.result.run_count();
    require(stored.result.state.size() == runs && stored.result.error.size() == runs,
            "every run has a state");
    for (const Column& measure : stored.result.measures)
      require(std::get<std::vector<double>>(measure.values).size() == runs, "every run has its measures");
    for (std::size_t run = 0; run < runs; ++run) stored.result.axis_indices(stored.result.cell_of(run));
  });
  ComparisonRules rules;
  for (const bool paired : {false, true}) {
    rules.paired = paired;
    accepts(bytes, [&] { report_of(compare_results(reader_of(a), reader_of(b), rules)); });
  }
}

const Registered of_sweep_file("sweep_file", read_sweep_file);

// The content of result files as tables for other programs.

void read_tables(std::string_view bytes) {
  const Content content = content_of(bytes);
  accepts(bytes, [&] {
    for (const Table& table : result_tables(reader_of(content))) {
      const std::string header = csv_header(table);
      const std::string lines = csv_rows(table, 0, table.columns.front().length());
      require(header.ends_with('\n') && (lines.empty() || lines.ends_with('\n')), "lines end");
      for (const Column& column : table.columns)
        require(npy_array(column).size() % 2 == 0, "an array of numbers or of characters of four bytes");
    }
  });
}

const Registered of_tables("export", read_tables);

// The list of baselines, and the experiments of its entries.

void read_list(std::string_view bytes) {
  accepts(bytes, [&] {
    const auto folder = scratch_file("baselines/manifest.json", bytes).parent_path();
    for (const Baseline& baseline : read_manifest(folder).baselines) subject_of(folder, baseline);
  });
}

const Registered of_manifest("manifest", read_list);

}  // namespace
}  // namespace remote_touch::fuzz::results
