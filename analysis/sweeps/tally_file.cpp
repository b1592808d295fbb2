#include "analysis/sweeps/sweep_tally.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_file.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

// Returns all columns, each with its path below /tally as its name.
std::vector<Column> columns_of(const TallyArrays& arrays) {
  std::vector<Column> columns = arrays.scales;
  for (const auto& array : arrays.arrays) columns.push_back(array.column);
  for (const auto& group : arrays.groups)
    for (Column column : group.columns) {
      column.name = group.name + '/' + column.name;
      columns.push_back(std::move(column));
    }
  return columns;
}

const char* keep_of(const SweepTally& tally) {
  return tally.keeps_events ? "events" : "tally";
}

void require_distinct_names(const std::filesystem::path& file, const SweepTally& tally) {
  std::set<std::string> names;
  for (const std::vector<Column>* columns : {&tally.axes, &tally.measures})
    for (const Column& column : *columns)
      if (!is_free_in_tallies(column.name) || !names.insert(column.name).second)
        throw InputError(file.string(), "an axis or a measure is named " + column.name +
                                            ", like another part of the file: expected another name");
}

// The texts of all measures, one line for each.
std::string lines(const std::vector<Column>& measures, std::string Column::*text) {
  std::vector<std::string> texts;
  for (const Column& measure : measures) texts.push_back(measure.*text);
  return joined(texts, "\n");
}

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char character : text)
    if (character == '\n')
      lines.emplace_back();
    else
      lines.back() += character;
  return lines;
}

void write_root(Hdf5Writer& hdf5, const SweepTally& tally, TextAttributes attributes) {
  std::sort(attributes.begin(), attributes.end());
  hdf5.attribute("/", "schema", schema_name("tally"));
  hdf5.attributes("/", attributes);
  hdf5.attribute("/", "axes", joined(names_of(tally.axes), ","));
  hdf5.attribute("/", "measures", joined(names_of(tally.measures), ","));
  hdf5.attribute("/", "measure_units", lines(tally.measures, &Column::units));
  hdf5.attribute("/", "measure_meanings", lines(tally.measures, &Column::long_name));
  hdf5.attribute("/", "replicates", std::to_string(tally.replicates));
  hdf5.attribute("/", "keep", keep_of(tally));
  hdf5.attribute("/", "default", "tally");  // NeXus: what a viewer opens first
}

void write_arrays(Hdf5Writer& hdf5, const SweepTally& tally, const TallyArrays& arrays) {
  hdf5.group("/tally");
  for (const Column& measure : tally.measures) hdf5.group("/tally/" + measure.name);
  for (const Column& scale : arrays.scales) hdf5.columns("/tally", {scale}, scale.name);
  for (const auto& [column, axes] : arrays.arrays)
    hdf5.array("/tally", column, axes, Hdf5Writer::Storage::compact);
  for (const auto& [name, columns] : arrays.groups) {
    hdf5.group("/tally/" + name);
    hdf5.columns("/tally/" + name, columns, "");
  }
  hdf5.attributes("/tally", {{"NX_class", "NXdata"}, {"signal", "runs"}});
}

}  // namespace

std::string digest(const SweepTally& tally) {
  return digest(columns_of(arrays_of(tally)));
}

std::string write_tally(const std::filesystem::path& file, const SweepTally& tally,
                        const TextAttributes& attributes) {
  require_distinct_names(file, tally);
  const TallyArrays arrays = arrays_of(tally);
  const std::string sum = digest(columns_of(arrays));
  Hdf5Writer hdf5;
  write_root(hdf5, tally, attributes);
  write_arrays(hdf5, tally, arrays);
  hdf5.attribute("/", "digest", sum);
  hdf5.save(file);
  return sum;
}

// --- reading ---

namespace {

using Int32s = std::vector<std::int32_t>;

class TallyReader {
 public:
  explicit TallyReader(const Hdf5Reader& file) : hdf5_(file) {
    hdf5_.require_kind("tally", "the result of a sweep that keeps tallies");
    const std::vector<std::string> all = hdf5_.datasets();
    datasets_.insert(all.begin(), all.end());
  }

