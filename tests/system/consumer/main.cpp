#include <runners/interfaces/cli/program.h>

#include "entries.h"

int main(int argc, char** argv) {
  return remote_touch::command_line(lab::add_entries, argc, argv);
}
