#include "runners/interfaces/cli/program.h"

int main(int argc, char** argv) {
  return remote_touch::command_line(remote_touch::built_in_catalog(), argc, argv);
}
