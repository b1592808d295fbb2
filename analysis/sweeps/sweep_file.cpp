#include "analysis/sweeps/sweep_file.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "analysis/storage/digest.h"
#include "analysis/storage/schema.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

Column state_column(const SweepResult& result) {
  std::vector<std::int32_t> numbers;
  for (const RunState state : result.state) numbers.push_back(static_cast<std::int32_t>(state));
  return {"state",
          "1",
          "state of the run",
          std::move(numbers),
          1,
          {"not_sampled", "pending", "done", "failed", "elsewhere"}};
}

namespace {

using Storage = Hdf5Writer::Storage;

Column error_column(const SweepResult& result) {
  return {"error", "1", "why the run failed", result.error};
}
Column round_column(const SweepResult& result) {
  return {"round", "1", "round of refinement that added the run; -1 if none did", result.round};
}
Column notes_column(const SweepResult& result) {
  return {"notes", "1", "notes on the run, one bit for each of note_kinds", result.notes};
}
Column replicate_column(const SweepResult& result) {
  std::vector<std::int32_t> numbers;
  for (int i = 0; i < result.replicates; ++i) numbers.push_back(i);
  return {"replicate", "1", "repetition with other noise", numbers};
}

std::vector<std::int32_t> checksums(const SweepResult& result) {
  std::vector<std::int32_t> sums;
  for (std::size_t run = 0; run < result.run_count(); ++run) sums.push_back(checksum(result, run));
  return sums;
}

}  // namespace

std::string plan_digest(const SweepResult& result, TextAttributes attributes) {
  std::sort(attributes.begin(), attributes.end());
  std::vector<std::string> texts;
  for (const auto& [name, value] : attributes) texts.push_back(name), texts.push_back(value);
  std::vector<Column> columns = result.axes;
  columns.push_back({"attributes", "1", "", texts});
  if (!result.round.empty()) columns.push_back(round_column(result));
  if (!result.note_kinds.empty()) columns.push_back({"note_kinds", "1", "", result.note_kinds});
  return digest(columns);
}

namespace {

// Writes the attributes sorted by name, as a reader returns them, so that a file which is read and written
// again has the same bytes.
void build(Hdf5Writer& hdf5, const SweepResult& result, TextAttributes attributes, Storage storage) {
  std::sort(attributes.begin(), attributes.end());
  hdf5.attribute("/", "schema", schema_name("sweep"));
  hdf5.attributes("/", attributes);
  if (storage == Storage::in_place) hdf5.attribute("/", "plan_digest", plan_digest(result, attributes));
  hdf5.attribute("/", "axes", joined(names_of(result.axes), ","));
  hdf5.attribute("/", "measures", joined(names_of(result.measures), ","));
  if (!result.note_kinds.empty()) hdf5.attribute("/", "note_kinds", joined(result.note_kinds, ","));
  hdf5.attribute("/", "default", "sweep");  // NeXus: what a viewer opens first
  hdf5.group("/sweep");
  std::vector<Column> scales = result.axes;
  if (result.replicates > 1) scales.push_back(replicate_column(result));
  std::vector<std::string> axes;
  for (const Column& scale : scales) hdf5.columns("/sweep", {scale}, axes.emplace_back(scale.name));
  for (const Column& measure : result.measures) hdf5.array("/sweep", measure, axes, storage);
  hdf5.array("/sweep", state_column(result), axes, storage);
  if (!result.note_kinds.empty()) hdf5.array("/sweep", notes_column(result), axes, storage);
  if (!result.round.empty()) hdf5.array("/sweep", round_column(result), axes, Storage::compact);
  if (storage == Storage::in_place)
    hdf5.array(
        "/sweep",
        {"checksum", "1", "checksum of the run's values, only while the sweep runs", checksums(result)}, axes,
        storage);
  else
    hdf5.array("/sweep", error_column(result), axes, storage);
  hdf5.attributes("/sweep", {{"NX_class", "NXdata"}, {"signal", result.measures.front().name}});
}

}  // namespace

