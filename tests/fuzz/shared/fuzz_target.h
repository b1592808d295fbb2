// A fuzz target: one reader of the program, which receives bytes of any origin.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/parameters/parameter.h"

namespace remote_touch::fuzz {

struct Target {
  const char* name;  // name of its corpus and its program
  // Reads the bytes as a user's file or message. It may return. An exception is a finding.
  void (*read)(std::string_view bytes);
};

// The targets of this program: those of one file in a program of libFuzzer, all in the program that replays
// the corpus.
std::vector<Target>& targets();

// A global of this type in a target's file adds the target to the list.
struct Registered {
  Registered(const char* name, void (*read)(std::string_view bytes)) { targets().push_back({name, read}); }
};

// Throws std::logic_error if a required property of a reader does not hold.
void require(bool is_true, const char* what);
// Requires also that the message contains no library's own text, unless it quotes that from the bytes.
void require_one_line(const std::string& message, std::string_view bytes);

// A reader may answer with an InputError in one line. All other exceptions pass through: a message of a
// library, or std::bad_alloc, is a finding. bytes is the input.
template <class Read>
bool accepts(std::string_view bytes, Read&& read) {
  try {
    read();
    return true;
  } catch (const InputError& refusal) {
    require_one_line(refusal.what(), bytes);
    return false;
  }
}

// Writes a file of that name with these bytes in a folder of this process, for readers that need one, and
// returns its path. The folder is below TMPDIR, which scripts/fuzz puts into memory, and is removed at the
// end.
std::filesystem::path scratch_file(const std::string& name, std::string_view bytes);

}  // namespace remote_touch::fuzz
