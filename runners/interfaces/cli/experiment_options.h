// Hints when a name of one kind is given to the command of another.
#pragma once

#include <string>

namespace remote_touch {

// Returns "is a sweep: expected `remote-touch sweep NAME -o FILE`" if the name is not a file, and is a stored
// name that this command does not accept. Returns an empty text otherwise. command: run, sweep or figure.
std::string other_kind(const std::string& name, const std::string& command);

}  // namespace remote_touch
