#include "runners/sweep/sweep_session.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/other_processes.h"
#include "core/parameters/parameter.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_run.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

constexpr double kRecent_s = 60;

double seconds_of(const statx_timestamp& time) {
  return static_cast<double>(time.tv_sec) + 1e-9 * time.tv_nsec;
}

double now_s() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

// Fills in the times of the file. Its birth is not known on every file system.
void read_times(const std::filesystem::path& file, ShardProgress& shard) {
  struct statx there = {};
  if (::statx(AT_FDCWD, file.c_str(), 0, STATX_MTIME | STATX_BTIME, &there) != 0) return;
  const double written_s = seconds_of(there.stx_mtime);
  shard.written_s_ago = std::max(0.0, now_s() - written_s);
  if ((there.stx_mask & STATX_BTIME) == 0) return;
  const double took_s = written_s - seconds_of(there.stx_btime);
  if (took_s > 0) shard.runs_per_s = static_cast<double>(shard.done + shard.failed) / took_s;
}

void count_states(const Hdf5Reader& hdf5, ShardProgress& shard) {
  const Column states = hdf5.column("/sweep/state");
  for (const std::int32_t state : std::get<std::vector<std::int32_t>>(states.values)) {
    shard.runs += state != static_cast<std::int32_t>(RunState::elsewhere) &&
                  state != static_cast<std::int32_t>(RunState::not_sampled);
    shard.done += state == static_cast<std::int32_t>(RunState::done);
    shard.failed += state == static_cast<std::int32_t>(RunState::failed);
  }
}

// The file of a shard, as it describes itself.
struct ReadShard {
  ShardProgress progress;
  std::string config, title;
  std::size_t runs_of_sweep = 0;
  bool in_progress = false;
};

void read_runs_of(const Hdf5Reader& hdf5, ReadShard& read) {
  const StoredSweep outline = read_sweep_outline(hdf5);
  read.runs_of_sweep = outline.result.run_count();
  count_states(hdf5, read.progress);
  read.in_progress = outline.in_progress;
}

void read_tally_of(const Hdf5Reader& hdf5, ReadShard& read) {
  const StoredTally stored = read_tally(hdf5);
  read.runs_of_sweep = stored.tally.run_count();
  ShardProgress& shard = read.progress;
  shard.distrust = distrust_of(stored.attributes);
  shard.done = count_of(stored.tally, RunState::done);
  shard.failed = count_of(stored.tally, RunState::failed);
  shard.runs = shard.shards.runs_of(stored.tally);
}

// Returns nothing for a file that is no shard. Throws InputError for a file that cannot be read.
std::optional<ReadShard> read_shard(const std::filesystem::path& file) {
  const Hdf5Reader hdf5(file);
  const std::string shards = attribute(hdf5.attributes(), "shard");
  if (shards.empty()) return std::nullopt;
  ReadShard read;
  ShardProgress& shard = read.progress;
  shard.shards = parse_shards(shards, file.string());
  shard.file = file.filename().string();
  if (is_tally(hdf5))
    read_tally_of(hdf5, read);
  else
    read_runs_of(hdf5, read);
  read.config = attribute(hdf5.attributes(), "config");
  read.title = parse_json(read.config, file.string() + " config").value("title", std::string());
  read_times(file, shard);
  const bool is_recent = is_being_written(file) || shard.written_s_ago < kRecent_s;
  const bool is_finished = !read.in_progress && shard.done + shard.failed == shard.runs;
  shard.state = is_finished ? ShardState::finished : is_recent ? ShardState::running : ShardState::stopped;
  return read;
}

// Reads the file again if its sweep has just replaced it.
std::optional<ReadShard> read_shard_now(const std::filesystem::path& file) {
  try {
    return read_shard(file);
  } catch (const ReplacedFile&) {
    return read_shard(file);
  }
}

// Adds a shard. config: that of the sweep, empty before the first shard. Throws InputError for another sweep.
void add(const ReadShard& read, const std::filesystem::path& file, std::string& config, SweepProgress& all) {
  if (all.files.empty()) {
    config = read.config;
    all.title = read.title, all.runs = read.runs_of_sweep, all.shard_count = read.progress.shards.count;
  }
  if (config != read.config || all.shard_count != read.progress.shards.count)
    throw InputError(file.string(), "is a shard of another sweep than " + all.files.front().file +
                                        ": expected the shards of one sweep in a folder");
  all.files.push_back(read.progress);
}