// FNV-1a over the run's number, state, values and notes, so that values that belong to another run do not
// pass.
std::int32_t checksum(const SweepResult& result, std::size_t run) {
  std::uint32_t hash = 2166136261u;
  const auto mix = [&hash](std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte, bits >>= 8)
      hash = (hash ^ static_cast<std::uint32_t>(bits & 0xff)) * 16777619u;
  };
  mix(run);
  mix(static_cast<std::uint64_t>(result.state[run]));
  for (const Column& measure : result.measures)
    mix(std::bit_cast<std::uint64_t>(std::get<std::vector<double>>(measure.values)[run]));
  if (!result.notes.empty()) mix(static_cast<std::uint32_t>(result.notes[run]));
  return static_cast<std::int32_t>(hash);
}

std::string digest(const SweepResult& result) {
  std::vector<Column> columns = result.axes;
  columns.insert(columns.end(), result.measures.begin(), result.measures.end());
  columns.push_back(state_column(result));
  columns.push_back(error_column(result));
  if (!result.round.empty()) columns.push_back(round_column(result));
  return digest(columns);
}

std::string write_sweep(const std::filesystem::path& file, const SweepResult& result,
                        const TextAttributes& attributes) {
  const std::string sum = digest(result);
  Hdf5Writer hdf5;
  build(hdf5, result, attributes, Storage::compact);
  hdf5.attribute("/", "digest", sum);
  hdf5.save(file);
  return sum;
}

void write_sweep_in_progress(const std::filesystem::path& file, const SweepResult& result,
                             const TextAttributes& attributes) {
  Hdf5Writer hdf5(Hdf5Writer::Finished::no);
  build(hdf5, result, attributes, Storage::in_place);
  hdf5.save(file);
}

std::size_t size_in_progress(const SweepResult& result, const TextAttributes& attributes) {
  Hdf5Writer hdf5(Hdf5Writer::Finished::no);
  build(hdf5, result, attributes, Storage::in_place);
  return hdf5.size();
}

// --- reading ---

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

void reset_partial_runs(const std::vector<std::int32_t>& sums, SweepResult& result) {
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    if (sums[run] == checksum(result, run)) continue;
    const bool was_requested = result.round.empty() || result.round[run] >= 0;
    result.state[run] = was_requested ? RunState::pending : RunState::not_sampled;
    for (Column& measure : result.measures)
      std::get<std::vector<double>>(measure.values)[run] = std::numeric_limits<double>::quiet_NaN();
    if (!result.notes.empty()) result.notes[run] = 0;
  }
}

// Results of earlier versions have no notes.
void read_notes(const SweepReader& reader, std::size_t runs, SweepResult& result) {
  constexpr std::size_t kBits = 31;  // a number without its sign
  if (!reader.has("notes")) return;
  result.note_kinds = split_names(reader.text("note_kinds"));
  if (result.note_kinds.empty() || result.note_kinds.size() > kBits)
    reader.damaged("its attribute note_kinds has no names, or too many");
  result.notes = reader.values<std::int32_t>("notes", runs);
}

void require_known_notes(const SweepReader& reader, const SweepResult& result) {
  for (const std::int32_t bits : result.notes)
    if (bits < 0 || bits >> result.note_kinds.size() != 0) reader.damaged("a note is unknown");
}

}  // namespace

StoredSweep read_sweep(const Hdf5Reader& file) {
  const SweepReader reader(file);
  StoredSweep stored;
  SweepResult& result = stored.result;
  stored.attributes = provenance_of(file.attributes());
  stored.schema = reader.text("schema");
  stored.in_progress = reader.has("checksum");
  for (const std::string& name : split_names(reader.text("axes"))) result.axes.push_back(reader.axis(name));
  if (reader.has("replicate")) result.replicates = static_cast<int>(reader.axis("replicate").length());
  const std::size_t runs = reader.run_count(result);
  for (const std::string& name : split_names(reader.text("measures")))
    result.measures.push_back(reader.column<double>(name, runs));
  if (result.axes.empty() || result.measures.empty()) reader.damaged("it names no axes or no measures");
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
    reset_partial_runs(reader.values<std::int32_t>("checksum", runs), result);
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