  SweepTally tally() {
    read_plan();
    read_runs();
    for (std::size_t i = 0; i < tally_.measures.size(); ++i) read_measure(i);
    read_lists();
    if (const std::string wrong = tally_.contradiction(); !wrong.empty()) hdf5_.damaged(wrong);
    require_digest();
    return std::move(tally_);
  }
  std::string text(const std::string& name) const { return attribute(hdf5_.attributes(), name); }

 private:
  bool has(const std::string& name) const { return datasets_.contains("/tally/" + name); }
  // Returns the column of that name, which has its name instead of its path.
  Column column(const std::string& name) const {
    Column column = hdf5_.column("/tally/" + name);
    column.name = name;
    column.width = 1;  // a second dimension is an axis
    return column;
  }
  // Returns all values if length is 0. Throws InputError if there are others than `length`.
  template <class Value>
  std::vector<Value> values(const std::string& name, std::size_t length = 0) const {
    Column read = column(name);
    auto* values = std::get_if<std::vector<Value>>(&read.values);
    if (values == nullptr || (length > 0 && values->size() != length))
      hdf5_.damaged("/tally/" + name + " has another length or type");
    return std::move(*values);
  }
  Int32s counts_or_zeros(const std::string& name) const {
    return has(name) ? values<std::int32_t>(name, cells_) : Int32s(cells_, 0);
  }

  void read_plan() {
    for (const std::string& name : split_names(text("axes"))) tally_.axes.push_back(column(name));
    std::uint64_t runs = 1;
    for (const Column& axis : tally_.axes)
      if (__builtin_mul_overflow(runs, axis.length(), &runs)) hdf5_.damaged("its axes have too many values");
    const std::string replicates = text("replicates");
    const char* const end = replicates.data() + replicates.size();
    if (std::from_chars(replicates.data(), end, tally_.replicates).ptr != end || tally_.replicates < 1)
      hdf5_.damaged("its attribute replicates is not a number of runs");
    if (__builtin_mul_overflow(runs, static_cast<std::uint64_t>(tally_.replicates), &runs) || runs == 0)
      hdf5_.damaged("its axes have too many values, or none");
    tally_.keeps_events = text("keep") == "events";
    if (text("keep") != keep_of(tally_)) hdf5_.damaged("its attribute keep is unknown");
    const std::vector<std::string> names = split_names(text("measures"));
    const std::vector<std::string> units = split_lines(text("measure_units"));
    const std::vector<std::string> meanings = split_lines(text("measure_meanings"));
    if (names.empty() || units.size() != names.size() || meanings.size() != names.size())
      hdf5_.damaged("it names no measures, or not all their units and meanings");
    for (std::size_t i = 0; i < names.size(); ++i)
      tally_.measures.push_back({names[i], units[i], meanings[i], std::vector<double>()});
    if (has("note_kind")) tally_.note_kinds = column("note_kind").value_names;
  }

  void read_runs() {
    if (has("cell")) {
      tally_.cells = values<std::uint64_t>("cell");
    } else {
      const auto cells = values<std::int32_t>("runs");
      if (cells.size() != tally_.cell_count()) hdf5_.damaged("/tally/runs has another length");
      for (std::uint64_t cell = 0; cell < cells.size(); ++cell) tally_.cells.push_back(cell);
    }
    cells_ = tally_.cells.size();
    if (cells_ == 0) hdf5_.damaged("it has no cells");
    const auto runs = values<std::int32_t>("runs", cells_), failed = values<std::int32_t>("failed", cells_);
    tally_.tallies.assign(cells_, CellTally(tally_.layout()));
    for (std::size_t i = 0; i < cells_; ++i) {
      tally_.tallies[i].failed = failed[i];
      tally_.tallies[i].done = std::int64_t{runs[i]} - failed[i];
    }
    read_notes();
    const auto held = values<std::uint64_t>("held_runs");
    if (held.size() % 2 != 0) hdf5_.damaged("/tally/held_runs has another length");
    for (std::size_t i = 0; i < held.size(); i += 2) {
      const std::uint64_t first = held[i], last = held[i + 1];
      if (last < first || last >= tally_.run_count() || (i > 0 && first <= held[i - 1]))
        hdf5_.damaged("its ranges of runs are not increasing");
      tally_.held.add({first, last + 1});
    }
  }

