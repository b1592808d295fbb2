#include "tests/support/timed_tests.h"

int main(int argc, char** argv) {
  return remote_touch::run_timed_tests(argc, argv);
}
