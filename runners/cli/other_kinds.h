// A name of one kind given to the command of another.
#pragma once

#include <string>

namespace remote_touch {

// "is a sweep: expected `remote-touch sweep NAME -o FILE`" where the name is one of the list that this
// command does not take, nor is it a file; empty otherwise. command: run, sweep or figure.
std::string other_kind(const std::string& name, const std::string& command);

}  // namespace remote_touch
