#include "runners/sweep/sweep_session.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "core/parameters/parameter.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

// Finds out which shards of a sweep the files of a merge hold.

class SeenShards {
 public:
  // Throws InputError if one of the shards was added before, or the sweep had another number of shards.
  void add(const std::string& file, const ShardSet& shards);
  const ShardSet& all() const { return all_; }
  bool are_complete() const { return all_.indices.size() == static_cast<std::size_t>(all_.count); }
  void require_complete() const;  // throws InputError, which names the missing shards

 private:
  std::string first_file_;
  std::map<int, std::string> file_of_;
  ShardSet all_;
};

// Removes the attribute `shard` and returns what it states. Throws InputError for the result of a whole
// sweep.
ShardSet take_shards(TextAttributes& attributes, const std::string& file) {
  const auto shard =
      std::find_if(attributes.begin(), attributes.end(), [](const auto& a) { return a.first == "shard"; });
  if (shard == attributes.end())
    throw InputError(file, "is the result of a whole sweep: expected the shards of a sweep");
  const ShardSet shards = parse_shards(shard->second, file);
  attributes.erase(shard);
  return shards;
}

void SeenShards::add(const std::string& file, const ShardSet& shards) {
  if (file_of_.empty()) first_file_ = file, all_.count = shards.count;
  if (shards.count != all_.count)
    throw InputError(file, "is shard " + shards.text() + ": expected shards of a sweep in " +
                               std::to_string(all_.count) + " shards, as " + first_file_ + " is");
  for (const int index : shards.indices)
    if (const auto [twin, is_new] = file_of_.emplace(index, file); !is_new)
      throw InputError(file, "is shard " + Shard{index, shards.count}.text() + ", which is also in " +
                                 twin->second + ": expected each shard once");
  all_.indices.insert(shards.indices.begin(), shards.indices.end());
}

void SeenShards::require_complete() const {
  if (are_complete()) return;
  ShardSet missing{{}, all_.count};
  for (int i = 1; i <= all_.count; ++i)
    if (!all_.indices.contains(i)) missing.indices.insert(i);
  const bool is_one = missing.indices.size() == 1;
  throw InputError("merge", std::string(is_one ? "shard " : "shards ") + missing.text() +
                                (is_one ? " is" : " are") + " missing: expected all of them, or --partial");
}

// Throws InputError unless the part has the runs and the kinds of notes of the sweep of the first file.
void require_same_extent(const std::string& file, const SweepGrid& part, const std::string& first,
                         const SweepGrid& sweep) {
  if (part.run_count() != sweep.run_count()) throw InputError(file, "damaged (another number of runs)");
  if (part.note_kinds != sweep.note_kinds)
    throw InputError(file, "damaged (other kinds of notes than " + first + ")");
}

// Returns the values of a part in memory.
RunSpool::PartValues values_in(const SweepResult& part) {
  return [&part](const std::string& array, std::size_t first, std::size_t count) -> Values {
    const auto slice = [&](const auto& all) -> Values {
      const auto from = all.begin() + static_cast<std::ptrdiff_t>(first);
      return std::decay_t<decltype(all)>(from, from + static_cast<std::ptrdiff_t>(count));
    };
    if (array == "run") return slice(*part.part);
    if (array == "notes") return slice(part.notes);
    if (array == "round") return slice(part.round);
    if (array == "error") return slice(part.error);
    if (array != "state") return slice(part.measure(array));
    std::vector<std::int32_t> states;
    for (std::size_t i = first; i < first + count; ++i)
      states.push_back(static_cast<std::int32_t>(part.state[i]));
    return states;
  };
}

[[noreturn]] void refuse_unfinished(const std::string& file, std::size_t left) {
  throw InputError(file,
                   "is not finished (" + std::to_string(left) +
                       " runs are left): expected a finished shard (repeat its sweep command), or --partial");
}

