// Checks which files a command may overwrite.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "analysis/storage/other_processes.h"
#include "runners/interfaces/cli/program.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// Locks the output until the lock is destroyed. Throws InputError, before any work is done for the output,
// unless the result can be written there. The folder must be writable. The output must be none of the inputs
// and no plug-in. An existing file must be a result of this program, an empty file or /dev/null, unless
// --force is given. No other process may be writing it. An unfinished recording is never overwritten, not
// even with --force. The rule for existing files is checked again when the result is written.
[[nodiscard]] FileLock lock_output(const CommandLine& line, const std::string& output,
                                   const std::vector<std::string>& inputs);

// The same without a lock.
void require_result(const CommandLine& line, const std::string& output,
                    const std::vector<std::string>& inputs);

// The same for a text report, without a lock: an existing file may be replaced if it begins with `opening`.
void require_report(const CommandLine& line, const std::string& output,
                    const std::vector<std::string>& inputs, const std::string& opening);

// The same for a file that this command has written before with the same text.
void require_text(const CommandLine& line, const std::string& output, const std::vector<std::string>& inputs,
                  const std::string& text);

// The same for a file of an export.
void require_export(const CommandLine& line, const std::string& output,
                    const std::vector<std::string>& inputs, const std::string& opening);

// An option of one command and the file that it names; the file is empty if the option was not given.
// require_distinct() throws InputError if two options name one file, however its path is written, because one
// result would be lost. /dev/null may be named twice.
struct OutputOption {
  const char* option;
  std::string file;
};
void require_distinct(const std::vector<OutputOption>& outputs);

inline constexpr const char* kJsonReport = "{\n  \"baseline\":";
inline constexpr const char* kJsonReports = "[\n  {\n    \"baseline\":";
inline constexpr const char* kClaims = "[\n  {\n    \"figure\":";
inline constexpr const char* kFigureProgress = "{\n \"left_s\":";
inline constexpr const char* kScorecardJson = "{\n \"schema\": \"remote-touch-scorecard/";
inline constexpr const char* kJunitReport = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
inline constexpr const char* kPage = "<!DOCTYPE html>\n<!-- remote-touch view -->";

// The files of an experiment: its own and those that it reads.
std::vector<std::string> with_parts(const std::string& subject, const std::vector<InputPart>& parts);

}  // namespace remote_touch
