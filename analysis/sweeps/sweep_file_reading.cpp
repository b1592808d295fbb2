#include <algorithm>
#include <limits>

#include "analysis/storage/hdf5_file.h"
#include "analysis/sweeps/sweep_columns.h"
#include "analysis/sweeps/sweep_file.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

class SweepReader {
 public:
  explicit SweepReader(const Hdf5Reader& file) : hdf5_(file), datasets_(hdf5_.datasets()) {
    hdf5_.require_kind("sweep", "the result of remote-touch sweep or merge");
  }

  std::string text(const std::string& name) const { return attribute(hdf5_.attributes(), name); }
  bool has(const std::string& name) const {
    return std::find(datasets_.begin(), datasets_.end(), "/sweep/" + name) != datasets_.end();
  }
  // Returns an axis. Throws InputError if its values have names and one of them has none.
  Column axis(const std::string& name) const {
    Column column = hdf5_.column("/sweep/" + name);
    const auto* numbers = std::get_if<std::vector<std::int32_t>>(&column.values);
    if (column.value_names.empty() || numbers == nullptr) return column;
    for (const std::int32_t number : *numbers)
      if (number < 0 || static_cast<std::size_t>(number) >= column.value_names.size())
        damaged("/sweep/" + name + " has a value without a name");
    return column;
  }
  // Returns the column of that name. Throws InputError if it has another length or type.
  template <class Value>
  Column column(const std::string& name, std::size_t length) const {
    Column column = hdf5_.column("/sweep/" + name);
    const auto* values = std::get_if<std::vector<Value>>(&column.values);
    if (values == nullptr || values->size() != length)
      damaged("/sweep/" + name + " has another length or type");
    column.width = 1;  // a second dimension is an axis
    return column;
  }
  Column column(const std::string& name) const { return hdf5_.column("/sweep/" + name); }
  template <class Value>
  std::vector<Value> values(const std::string& name) const {
    return hdf5_.values<Value>("/sweep/" + name);
  }
  template <class Value>
  std::vector<Value> values(const std::string& name, std::size_t length) const {
    return std::get<std::vector<Value>>(column<Value>(name, length).values);
  }
  // Number of runs: the product of the axes' lengths and the replicates. A damaged file may name an axis
  // repeatedly, so that the product overflows.
  std::size_t run_count(const SweepResult& result) const {
    auto runs = static_cast<std::size_t>(result.replicates);
    for (const Column& each : result.axes)
      if (__builtin_mul_overflow(runs, each.length(), &runs)) damaged("its axes have too many values");
    if (runs == 0) damaged("it has no runs");
    return runs;
  }
  [[noreturn]] void damaged(const std::string& how) const { hdf5_.damaged(how); }

 private:
  Hdf5Reader hdf5_;
  std::vector<std::string> datasets_;
};

// Marks the runs with a wrong checksum as not made, and returns their number.
std::size_t reset_partial_runs(const std::vector<std::int32_t>& sums, SweepResult& result) {
  std::size_t count = 0;
  for (std::size_t place = 0; place < result.held_count(); ++place) {
    if (sums[place] == checksum(result, place)) continue;
    ++count;
    const bool was_requested = result.round.empty() || result.round[place] >= 0;
    result.state[place] = was_requested ? RunState::pending : RunState::not_sampled;
    for (Column& measure : result.measures)
      std::get<std::vector<double>>(measure.values)[place] = std::numeric_limits<double>::quiet_NaN();
    if (!result.notes.empty()) result.notes[place] = 0;
  }
  return count;
}

void read_part(const SweepReader& reader, std::size_t all_runs, SweepResult& result) {
  if (!reader.has("run")) return;
  result.part = reader.values<std::uint64_t>("run");
  const auto not_increasing = [](std::uint64_t a, std::uint64_t b) { return a >= b; };
  const std::vector<std::uint64_t>& runs = *result.part;
  if (std::adjacent_find(runs.begin(), runs.end(), not_increasing) != runs.end() ||
      (!runs.empty() && runs.back() >= all_runs))
    reader.damaged("/sweep/run does not have increasing numbers of its runs");
}

