// Runs this program, or another build of it, as a user would.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace remote_touch {

std::string this_program();  // the path of the running program

// Runs a program to its end, without output. environment: variables set in addition; errors: a file for its
// stderr. Throws InputError, naming the program, with the last line of its errors, if it cannot be started,
// or its exit code is not 0 or not known. When stop is set, ends it and throws Interrupted.
void run_program(const std::string& program, const std::vector<std::string>& arguments,
                 const std::map<std::string, std::string>& environment, const std::filesystem::path& errors,
                 const std::atomic<bool>* stop);

}  // namespace remote_touch
