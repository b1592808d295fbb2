// One clear line where a program can go on no longer: no memory in a thread or before main() begins, and a
// crash or an exit inside the HDF5 library, which does not always survive that it finds no memory or a
// damaged file. A crash after some call found no memory counts as that: not every library takes it well.
#pragma once

namespace remote_touch {

// From now on such an end writes its line to standard error, without memory, and exits with this code.
// Results are written whole or not at all, so none is lost. Signals that a sanitizer or a debugger takes stay
// theirs. Any other crash and any other exception that nothing catches ends the process as without this call.
void install_last_resorts(int exit_code);

}  // namespace remote_touch
