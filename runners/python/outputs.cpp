#include "runners/python/outputs.h"

#include <filesystem>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/block_journal.h"
#include "analysis/storage/file_digest.h"
#include "core/parameters/input_error.h"
#include "runners/python/long_work.h"

namespace remote_touch {

OutputFile::OutputFile(const std::string& file, bool force, const std::string& subject,
                       const std::vector<RecordingPart>& inputs)
    : file_(file) {
  if (file.empty()) return;
  require_different_file(file, subject);
  for (const RecordingPart& part : inputs) require_different_file(file, part.path);
  std::error_code absent;
  const bool holds_something =
      std::filesystem::is_regular_file(file, absent) && std::filesystem::file_size(file, absent) > 0;
  if (is_journal(file))
    throw InputError(file, "is an unfinished recording and is never overwritten: expected another file");
  if (holds_something && !force && !has_result_header(file))
    throw InputError(file, "exists already and is not a result: expected another file, or force=True");
  require_writable(file);
  lock_.emplace(file);
}

std::string OutputFile::write(const std::function<std::string(const std::string&)>& write,
                              const std::function<std::string()>& without_file) const {
  if (file_.empty()) return without_file();
  const FileTurn turn;
  return write(file_);
}

}  // namespace remote_touch
