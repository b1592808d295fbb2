#include "runners/interfaces/python/outputs.h"

#include <filesystem>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/block_journal.h"
#include "analysis/storage/file_digest.h"
#include "analysis/storage/replacement_rule.h"
#include "core/parameters/input_error.h"
#include "runners/interfaces/python/long_work.h"

namespace remote_touch {

OutputFile::OutputFile(const std::string& file, bool force, const std::string& subject,
                       const std::vector<RecordingPart>& inputs)
    : file_(file) {
  if (file.empty()) return;
  require_different_file(file, subject);
  for (const RecordingPart& part : inputs) require_different_file(file, part.path);
  if (is_journal(file))
    throw InputError(file, "is an unfinished recording and is never overwritten: expected another file");
  const auto may_replace = [force](const std::filesystem::path& place) {
    std::error_code absent;
    const bool holds_something =
        std::filesystem::is_regular_file(place, absent) && std::filesystem::file_size(place, absent) > 0;
    return !is_journal(place) && (force || !holds_something || has_result_header(place));
  };
  if (!may_replace(file))
    throw InputError(file, "exists already and is not a result: expected another file, or force=True");
  require_writable(file);
  set_replacement_rule(file, may_replace);  // it decides again when the result is finished
  lock_.emplace(file);
}

std::string OutputFile::write(const std::function<std::string(const std::string&)>& write,
                              const std::function<std::string()>& without_file) const {
  if (file_.empty()) return without_file();
  const FileTurn turn;
  return write(file_);
}

}  // namespace remote_touch