  void read_notes() {
    const std::size_t kinds = tally_.note_kinds.size();
    if (kinds == 0) return;
    const auto runs = values<std::int32_t>("note_runs", kinds * cells_);
    const auto first = values<std::uint64_t>("note_first", kinds * cells_);
    for (std::size_t kind = 0; kind < kinds; ++kind)
      for (std::size_t i = 0; i < cells_; ++i)
        tally_.tallies[i].notes[kind] = {runs[kind * cells_ + i], first[kind * cells_ + i]};
  }

  void read_measure(std::size_t measure) {
    const std::string group = tally_.measures[measure].name + '/';
    const auto finite = values<std::int32_t>(group + "values", cells_);
    const auto unknown = counts_or_zeros(group + "unknown");
    const auto infinite = counts_or_zeros(group + "infinite");
    const auto least = values<double>(group + "least", cells_);
    const auto greatest = values<double>(group + "greatest", cells_);
    for (std::size_t i = 0; i < cells_; ++i) {
      MeasureTally& tally = tally_.tallies[i].measures[measure];
      tally.values = finite[i], tally.unknown = unknown[i], tally.infinite = infinite[i];
      if (finite[i] > 0) tally.least = least[i], tally.greatest = greatest[i];
    }
    read_sums(group + "sum", measure, &MeasureTally::sum);
    read_sums(group + "sum_of_squares", measure, &MeasureTally::squares);
    read_sketch(measure);
  }

  void read_sums(const std::string& name, std::size_t measure, UnroundedSum MeasureTally::*sum) {
    const auto all = values<double>(name);
    if (all.empty() || all.size() % cells_ != 0) hdf5_.damaged("/tally/" + name + " has another length");
    for (std::size_t i = 0; i < cells_; ++i) {
      std::vector<double> parts;
      for (std::size_t at = i; at < all.size() && all[at] != 0; at += cells_) parts.push_back(all[at]);
      std::optional<UnroundedSum> read = UnroundedSum::from_parts(parts);
      if (!read) hdf5_.damaged("/tally/" + name + " is not a sum");
      tally_.tallies[i].measures[measure].*sum = std::move(*read);
    }
  }

  void read_sketch(std::size_t measure) {
    using Buckets = std::vector<std::pair<std::int32_t, std::int64_t>>;
    const std::string group = tally_.measures[measure].name + '/';
    const auto offsets = values<std::int32_t>(group + "bucket_offset");
    const auto medians = values<std::int32_t>(group + "median_bucket", cells_);
    const auto counts = values<std::int32_t>(group + "bucket_values");
    if (counts.size() / cells_ != offsets.size() || counts.size() % cells_ != 0)
      hdf5_.damaged("/tally/" + group + "bucket_values has another length");
    std::vector<Buckets> pairs(cells_);
    for (std::size_t row = 0; row < offsets.size(); ++row)
      for (std::size_t i = 0; i < cells_; ++i)
        if (const std::int32_t count = counts[row * cells_ + i]; count != 0)
          pairs[i].emplace_back(static_cast<std::int32_t>(std::int64_t{medians[i]} + offsets[row]), count);
    if (const std::string far = group + "far_buckets/"; has(far + "cell")) {
      const auto cells = values<std::uint64_t>(far + "cell");
      const auto buckets = values<std::int32_t>(far + "bucket", cells.size());
      const auto in_bucket = values<std::int32_t>(far + "values", cells.size());
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto at = std::lower_bound(tally_.cells.begin(), tally_.cells.end(), cells[i]);
        if (at == tally_.cells.end()) hdf5_.damaged("/tally/" + far + "cell is not in the tally");
        pairs[static_cast<std::size_t>(at - tally_.cells.begin())].emplace_back(buckets[i], in_bucket[i]);
      }
    }
    for (std::size_t i = 0; i < cells_; ++i) {
      std::sort(pairs[i].begin(), pairs[i].end());
      std::optional<QuantileSketch> read = QuantileSketch::from_pairs(pairs[i]);
      if (!read) hdf5_.damaged("/tally/" + group + "bucket_values is not a sketch");
      tally_.tallies[i].measures[measure].sketch = std::move(*read);
    }
  }

