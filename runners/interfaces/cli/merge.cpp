#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "analysis/storage/file_lock.h"
#include "analysis/sweeps/sweep_file.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/input_hashes.h"
#include "runners/experiment/provenance/recipe.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/sweep_summary.h"
#include "runners/sweep/shard.h"
#include "runners/sweep/stored_sweep.h"

namespace remote_touch {

namespace {

struct ShardFile {
  std::string file;
  Shard shard;
  StoredSweep stored;
};

ShardFile read_part(const std::string& file) {
  ShardFile part{file, {}, read_stored_sweep(file)};
  auto& attributes = part.stored.attributes;
  const auto shard =
      std::find_if(attributes.begin(), attributes.end(), [](const auto& a) { return a.first == "shard"; });
  if (shard == attributes.end())
    throw InputError(file, "is the result of a whole sweep: expected the shards of a sweep");
  part.shard = parse_shard(shard->second);
  attributes.erase(shard);
  const std::size_t pending = part.stored.result.runs_in(RunState::pending).size();
  if (pending > 0 || part.stored.in_progress)
    throw InputError(file, "not finished (" + std::to_string(pending) +
                               " runs are left): expected once its sweep command has ended");
  return part;
}

// Throws InputError unless both files are of one sweep, one build and the same recordings.
void require_same_origin(const ShardFile& part, const ShardFile& first) {
  const TextAttributes &ours = part.stored.attributes, &theirs = first.stored.attributes;
  for (const auto* attributes : {&ours, &theirs})  // either may have one that the other has not
    for (const auto& [name, value] : *attributes)
      // The path of the same file may be written differently.
      if (name != "input_digests" && name != "command" && name != kRecipe &&
          attribute(ours, name) != attribute(theirs, name))
        throw InputError(part.file, "has another " + name + " than " + first.file +
                                        ": expected shards of one sweep, made by one build");
  for (const auto& input :
       changed_inputs(attribute(theirs, "input_digests"), attribute(ours, "input_digests")))
    throw InputError(part.file, "has runs on another recording " + input.path + " (" + input.now + "; " +
                                    first.file + ": " + input.before + "): expected shards of one sweep");
}

// Throws InputError unless each shard is there exactly once, and all are of the same origin.
void require_complete(const std::vector<ShardFile>& parts) {
  const ShardFile& first = parts.front();
  std::map<int, std::string> seen;
  for (const ShardFile& part : parts) {
    if (part.shard.count != first.shard.count)
      throw InputError(part.file, "is shard " + part.shard.text() + ": expected shards of " +
                                      std::to_string(first.shard.count) + ", as " + first.file);
    require_same_origin(part, first);
    if (const auto [twin, is_new] = seen.emplace(part.shard.index, part.file); !is_new)
      throw InputError(part.file,
                       "is shard " + part.shard.text() + ", as is " + twin->second + ": expected once");
  }
  for (int i = 1; i <= first.shard.count; ++i)
    if (seen.count(i) == 0)
      throw InputError("merge",
                       "shard " + Shard{i, first.shard.count}.text() + " is missing: expected all of them");
}

void add(const ShardFile& part, SweepResult& whole) {
  const SweepResult& result = part.stored.result;
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    if (result.state[run] == RunState::elsewhere || result.state[run] == RunState::not_sampled) continue;
    if (whole.state[run] != RunState::elsewhere)
      throw InputError(part.file, "damaged (holds runs of another shard)");
    whole.state[run] = result.state[run];
    whole.error[run] = result.error[run];
    if (!whole.notes.empty()) whole.notes[run] = result.notes[run];
    for (std::size_t i = 0; i < whole.measures.size(); ++i)
      std::get<std::vector<double>>(whole.measures[i].values)[run] =
          std::get<std::vector<double>>(result.measures[i].values)[run];
  }
}

}  // namespace

namespace {

// Returns the sweep in the file; nothing if the file is absent or empty, or if --force lets another file be
// replaced. Throws InputError for another file.
std::optional<StoredSweep> sweep_in(const std::string& file, bool force) {
  std::error_code unreachable;
  if (!std::filesystem::is_regular_file(file, unreachable) ||
      std::filesystem::file_size(file, unreachable) == 0)
    return std::nullopt;
  try {
    return read_sweep(file);
  } catch (const InputError&) {
    if (!force) throw;
    return std::nullopt;
  }
}

// Throws InputError if the file holds runs that the shards do not, because its sweep was refined or
// continued. Such a file is not replaced, not even with --force.
void require_nothing_more(const std::string& file, const SweepResult& whole, bool force) {
  const std::optional<StoredSweep> there = sweep_in(file, force);
  if (!there) return;
  for (std::size_t run = 0; run < there->result.run_count(); ++run)
    if (there->result.state[run] == RunState::done &&
        (run >= whole.run_count() || whole.state[run] != RunState::done))
      throw InputError(file, "holds runs that the shards do not: expected another file");
}

}  // namespace

int command_merge(const CommandLine& line, const MergeRequest& request) {
  std::vector<ShardFile> parts;
  for (const std::string& file : request.shards) {
    std::error_code absent;
    if (std::filesystem::equivalent(file, request.output, absent))
      throw InputError(request.output, "is one of the shards: expected another file");
    parts.push_back(read_part(file));
  }
  require_complete(parts);
  SweepResult whole = parts.front().stored.result;
  for (auto part = parts.begin() + 1; part != parts.end(); ++part) {
    if (part->stored.result.run_count() != whole.run_count())
      throw InputError(part->file, "damaged (another number of runs)");
    if (part->stored.result.note_kinds != whole.note_kinds)
      throw InputError(part->file, "damaged (other kinds of notes than " + parts.front().file + ")");
    add(*part, whole);
  }
  if (!whole.runs_in(RunState::elsewhere).empty())
    throw InputError(parts.front().file, "damaged (runs are missing)");
  const FileLock lock = lock_output(line, request.output, request.shards);
  require_nothing_more(request.output, whole, line.force);
  write_sweep(request.output, whole, parts.front().stored.attributes);
  return print_summary(request.output, whole);
}

}  // namespace remote_touch
