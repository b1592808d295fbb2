// A whole program from a catalog: every command, with the entries of the catalog beside those of this project.
//
//   int main(int argc, char** argv) {
//     remote_touch::Catalog catalog = remote_touch::built_in_catalog();
//     catalog.add(remote_touch::renderer_entry<Mine>("mine", ...));
//     return remote_touch::command_line(std::move(catalog), argc, argv);
//   }
#pragma once

#include "runners/experiment/catalog.h"

namespace remote_touch {

// Does what the arguments say and returns the exit code: 0 done, 1 a check failed, 2 an input that cannot be used,
// 3 interrupted. Prints errors as one line on standard error; throws nothing. Takes SIGINT, SIGTERM, SIGHUP, SIGUSR1
// and SIGUSR2. If the catalog has entries that are not built in, results record the program's name (argv[0] without
// its folder) and the SHA-256 of its file.
int command_line(Catalog catalog, int argc, char** argv);

}  // namespace remote_touch
