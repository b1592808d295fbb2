#include "analysis/sweeps/sweep_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_file.h"
#include "core/parameters/parameter.h"

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

Column notes_column(const SweepResult& result) {
  return {"notes", "1", "notes on the run, one bit for each of note_kinds", result.notes};
}

Column error_column(const SweepResult& result) {
  return {"error", "1", "why the run failed", result.error};
}

Column round_column(const SweepResult& result) {
  return {"round", "1", "round of refinement that added the run; -1 if none did", result.round};
}

// pre: the result is a part.
Column run_column(const SweepResult& result) {
  return {"run", "1", "number of the run in the whole sweep", *result.part};
}

Column replicate_column(const SweepResult& result) {
  std::vector<std::int32_t> numbers;
  for (int i = 0; i < result.replicates; ++i) numbers.push_back(i);
  return {"replicate", "1", "repetition with other noise", numbers};
}

using Storage = Hdf5Writer::Storage;

std::vector<std::int32_t> checksums(const SweepResult& result) {
  std::vector<std::int32_t> sums;
  for (std::size_t place = 0; place < result.held_count(); ++place) sums.push_back(checksum(result, place));
  return sums;
}

}  // namespace

std::string plan_digest(const SweepResult& result, TextAttributes attributes) {
  std::sort(attributes.begin(), attributes.end());
  std::vector<std::string> texts;
  for (const auto& [name, value] : attributes) texts.push_back(name), texts.push_back(value);
  std::vector<Column> columns = result.axes;
  columns.push_back({"attributes", "1", "", texts});
  if (result.part) columns.push_back(run_column(result));
  if (!result.round.empty()) columns.push_back(round_column(result));
  if (!result.note_kinds.empty()) columns.push_back({"note_kinds", "1", "", result.note_kinds});
  return digest(columns);
}

namespace {

// Writes one array over the given axes. Arrays whose values come in blocks have no values here.
using PutArray = std::function<void(const Column& column, const std::vector<std::string>& axes)>;

// Writes the attributes sorted by name, as a reader returns them, so that a file which is read and written
// again has the same bytes.
void build(Hdf5Writer& hdf5, const SweepResult& result, TextAttributes attributes, Storage storage,
           bool is_refined, const PutArray& put) {
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
  if (result.part) {
    std::vector<Column> runs;  // no list in braces: that would be copied
    runs.push_back(run_column(result));
    hdf5.columns("/sweep", runs, "run");
    axes = {"run"};
  }
  for (const Column& measure : result.measures) put(measure, axes);
  put(state_column(result), axes);
  if (!result.note_kinds.empty()) put(notes_column(result), axes);
  if (storage == Storage::in_place)
    put({"checksum", "1", "checksum of the run's values, only while the sweep runs", checksums(result)},
        axes);
  else
    put(error_column(result), axes);
  if (is_refined) put(round_column(result), axes);
  hdf5.attributes("/sweep", {{"NX_class", "NXdata"}, {"signal", result.measures.front().name}});
}

}  // namespace

// FNV-1a over the run's number, state, values and notes, so that values that belong to another run do not
// pass.
std::int32_t checksum(const SweepResult& result, std::size_t place) {
  std::uint32_t hash = 2166136261u;
  const auto mix = [&hash](std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte, bits >>= 8)
      hash = (hash ^ static_cast<std::uint32_t>(bits & 0xff)) * 16777619u;
  };
  mix(result.run_at(place));
  mix(static_cast<std::uint64_t>(result.state[place]));
  for (const Column& measure : result.measures)
    mix(std::bit_cast<std::uint64_t>(std::get<std::vector<double>>(measure.values)[place]));
  if (!result.notes.empty()) mix(result.notes[place]);
  return static_cast<std::int32_t>(hash);
}

std::string digest(const SweepResult& result) {
  std::vector<Column> columns = result.axes;
  if (result.part) columns.push_back(run_column(result));
  columns.insert(columns.end(), result.measures.begin(), result.measures.end());
  columns.push_back(state_column(result));
  columns.push_back(error_column(result));
  if (!result.round.empty()) columns.push_back(round_column(result));
  return digest(columns);
}

namespace {

// Writes the arrays with their values; `storage` for those that runs change.
void build_whole(Hdf5Writer& hdf5, const SweepResult& result, const TextAttributes& attributes,
                 Storage storage) {
  const auto put = [&](const Column& column, const std::vector<std::string>& axes) {
    hdf5.array("/sweep", column, axes, column.name == "round" ? Storage::compact : storage);
  };
  build(hdf5, result, attributes, storage, !result.round.empty(), put);
}

}  // namespace

std::string write_sweep(const std::filesystem::path& file, const SweepResult& result,
                        const TextAttributes& attributes) {
  const std::string sum = digest(result);
  Hdf5Writer hdf5;
  build_whole(hdf5, result, attributes, Storage::compact);
  hdf5.attribute("/", "digest", sum);
  hdf5.save(file);
  return sum;
}

