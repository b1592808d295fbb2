// For tests that hold times to account, on a machine that is not theirs alone.
#pragma once

namespace remote_touch {

// As RUN_ALL_TESTS(), GoogleTest's flags included. One thread on each processor notes how long it is kept
// from running. A test that fails while that was longer than any of them can bear tells nothing: those that
// failed are started again, in a new process, each time saying so. One that fails while the machine kept time
// has failed, and so has one that fails as often as it may.
int run_timed_tests(int argc, char** argv);

}  // namespace remote_touch
