// Files that appear while a command computes are not overwritten.
#pragma once

#include <filesystem>
#include <functional>

namespace remote_touch {

// Returns true if the file at this place may be replaced. It is called only if there is one.
using ReplacementRule = std::function<bool(const std::filesystem::path& place)>;

// Sets the rule for a target for the rest of the process, or until the next call. A target without a rule is
// always replaced. A command checks its output before it computes, and sets the same check as the rule: the
// file may have been written meanwhile.
void set_replacement_rule(const std::filesystem::path& target, ReplacementRule rule);

// Renames the temporary file to the target, or to what the target links to. Returns 0, or the errno of what
// failed: EEXIST if the rule keeps the file that is there. Between the rule and the rename another process
// may still replace a file that the rule allows to replace; a file that appears in an empty place is never
// lost, if the file system supports RENAME_NOREPLACE.
int rename_by_rule(const std::filesystem::path& temporary, const std::filesystem::path& target);

// The same for a finished result. If the rule keeps the file that is there, throws InputError, which names
// the target, and leaves the result beside it as TARGET.kept-PID.
int rename_or_keep(const std::filesystem::path& temporary, const std::filesystem::path& target);

}  // namespace remote_touch
