#include "analysis/sweeps/sweep_file.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/sweeps/sweep_columns.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

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

}  // namespace remote_touch