namespace {

std::string write_blocks(const std::filesystem::path& file, const SweepInBlocks& sweep,
                         const TextAttributes& attributes) {
  const SweepResult& outline = sweep.outline;
  Hdf5Writer hdf5(file);
  ColumnDigest sum;
  const auto add = [&sum](const Column& column) {
    sum.begin(column.name, column.width), sum.add(column.values);
  };
  for (const Column& axis : outline.axes) add(axis);
  if (outline.part) add(run_column(outline));
  const auto put = [&](const Column& column, const std::vector<std::string>& axes) {
    const bool is_in_digest = column.name != "notes";
    if (is_in_digest) sum.begin(column.name, column.width);
    hdf5.array_in_blocks(
        "/sweep", column, axes,
        [&](std::size_t first, std::size_t count) {
          Values values = sweep.values(column.name, first, count);
          if (is_in_digest) sum.add(values);
          return values;
        },
        sweep.longest_error);
  };
  build(hdf5, outline, attributes, Storage::compact, sweep.is_refined, put);
  const std::string text = sum.text();
  hdf5.attribute("/", "digest", text);
  hdf5.save(file);
  return text;
}

}  // namespace

std::string write_sweep(const std::filesystem::path& file, const SweepInBlocks& sweep,
                        const TextAttributes& attributes) {
  try {
    return write_blocks(file, sweep, attributes);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {  // the HDF5 library says why, but not which file
    throw InputError(file.string(), std::string("cannot be written (") + error.what() +
                                        "): expected a writable folder with free space for the file");
  }
}

void write_sweep_in_progress(const std::filesystem::path& file, const SweepResult& result,
                             const TextAttributes& attributes) {
  Hdf5Writer hdf5(Hdf5Writer::Finished::no);
  build_whole(hdf5, result, attributes, Storage::in_place);
  hdf5.save(file);
}

std::size_t size_in_progress(const SweepResult& result, const TextAttributes& attributes) {
  Hdf5Writer hdf5(Hdf5Writer::Finished::no);
  build_whole(hdf5, result, attributes, Storage::in_place);
  return hdf5.size();
}

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

// Results whose maker knows no notes have none.
void read_notes(const SweepReader& reader, std::size_t runs, SweepResult& result) {
  constexpr std::size_t kBits = 64;
  if (!reader.has("notes")) return;
  if (result.note_kinds.empty() || result.note_kinds.size() > kBits)
    reader.damaged("its attribute note_kinds has no names, or too many");
  result.notes = reader.values<std::uint64_t>("notes", runs);
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

namespace {

[[noreturn]] void refuse_record(const std::filesystem::path& file, int error) {
  throw InputError(file.string(),
                   std::string("cannot be written (") + std::strerror(error) +
                       "); finished runs are kept in the file; free some space and repeat the command");
}

}  // namespace

SweepInProgress::SweepInProgress(const std::filesystem::path& file, const SweepResult& result,
                                 const TextAttributes& attributes, bool already_there)
    : file_(file) {
  if (!already_there) write_sweep_in_progress(file, result, attributes);
  const Hdf5Reader there(file);
  for (const Column& measure : result.measures)
    measure_offsets_.push_back(there.offset("/sweep/" + measure.name));
  state_offset_ = there.offset("/sweep/state");
  checksum_offset_ = there.offset("/sweep/checksum");
  if (!result.notes.empty()) notes_offset_ = there.offset("/sweep/notes");
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor_ < 0) refuse_writing(file_, errno, "a writable file");
}

SweepInProgress::~SweepInProgress() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SweepInProgress::record(const SweepResult& result, std::size_t at) {
  const auto place = static_cast<std::int64_t>(at);
  for (std::size_t i = 0; i < measure_offsets_.size(); ++i) {
    const double value = std::get<std::vector<double>>(result.measures[i].values)[at];
    put(measure_offsets_[i] + 8 * place, &value, sizeof value);
  }
  const auto state = static_cast<std::int32_t>(result.state[at]);
  const std::int32_t sum = checksum(result, at);
  put(state_offset_ + 4 * place, &state, sizeof state);
  if (!result.notes.empty()) put(notes_offset_ + 8 * place, &result.notes[at], sizeof result.notes[at]);
  put(checksum_offset_ + 4 * place, &sum, sizeof sum);
}

void SweepInProgress::put(std::int64_t offset, const void* value, std::size_t size) {
  ssize_t written;
  do {
    written = ::pwrite(descriptor_, value, size, offset);
  } while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(size)) return;
  refuse_record(file_, written < 0 ? errno : ENOSPC);
}

void SweepInProgress::flush() {
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) refuse_record(file_, errno);
  if (!is_name_of(file_, descriptor_))
    throw InputError(
        file_.string(),
        "was replaced or removed by another program during the sweep: expected only one that writes it");
}

}  // namespace remote_touch
