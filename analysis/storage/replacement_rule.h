// Files that appear while a command computes are not overwritten.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "core/parameters/input_error.h"

namespace remote_touch {

// The refusal to replace a file that holds what nothing else holds. No option overrides it: code that lets
// --force through a refusal passes this one on.
class KeptFile : public InputError {
 public:
  using InputError::InputError;
};

// Decides which existing files an output may replace. A file without content may always be replaced, an
// unfinished recording never.
struct ReplacementRule {
  // Returns true for a file of this program and of the kind that is written. Not called for an empty file.
  std::function<bool(const std::filesystem::path& file)> is_ours;
  std::string kind = "a result";  // the name of such a file in messages
  bool force = false;             // any other file may be replaced too
  std::string force_option = "--force";

  bool allows(const std::filesystem::path& file) const;
};

// Sets the rule for a target for the rest of the process, or until the next call. A target without a rule is
// always replaced.
void set_replacement_rule(const std::filesystem::path& target, ReplacementRule rule);

// Throws InputError unless the rule allows the output and its folder is writable; KeptFile for an unfinished
// recording. Sets the rule, because the file may be written by others while the result is computed.
void require_output(const std::filesystem::path& output, const ReplacementRule& rule);

// Renames the temporary file to the target, or to what the target links to. Returns 0, or the errno of the
// call that failed: EEXIST if the rule keeps the existing file. If another process replaces an existing file
// between the check of the rule and the rename, its file is lost. A file that appears where there was none is
// never lost, if the file system supports RENAME_NOREPLACE.
int rename_by_rule(const std::filesystem::path& temporary, const std::filesystem::path& target);

// Does the same for a finished result. If the rule keeps the existing file, it throws InputError, which names
// the target, and leaves the result beside it as TARGET.kept-PID.
int rename_or_keep(const std::filesystem::path& temporary, const std::filesystem::path& target);

}  // namespace remote_touch
