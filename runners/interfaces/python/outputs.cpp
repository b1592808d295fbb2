#include "runners/interfaces/python/outputs.h"

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "core/parameters/input_error.h"
#include "runners/interfaces/python/long_work.h"

namespace remote_touch {

OutputFile::OutputFile(const std::string& file, bool force, const std::string& subject,
                       const std::vector<RecordingPart>& inputs)
    : file_(file) {
  if (file.empty()) return;
  require_different_file(file, subject);
  for (const RecordingPart& part : inputs) require_different_file(file, part.path);
  require_output(file, {.is_ours = has_result_header, .force = force, .force_option = "force=True"});
  lock_.emplace(file);
}

std::string OutputFile::write(const std::function<std::string(const std::string&)>& write,
                              const std::function<std::string()>& without_file) const {
  if (file_.empty()) return without_file();
  const FileTurn turn;
  return write(file_);
}

}  // namespace remote_touch
