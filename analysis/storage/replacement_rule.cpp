#include "analysis/storage/replacement_rule.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/block_journal.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

// A live session also writes its report from another thread.
std::mutex mutex_of_rules;

std::map<std::filesystem::path, ReplacementRule>& rules() {
  static std::map<std::filesystem::path, ReplacementRule> all;
  return all;
}

std::filesystem::path key_of(const std::filesystem::path& target) {
  std::error_code no_folder;
  return std::filesystem::absolute(target, no_folder).lexically_normal();
}

std::optional<ReplacementRule> rule_of(const std::filesystem::path& target) {
  const std::lock_guard lock(mutex_of_rules);
  const auto found = rules().find(key_of(target));
  return found == rules().end() ? std::nullopt : std::optional(found->second);
}

// A device holds no data that could be lost.
bool holds_something(const std::filesystem::path& file) {
  std::error_code absent;
  return std::filesystem::is_regular_file(file, absent) && std::filesystem::file_size(file, absent) > 0;
}

}  // namespace

bool ReplacementRule::allows(const std::filesystem::path& file) const {
  if (is_journal(file)) return false;
  return force || !holds_something(file) || is_ours(file);
}

void set_replacement_rule(const std::filesystem::path& target, ReplacementRule rule) {
  const std::lock_guard lock(mutex_of_rules);
  rules()[key_of(target)] = std::move(rule);
}

void require_output(const std::filesystem::path& output, const ReplacementRule& rule) {
  if (is_journal(output))
    throw KeptFile(output.string(),
                   "is an unfinished recording and is never overwritten: expected another file");
  if (!rule.allows(output))
    throw InputError(output.string(), "exists already and is not " + rule.kind +
                                          " of this program: expected another file, or " + rule.force_option);
  require_writable(output);
  set_replacement_rule(output, rule);
}

// If the first call fails, for example on a file system without RENAME_NOREPLACE, the rule and the second
// call decide.
int rename_by_rule(const std::filesystem::path& temporary, const std::filesystem::path& target) {
  const std::filesystem::path place = resolved(target);
  if (const auto rule = rule_of(target)) {
    if (::renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, place.c_str(), RENAME_NOREPLACE) == 0) return 0;
    std::error_code unreachable;
    if (std::filesystem::exists(std::filesystem::symlink_status(place, unreachable)) && !rule->allows(place))
      return EEXIST;
  }
  return ::rename(temporary.c_str(), place.c_str()) == 0 ? 0 : errno;
}

int rename_or_keep(const std::filesystem::path& temporary, const std::filesystem::path& target) {
  const int error = rename_by_rule(temporary, target);
  if (error != EEXIST) return error;
  // The result gets another name, because the next command with this output would remove the temporary file.
  const std::string kept = resolved(target).string() + ".kept-" + std::to_string(::getpid());
  if (::rename(temporary.c_str(), kept.c_str()) != 0) return errno;
  flush_folder(kept);
  const auto rule = rule_of(target);
  throw InputError(target.string(),
                   "was written by another program while this one computed, and is unchanged: "
                   "the result is in " +
                       kept + ", expected another file, or " + rule.value().force_option);
}

}  // namespace remote_touch