  CellTally& tally_of_run(std::uint64_t run) {
    const std::uint64_t cell = run / static_cast<std::uint64_t>(tally_.replicates);
    const auto at = std::lower_bound(tally_.cells.begin(), tally_.cells.end(), cell);
    if (at == tally_.cells.end() || *at != cell) hdf5_.damaged("a run belongs to a cell without a tally");
    return tally_.tallies[static_cast<std::size_t>(at - tally_.cells.begin())];
  }

  void read_lists() {
    if (has("errors/run")) {
      const auto runs = values<std::uint64_t>("errors/run");
      const auto errors = values<std::string>("errors/error", runs.size());
      for (std::size_t i = 0; i < runs.size(); ++i) {
        CellTally& cell = tally_of_run(runs[i]);
        cell.first_failed = runs[i], cell.first_error = errors[i];
      }
    }
    const TallyLayout layout = tally_.layout();
    for (std::size_t i = 0; i < layout.events.size(); ++i) {
      const std::string name = tally_.measures[layout.events[i]].name + "/events/run";
      if (!has(name)) continue;
      for (const std::uint64_t run : values<std::uint64_t>(name)) tally_of_run(run).events[i].push_back(run);
    }
  }

  // The stored arrays have the digest, and are those of the tally that was read: the means, too.
  void require_digest() const {
    const std::vector<Column> expected = columns_of(arrays_of(tally_));
    std::vector<Column> read;
    for (const Column& each : expected) read.push_back(column(each.name));
    if (digest(read) != text("digest") || digest(expected) != text("digest"))
      hdf5_.damaged("its digest does not match");
  }

  const Hdf5Reader& hdf5_;
  std::set<std::string> datasets_;
  SweepTally tally_;
  std::size_t cells_ = 0;  // number of cells with runs
};
// Returns the attributes that write_root() does not add itself.
TextAttributes of_caller(const TextAttributes& all) {
  static const std::set<std::string> added = {"measure_units", "measure_meanings", "replicates", "keep"};
  TextAttributes kept = provenance_of(all);
  std::erase_if(kept, [](const auto& one) { return added.contains(one.first); });
  return kept;
}

}  // namespace

bool is_tally(const TextAttributes& of_root) {
  return attribute(of_root, "schema") == schema_name("tally");
}

bool is_tally(const Hdf5Reader& file) {
  return is_tally(file.attributes());
}

std::string distrust_of(const TextAttributes& attributes) {
  const std::string why = attribute(attributes, kDistrusted);
  return why.empty() ? ""
                     : "some runs are WRONG: " + why + "; make the tally again without the wrong machine";
}

std::string tally_refusal(const TextAttributes& attributes) {
  if (!is_tally(attributes)) return "";
  const std::string distrust = distrust_of(attributes);
  return "is a tally, which keeps no runs" + (distrust.empty() ? "" : " (" + distrust + ")");
}

void require_trusted(const std::filesystem::path& file, const TextAttributes& attributes) {
  if (const std::string why = attribute(attributes, kDistrusted); !why.empty())
    throw InputError(file.string(), "has runs of a machine that computed wrongly (" + why +
                                        "): expected a new file, without the wrong machine");
}

StoredTally read_tally(const Hdf5Reader& file) {
  TallyReader reader(file);
  return {reader.tally(), of_caller(file.attributes())};
}

}  // namespace remote_touch
