#include <runners/cli/program.h>

#include "entries.h"

int main(int argc, char** argv) {
  remote_touch::Catalog catalog = remote_touch::built_in_catalog();
  lab::add_entries(catalog);
  return remote_touch::command_line(std::move(catalog), argc, argv);
}