// Leaves each shard in one file only: a merged file with all its runs comes before the files that it was
// merged from.
void leave_each_shard_once(std::vector<ShardProgress>& files) {
  const auto rank = [](const ShardProgress& file) {
    return std::pair(file.state == ShardState::finished, file.shards.indices.size());
  };
  std::stable_sort(files.begin(), files.end(),
                   [&](const ShardProgress& a, const ShardProgress& b) { return rank(a) > rank(b); });
  std::set<int> seen;
  std::erase_if(files, [&](const ShardProgress& file) {
    const auto is_seen = [&](int index) { return seen.contains(index); };
    if (std::ranges::any_of(file.shards.indices, is_seen)) return true;
    seen.insert(file.shards.indices.begin(), file.shards.indices.end());
    return false;
  });
}

std::vector<std::filesystem::path> results_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code unreachable;
  for (const auto& entry : std::filesystem::directory_iterator(folder, unreachable))
    if (entry.path().extension() == ".h5" && entry.is_regular_file(unreachable))
      files.push_back(entry.path());
  if (unreachable) throw InputError(folder.string(), "cannot be read (" + unreachable.message() + ")");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::size_t SweepProgress::count(ShardState state) const {
  std::size_t found = 0, seen = 0;
  for (const ShardProgress& shard : files) {
    seen += shard.shards.indices.size();
    if (shard.state == state) found += shard.shards.indices.size();
  }
  const auto all = static_cast<std::size_t>(shard_count);
  return state == ShardState::absent ? all - std::min(all, seen) : found;
}

std::size_t SweepProgress::done() const {
  std::size_t sum = 0;
  for (const ShardProgress& shard : files) sum += shard.done;
  return sum;
}

std::size_t SweepProgress::failed() const {
  std::size_t sum = 0;
  for (const ShardProgress& shard : files) sum += shard.failed;
  return sum;
}

std::optional<double> SweepProgress::left_s() const {
  double runs_per_s = 0;
  for (const ShardProgress& shard : files)
    if (shard.state == ShardState::running) runs_per_s += shard.runs_per_s;
  if (!(runs_per_s > 0)) return std::nullopt;
  return static_cast<double>(runs - std::min(runs, done() + failed())) / runs_per_s;
}

SweepProgress progress_of_shards(const std::filesystem::path& folder) {
  SweepProgress all;
  std::string config;
  for (const std::filesystem::path& file : results_in(folder)) {
    std::optional<ReadShard> read;
    try {
      read = read_shard_now(file);
    } catch (const InputError& error) {
      all.unread.push_back(error.what());
    }
    if (read) add(*read, file, config, all);
  }
  if (all.files.empty())
    throw InputError(folder.string(), "has no shards of a sweep: expected files of sweep --shard");
  leave_each_shard_once(all.files);
  const auto first = [](const ShardProgress& shard) { return *shard.shards.indices.begin(); };
  std::sort(all.files.begin(), all.files.end(),
            [&](const ShardProgress& a, const ShardProgress& b) { return first(a) < first(b); });
  return all;
}

namespace {

std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

// Makes the runs, some at a time, and calls take(part) with each part, in their order.
void make_again(const Sweep& sweep, const std::vector<std::uint64_t>& runs, const RecheckOptions& options,
                const std::function<void(const SweepResult& part)>& take) {
  constexpr std::size_t kTogether = 64;
  for (std::size_t first = 0; first < runs.size(); first += kTogether) {
    const std::size_t end = std::min(first + kTogether, runs.size());
    const auto begin = runs.begin();
    SweepResult part =
        sweep.part({begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(end)});
    if (do_pending_runs(sweep, part, {options.kernels, options.stop}) > 0) throw std::bad_alloc();
    take(part);
    if (options.progress) options.progress(end, runs.size());
  }
}

// Returns what differs between a stored run and the same run now; empty if nothing does.
std::string difference(const SweepResult& stored, std::size_t at, const SweepResult& now, std::size_t place) {
  if (stored.state[at] != now.state[place])
    return now.state[place] == RunState::failed ? "was done, now fails: " + now.error[place]
                                                : "failed, now is done";
  for (std::size_t m = 0; m < stored.measures.size(); ++m) {
    const double then = std::get<std::vector<double>>(stored.measures[m].values)[at],
                 again = std::get<std::vector<double>>(now.measures[m].values)[place];
    if (bits(then) != bits(again))
      return stored.measures[m].name + " = " + formatted("%.17g", then) + ", now " +
             formatted("%.17g", again);
  }
  if (!stored.notes.empty() && stored.notes[at] != now.notes[place]) return "has other notes now";
  return "";
}

std::vector<std::uint64_t> chosen_runs(const SweepResult& part, bool every_one) {
  std::vector<std::uint64_t> chosen, all;
  for (std::size_t place = 0; place < part.held_count(); ++place)
    if (part.state[place] == RunState::done || part.state[place] == RunState::failed)
      (every_one || is_rechecked(part.run_at(place)) ? chosen : all).push_back(part.run_at(place));
  if (chosen.empty() && !all.empty()) chosen.push_back(all.front());
  return chosen;
}

// Returns the indices of the chosen cells of the tally.
std::vector<std::size_t> chosen_cells(const SweepTally& tally, bool every_one) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < tally.cells.size(); ++i)
    if (every_one || is_rechecked(tally.cells[i])) chosen.push_back(i);
  if (chosen.empty() && !tally.cells.empty()) chosen.push_back(tally.cells.size() / 2);
  return chosen;
}