// Copies the runs of a file. A finished part is read block by block, an unfinished one as a whole.
void add_runs(const Hdf5Reader& hdf5, const MergeRequest& request, RunSpool& spool) {
  const std::string& file = hdf5.file();
  if (!hdf5.has("/sweep/run")) hdf5.damaged("/sweep/run is missing");
  if (!hdf5.has("/sweep/checksum")) {
    const std::size_t held = hdf5.column("/sweep/run").length();
    spool.add(file, held, [&](const std::string& array, std::size_t first, std::size_t count) {
      return hdf5.rows("/sweep/" + array, first, count).values;
    });
    return;
  }
  const StoredSweep stored = read_sweep(hdf5);
  const SweepResult& part = stored.result;
  const std::string damage = damage_text(stored);
  if (request.partial == Partial::no) refuse_unfinished(file, count_of(part, RunState::pending));
  if (!damage.empty() && request.note) request.note(file + ": " + damage);
  spool.add(file, part.held_count(), values_in(part));
}

std::vector<RunState> states_of(const std::vector<std::int32_t>& numbers) {
  std::vector<RunState> states;
  for (const std::int32_t number : numbers) states.push_back(static_cast<RunState>(number));
  return states;
}

// Calls `each` with the runs of the spool, in blocks; with an empty block if there are none.
void for_each_block(RunSpool& spool, const EachBlock& each) {
  const SweepResult& outline = spool.outline();
  SweepResult block(grid_of(outline));
  for (std::size_t first = 0; first == 0 || first < outline.held_count(); first += RunSpool::kWindow) {
    const std::size_t count = std::min(RunSpool::kWindow, outline.held_count() - first);
    const auto numbers = [&](const char* array) {
      return std::get<std::vector<std::int32_t>>(spool.values(array, first, count));
    };
    block.part.emplace(count);
    for (std::size_t i = 0; i < count; ++i) (*block.part)[i] = outline.run_at(first + i);
    for (Column& measure : block.measures) measure.values = spool.values(measure.name, first, count);
    block.state = states_of(numbers("state"));
    block.error = std::get<std::vector<std::string>>(spool.values("error", first, count));
    if (!block.note_kinds.empty())
      block.notes = std::get<std::vector<std::uint64_t>>(spool.values("notes", first, count));
    if (spool.is_refined()) block.round = numbers("round");
    each(block);
  }
}

// Adds the runs of `result` that are done; each place has one state.
void add_done(const SweepResult& result, const std::vector<RunState>& states, std::size_t first_place,
              RunRanges& done) {
  for (std::size_t i = 0; i < states.size(); ++i)
    if (states[i] == RunState::done) {
      const std::uint64_t run = result.run_at(first_place + i);
      done.add({run, run + 1});
    }
}

// Returns the runs that a sweep or a tally holds. The arrays of a finished sweep may be larger than the
// memory, so only their states are read.
RunRanges runs_in(const std::string& file) {
  const Hdf5Reader hdf5(file);
  if (is_tally(hdf5)) return read_tally(hdf5).tally.held;
  SweepResult there;
  if (hdf5.has("/sweep/checksum")) {
    there = read_sweep(hdf5).result;
  } else {
    there = read_sweep_outline(hdf5).result;
    if (hdf5.has("/sweep/run")) there.part = hdf5.values<std::uint64_t>("/sweep/run");
    there.state = states_of(std::get<std::vector<std::int32_t>>(hdf5.column("/sweep/state").values));
  }
  RunRanges done;
  add_done(there, there.state, 0, done);
  return done;
}

RunRanges runs_in(RunSpool& spool) {
  const SweepResult& outline = spool.outline();
  RunRanges done;
  for (std::size_t first = 0; first < outline.held_count(); first += RunSpool::kWindow) {
    const std::size_t count = std::min(RunSpool::kWindow, outline.held_count() - first);
    add_done(outline, states_of(std::get<std::vector<std::int32_t>>(spool.values("state", first, count))),
             first, done);
  }
  return done;
}

// Throws KeptFile if the output has runs that the shards do not hold. merged: returns the runs that these
// hold; only called if the output has runs.
void require_nothing_more(const MergeRequest& request, const std::function<RunRanges()>& merged) {
  std::error_code unreachable;
  if (!std::filesystem::is_regular_file(request.output, unreachable) ||
      std::filesystem::file_size(request.output, unreachable) == 0)
    return;
  RunRanges there;
  try {
    there = runs_in(request.output);
  } catch (const InputError&) {
    if (!request.force) throw;
  }
  if (there.ranges().empty()) return;
  const RunRanges held = merged();
  for (const RunRange& range : there.ranges())
    if (held.count_in(range) < range.end - range.first)
      throw KeptFile(request.output, "holds runs that the shards do not: expected another file");
}

