// Prints one clear line when a program cannot continue: it has no memory in a thread or before main() begins,
// or it crashes or exits inside the HDF5 library, which does not always survive a lack of memory or a damaged
// file. A crash after a failed allocation counts as a lack of memory, because not every library handles one
// well.
#pragma once

namespace remote_touch {

// Installs handlers that write this line to standard error, without allocating memory, and exit with this
// code. Results are written whole or not at all, so none is lost. Signal handlers of a sanitizer or a
// debugger stay in place. Any other crash and any other exception that nothing catches ends the process as
// without this call.
void install_last_resorts(int exit_code);

}  // namespace remote_touch