// Returns what differs between two tallies that are not equal. name: that of the measure.
std::string difference(const std::string& name, const MeasureTally& then, const MeasureTally& now) {
  const auto part = [&](const char* what, double before, double after) {
    return std::string(what) + " of " + name + " = " + formatted("%.17g", before) + ", now " +
           formatted("%.17g", after);
  };
  if (bits(then.mean()) != bits(now.mean())) return part("mean", then.mean(), now.mean());
  if (bits(then.least) != bits(now.least)) return part("least value", then.least, now.least);
  if (bits(then.greatest) != bits(now.greatest)) return part("greatest value", then.greatest, now.greatest);
  return "other values of " + name + " now, with the same mean";
}

// Returns what differs between the tallies of one cell; empty if nothing does.
std::string difference(const std::vector<Column>& measures, const CellTally& then, const CellTally& now) {
  if (then == now) return "";
  for (std::size_t m = 0; m < measures.size(); ++m)
    if (!(then.measures[m] == now.measures[m]))
      return difference(measures[m].name, then.measures[m], now.measures[m]);
  return "other failed runs, notes or events now";
}

// Returns the runs of a cell that the tally has.
std::vector<std::uint64_t> held_runs(const SweepTally& tally, std::uint64_t cell) {
  const auto replicates = static_cast<std::uint64_t>(tally.replicates);
  std::vector<std::uint64_t> runs;
  for (std::uint64_t run = cell * replicates; run < (cell + 1) * replicates; ++run)
    if (tally.held.count_in({run, run + 1}) > 0) runs.push_back(run);
  return runs;
}

// thing: "run" or "cell". how: what differs; empty if nothing does.
void add_to(Recheck& check, const RecheckOptions& options, const std::string& thing, std::uint64_t number,
            const std::string& how) {
  if (options.each) options.each(number, how);
  if (!how.empty()) check.different.push_back(thing + " " + std::to_string(number) + ": " + how);
}

}  // namespace

Recheck recheck(const SweepResult& part, const Sweep& sweep, const RecheckOptions& options) {
  const std::vector<std::uint64_t> runs = chosen_runs(part, options.all);
  Recheck check{runs.size()};
  make_again(sweep, runs, options, [&](const SweepResult& now) {
    for (std::size_t place = 0; place < now.held_count(); ++place) {
      const std::size_t run = now.run_at(place);
      add_to(check, options, "run", run, difference(part, part.place_of(run).value(), now, place));
    }
  });
  return check;
}

Recheck recheck(const SweepTally& tally, const Sweep& sweep, const RecheckOptions& options) {
  const std::vector<std::size_t> chosen = chosen_cells(tally, options.all);
  Recheck check{0, chosen.size(), tally.cells.size()};
  for (const std::size_t i : chosen) {
    const std::vector<std::uint64_t> runs = held_runs(tally, tally.cells[i]);
    SweepTally now(tally, tally.keeps_events);
    make_again(sweep, runs, options, [&](const SweepResult& made) { add_runs(made, now); });
    check.made += runs.size();
    add_to(check, options, "cell", tally.cells[i],
           difference(tally.measures, tally.tallies[i], now.tallies.front()));
  }
  return check;
}

}  // namespace remote_touch
