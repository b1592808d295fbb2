#include "runners/interfaces/cli/last_resorts.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

namespace {

int exit_code_of_last_resorts = EXIT_FAILURE;
std::terminate_handler without_last_resorts = std::abort;
volatile std::sig_atomic_t found_no_memory = 0;

constexpr std::string_view kNoMemory = "remote-touch: out of memory\n";
constexpr std::string_view kHdf5Failed =
    "remote-touch: the HDF5 library failed: out of memory, or a damaged file\n";

[[noreturn]] void end_at_once(std::string_view why) {
  static_cast<void>(!::write(Hdf5Work::messages(), why.data(), why.size()));
  ::_exit(exit_code_of_last_resorts);
}

// Handles an exception that no caller can catch: one in a thread, or one before main() begins.
[[noreturn]] void on_terminate() {
  try {
    if (std::current_exception()) throw;
  } catch (const std::bad_alloc&) {
    end_at_once(kNoMemory);
  } catch (...) {
  }
  std::signal(SIGABRT, SIG_DFL);
  without_last_resorts();  // says what was thrown
  std::abort();
}

void on_crash(int signal) {
  if (Hdf5Work::is_on()) end_at_once(kHdf5Failed);
  if (found_no_memory) end_at_once(kNoMemory);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void on_exit_by_a_library() {
  if (Hdf5Work::is_on()) end_at_once(kHdf5Failed);
}

[[noreturn]] void note_that_memory_ran_out() {
  found_no_memory = 1;
  throw std::bad_alloc();
}

void take_if_free(int signal) {
  struct sigaction now {};
  if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) return;
  now.sa_handler = on_crash;
  now.sa_flags = SA_ONSTACK;
  ::sigaction(signal, &now, nullptr);
}

// The HDF5 library may use up the stack: it calls itself endlessly if its first call finds no memory. The
// signal handlers therefore run on a stack of their own.
void use_own_stack() {
  static char room[1 << 16];
  stack_t own{};
  own.ss_sp = room, own.ss_size = sizeof room;
  ::sigaltstack(&own, nullptr);
}

}  // namespace

void install_last_resorts(int exit_code) {
  exit_code_of_last_resorts = exit_code;
  without_last_resorts = std::set_terminate(on_terminate);
  std::set_new_handler(note_that_memory_ran_out);
  std::atexit(on_exit_by_a_library);
  use_own_stack();
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT}) take_if_free(signal);
}

}  // namespace remote_touch