// Results of earlier versions have no notes.
void read_notes(const SweepReader& reader, std::size_t runs, SweepResult& result) {
  constexpr std::size_t kBits = 64;
  if (!reader.has("notes")) return;
  if (result.note_kinds.empty() || result.note_kinds.size() > kBits)
    reader.damaged("its attribute note_kinds has no names, or too many");
  result.notes = note_numbers(reader.column("notes"));
  if (result.notes.size() != runs) reader.damaged("/sweep/notes has another length or type");
}

void require_known_notes(const SweepReader& reader, const SweepResult& result) {
  const std::size_t kinds = result.note_kinds.size();
  for (const std::uint64_t bits : result.notes)
    if (!SweepResult::are_known_notes(bits, kinds)) reader.damaged("a note is unknown");
}

}  // namespace

StoredSweep read_sweep_outline(const Hdf5Reader& file) {
  const SweepReader reader(file);
  StoredSweep stored;
  SweepResult& result = stored.result;
  stored.attributes = provenance_of(file.attributes());
  stored.schema = reader.text("schema");
  stored.in_progress = reader.has("checksum");
  for (const std::string& name : split_names(reader.text("axes"))) result.axes.push_back(reader.axis(name));
  if (reader.has("replicate")) result.replicates = static_cast<int>(reader.axis("replicate").length());
  reader.run_count(result);
  for (const std::string& name : split_names(reader.text("measures")))
    result.measures.push_back(file.rows("/sweep/" + name, 0, 0));
  for (Column& measure : result.measures) measure.name = measure.name.substr(measure.name.rfind('/') + 1);
  result.note_kinds = split_names(reader.text("note_kinds"));
  if (result.axes.empty() || result.measures.empty()) reader.damaged("it names no axes or no measures");
  return stored;
}

StoredSweep read_sweep(const Hdf5Reader& file) {
  const SweepReader reader(file);
  StoredSweep stored = read_sweep_outline(file);
  SweepResult& result = stored.result;
  read_part(reader, reader.run_count(result), result);
  const std::size_t runs = result.held_count();
  for (Column& measure : result.measures) measure = reader.column<double>(measure.name, runs);
  for (const std::int32_t state : reader.values<std::int32_t>("state", runs)) {
    if (state < 0 || state > static_cast<std::int32_t>(RunState::elsewhere))
      reader.damaged("a state is unknown");
    result.state.push_back(static_cast<RunState>(state));
  }
  read_notes(reader, runs, result);
  if (reader.has("round")) result.round = reader.values<std::int32_t>("round", runs);
  if (stored.in_progress) {
    result.error.resize(runs);
    if (reader.text("plan_digest") != plan_digest(result, stored.attributes))
      reader.damaged("its plan has changed");
    stored.damaged_runs = reset_partial_runs(reader.values<std::int32_t>("checksum", runs), result);
  } else {
    result.error = reader.values<std::string>("error", runs);
    if (reader.text("digest") != digest(result)) reader.damaged("its digest does not match");
  }
  require_known_notes(reader, result);
  for (std::size_t run = 0; run < result.round.size(); ++run)
    if ((result.round[run] < 0) != (result.state[run] == RunState::not_sampled))
      reader.damaged("a sampled run has no round, or a run that is not sampled has one");
  return stored;
}

StoredSweep read_sweep(const std::filesystem::path& file, const RunInChild& run) {
  constexpr int kTries = 20;  // a sweep replaces its file at its end, and before each round of refinement
  for (int i = 1;; ++i) try {
      return read_sweep(Hdf5Reader(file, run));
    } catch (const ReplacedFile&) {
      if (i == kTries) throw;
    }
}

}  // namespace remote_touch