// Writes the merged file by write() and returns its digest.
template <class Write>
std::string or_unchanged(const Write& write) {
  try {
    return write();
  } catch (const InputError& error) {
    throw InputError(error.what() + std::string("; nothing was changed"));
  }
}

struct MergedParts {
  TextAttributes attributes;  // of the merged file
  bool is_whole = true;
};

// Reads the parts, checks that they belong together, and adds each.
template <class Read, class Add>
MergedParts merge_parts(const MergeRequest& request, const Read& read, const Add& add) {
  MergedParts merged;
  SeenShards seen;
  require_no_device(request.output);
  for (const std::string& file : request.shards) {
    std::error_code absent;
    if (std::filesystem::equivalent(file, request.output, absent))
      throw InputError(request.output, "is one of the shards: expected another file");
    const Hdf5Reader hdf5(file);
    auto part = read(hdf5);
    const ShardSet shards = take_shards(part.attributes, file);
    if (&file == &request.shards.front()) merged.attributes = part.attributes;
    require_same_origin({file, part.attributes}, {request.shards.front(), merged.attributes});
    seen.add(file, shards);
    add(hdf5, shards, std::move(part));
  }
  if (request.partial == Partial::no) seen.require_complete();
  merged.is_whole = seen.are_complete();
  if (!merged.is_whole) merged.attributes.emplace_back("shard", seen.all().text());
  return merged;
}

// The array `round` does not tell: an empty shard has none.
bool is_refined(const std::string& file, const TextAttributes& attributes) {
  return parse_json(attribute(attributes, "config"), file + " config").contains("refine");
}

}  // namespace

std::string merge_shards(const MergeRequest& request, const EachBlock& each_block) {
  std::optional<RunSpool> spool;
  const MergedParts parts = merge_parts(
      request, [](const Hdf5Reader& hdf5) { return read_sweep_outline(hdf5); },
      [&](const Hdf5Reader& hdf5, const ShardSet&, const StoredSweep& part) {
        if (!spool) spool.emplace(part.result, is_refined(hdf5.file(), part.attributes), request.output);
        require_same_extent(hdf5.file(), part.result, request.shards.front(), spool->outline());
        add_runs(hdf5, request, *spool);
      });
  spool->complete(parts.is_whole);
  require_nothing_more(request, [&] { return runs_in(*spool); });
  for_each_block(*spool, each_block);
  const auto values = [&](const std::string& array, std::size_t at, std::size_t count) {
    return spool->values(array, at, count);
  };
  return or_unchanged([&] {
    return write_sweep(request.output,
                       SweepInBlocks{spool->outline(), spool->is_refined(), spool->longest_error(), values},
                       parts.attributes);
  });
}

namespace {

StoredTally trusted_tally(const Hdf5Reader& hdf5) {
  StoredTally stored = read_tally(hdf5);
  require_trusted(hdf5.file(), stored.attributes);
  return stored;
}

}  // namespace

SweepTally merge_tallies(const MergeRequest& request) {
  std::optional<SweepTally> merged;
  const MergedParts parts = merge_parts(
      request, trusted_tally, [&](const Hdf5Reader& hdf5, const ShardSet& shards, StoredTally part) {
        const std::size_t held = part.tally.held.count(), all = shards.runs_of(part.tally);
        if (request.partial == Partial::no && held < all) refuse_unfinished(hdf5.file(), all - held);
        if (!merged)
          merged = std::move(part.tally);
        else if (const std::string obstacle = merged->obstacle(part.tally); !obstacle.empty())
          throw InputError(hdf5.file(), "cannot be added (" + obstacle + "): expected shards of one sweep");
        else
          merged->add(std::move(part.tally));
      });
  require_nothing_more(request, [&] { return merged->held; });
  or_unchanged([&] { return write_tally(request.output, *merged, parts.attributes); });
  return *std::move(merged);
}

}  // namespace remote_touch
