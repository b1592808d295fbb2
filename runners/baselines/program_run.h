// Running this program, or another build of it, as a user would.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace remote_touch {

std::string this_program();  // the path of the running program

// Runs to its end, without output; environment: set in addition. Throws InputError, naming the program, when
// it cannot be started, or says anything but 0.
void run_program(const std::string& program, const std::vector<std::string>& arguments,
                 const std::map<std::string, std::string>& environment);

}  // namespace remote_touch
