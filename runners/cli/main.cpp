// remote-touch: signals, the choice of kernels, errors.
#include <malloc.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>

#include "analysis/storage/hdf5_file.h"
#include "core/kernels/isa.h"
#include "core/parameters/input_error.h"
#include "runners/cli/command_line.h"
#include "runners/simulation/simulation.h"
#include "scenarios/recordings/recording_part.h"

namespace {

using namespace remote_touch;

std::atomic<bool> stop_requested{false}, report_requested{false}, rearm_requested{false};

void request_stop(int) {
  stop_requested = true;
}

void request_report(int) {
  report_requested = true;
}

void request_rearm(int) {
  rearm_requested = true;
}

// REMOTE_TOUCH_ISA lowers the instruction set of the kernels, to check that results do not depend on it.
const Kernels& chosen_kernels() {
  const char* requested = std::getenv("REMOTE_TOUCH_ISA");
  const Kernels& best = *supported_kernels().back();
  if (requested == nullptr) return best;
  for (const Kernels* kernels : supported_kernels())
    if (kernels->isa == std::string(requested)) return *kernels;
  throw InputError(std::string("REMOTE_TOUCH_ISA = ") + requested,
                   std::string("expected x86-64 up to ") + best.isa + " on this machine");
}

// REMOTE_TOUCH_DATA: where recordings and meshes with relative names are, if not here.
void take_data_folder() {
  if (const char* folder = std::getenv("REMOTE_TOUCH_DATA")) set_data_folder(folder);
}

void complain(const std::string& problem) {
  std::fprintf(stderr, "remote-touch: %s\n", printable(problem).c_str());
}

// The last resorts, without memory. Results are written whole or not at all, so none is lost.
[[noreturn]] void end_at_once(std::string_view why) {
  static_cast<void>(!::write(Hdf5Work::messages(), why.data(), why.size()));
  ::_exit(kBadInput);
}
// Where no exception can leave: in a thread, or before main() begins.
[[noreturn]] void on_terminate() {
  try {
    if (std::current_exception()) throw;
  } catch (const std::bad_alloc&) {
    end_at_once("remote-touch: out of memory\n");
  } catch (...) {
  }
  std::signal(SIGABRT, SIG_DFL);
  std::abort();
}
constexpr std::string_view kHdf5Failed =
    "remote-touch: the HDF5 library failed: out of memory, or a damaged file\n";
void on_crash(int signal) {
  if (Hdf5Work::is_on()) end_at_once(kHdf5Failed);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}
void on_exit_by_a_library() {
  if (Hdf5Work::is_on()) end_at_once(kHdf5Failed);
}
// Not where a sanitizer or a debugger takes the signal.
void take_if_free(int signal) {
  struct sigaction now {};
  if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) return;
  now.sa_handler = on_crash;
  now.sa_flags = SA_ONSTACK;
  ::sigaction(signal, &now, nullptr);
}
// The library may use up the stack: it calls itself without end where its first call finds no memory.
void use_own_stack() {
  static char room[1 << 16];
  stack_t own{};
  own.ss_sp = room, own.ss_size = sizeof room;
  ::sigaltstack(&own, nullptr);
}
// Before the constants of all files are made, which may find no memory.
[[gnu::constructor(101)]] void prepare_for_the_worst() {
  std::set_terminate(on_terminate);
  std::atexit(on_exit_by_a_library);
  use_own_stack();
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT}) take_if_free(signal);
}

int interrupted() {
  complain("interrupted: no incomplete file is left");
  return kInterrupted;
}

}  // namespace

int main(int argc, char** argv) {
  // Sweeps build and drop scenes by the thousand: memory given back to the system each time costs a tenth.
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  if (std::signal(SIGHUP, request_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // by nohup
  std::signal(SIGUSR1, request_report);
  std::signal(SIGUSR2, request_rearm);
  try {
    take_data_folder();
    CommandLine line;
    line.stop = &stop_requested;
    line.report = &report_requested;
    line.rearm = &rearm_requested;
    const int code = run_command_line(argc, argv, line, chosen_kernels);
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
      throw InputError("standard output", "cannot be written: expected a place with room");
    return code;
  } catch (const Interrupted&) {
    return interrupted();
  } catch (const InputError& error) {
    if (stop_requested) return interrupted();  // it ended the wait for a file
    complain(error.what());
  } catch (const std::bad_alloc&) {
    complain("out of memory");
  } catch (const std::length_error&) {
    complain("out of memory");
  } catch (const std::exception& error) {
    complain(error.what());
  }
  return kBadInput;
}
