// Results in the formats of other programs. A further format is one pair of files here and one line in the
// table.
#pragma once

#include <string>
#include <vector>

#include "runners/presentation/export/exported_run.h"

namespace remote_touch {

struct ExportFormat {
  const char* ending;  // ending of the output's name, ".csv"
  const char* meaning;
  bool traces_only;
  void (*write)(const ExportJob& job);
};

const std::vector<ExportFormat>& export_formats();
// Returns all formats in one line, for the help of the command.
std::string known_formats();

// Returns the format of the output's ending. Throws InputError, which names the known endings, if there is
// none.
const ExportFormat& export_format(const std::filesystem::path& output);

// Writes all files of the export; they appear when job.files is finished. Throws InputError for a result of a
// kind that the format does not accept, for one that is damaged, and as job.files does. Throws Interrupted.
void export_result(const ExportFormat& format, const ExportJob& job);

}  // namespace remote_touch
