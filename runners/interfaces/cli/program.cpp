#include "runners/interfaces/cli/program.h"

#include <malloc.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_file.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/cli/outputs.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

CLI::App* Subcommands::declare(const char* name, const char* meaning, std::function<int()> threads_wanted,
                               std::function<int()> start) {
  CLI::App* command = app.add_subcommand(name, meaning);
  command->callback([&act = act, &threads = threads, command, threads_wanted = std::move(threads_wanted),
                     start = std::move(start)] {
    if (!command->get_subcommands().empty()) return;  // a subcommand was requested instead
    threads = threads_wanted();
    act = start;
  });
  return command;
}

CLI::Validator between(double low, double high) {
  const auto problem = [=](const std::string& text) {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
    std::ostringstream message;
    message << "Value " << text << " not in range [" << low << " - " << high << "]";
    return message.str();
  };
  return {problem, "NUMBER"};
}

void add_set(CLI::App* command, std::vector<std::string>& overrides, const char* meaning) {
  command->add_option("--set", overrides, meaning)->allow_extra_args(false);
}

void print_replaced(const std::vector<std::string>& overrides) {
  for (const std::string& line : replaced_settings(overrides))
    std::fprintf(stderr, "%s: %s\n", program_identity().name.c_str(), printable(line).c_str());
}

namespace {

// Prints one clear line when a program cannot continue: it has no memory in a thread or before main() begins,
// or it crashes or exits inside the HDF5 library, which does not always survive a lack of memory or a damaged
// file. A crash after a failed allocation counts as a lack of memory, because not every library handles one
// well.

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

// Installs handlers that write this line to standard error, without allocating memory, and exit with this
// code. Results are written whole or not at all, so none is lost. Signal handlers of a sanitizer or a
// debugger stay in place. Any other crash and any other exception that nothing catches ends the process as
// without this call.
void install_last_resorts(int exit_code) {
  exit_code_of_last_resorts = exit_code;
  without_last_resorts = std::set_terminate(on_terminate);
  std::set_new_handler(note_that_memory_ran_out);
  std::atexit(on_exit_by_a_library);
  use_own_stack();
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT}) take_if_free(signal);
}

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

// REMOTE_TOUCH_ISA: the instruction set of the kernels, instead of the highest one.
const Kernels& chosen_kernels() {
  const char* forced = std::getenv("REMOTE_TOUCH_ISA");
  return kernels_of_level(forced != nullptr ? forced : "");
}

// REMOTE_TOUCH_DATA: the folder of recordings and meshes with relative names that do not exist here.
void set_data_folder_from_environment() {
  if (const char* folder = std::getenv("REMOTE_TOUCH_DATA")) set_data_folder(folder);
}

void complain(const std::string& problem) {
  std::fprintf(stderr, "%s: %s\n", program_identity().name.c_str(), printable(problem).c_str());
}

// Runs before the constants of all files are initialised, because that may find no memory.
[[gnu::constructor(101)]] void install_early_last_resorts() {
  install_last_resorts(kBadInput);
}

int interrupted() {
  complain("interrupted: no incomplete file is left");
  return kInterrupted;
}

// Sets the catalog of the program. A program with entries of its own is not the one that the sources
// describe, so results identify it by the name and the SHA-256 of its file.
void set_catalog(Catalog catalog, const std::string& called) {
  if (!own_entries(catalog).is_empty())
    identify_program({std::filesystem::path(called).filename().string(), sha256_of_file("/proc/self/exe")});
  use_catalog(std::move(catalog));
}

CommandLine with_signals() {
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  if (std::signal(SIGHUP, request_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup had set SIG_IGN
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit of file sizes then fails with an error
  std::signal(SIGUSR1, request_report);
  std::signal(SIGUSR2, request_rearm);
  CommandLine line;
  line.stop = &stop_requested;
  line.report = &report_requested;
  line.rearm = &rearm_requested;
  return line;
}

int flushed(int code) {
  if (std::fflush(stdout) != 0 || std::ferror(stdout))
    throw InputError("standard output", "cannot be written: expected a place with room");
  return code;
}

// make_catalog may throw.
int run(const std::function<Catalog()>& make_catalog, int argc, char** argv) {
  // Sweeps build and destroy thousands of scenes. Without these settings, a tenth of the time is spent on
  // returning memory to the system.
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  const CommandLine line = with_signals();
  try {
    set_catalog(make_catalog(), argc > 0 ? argv[0] : "");
    set_data_folder_from_environment();
    return flushed(run_command_line(argc, argv, line, chosen_kernels));
  } catch (const Interrupted&) {
    return interrupted();
  } catch (const InputError& error) {
    if (stop_requested) return interrupted();  // the signal ended the wait for a file
    complain(error.what());
  } catch (const std::bad_alloc&) {
    complain("out of memory");
  } catch (const std::length_error&) {
    complain("out of memory");
  } catch (const std::system_error& error) {
    const bool no_thread = error.code() == std::errc::resource_unavailable_try_again;
    complain(no_thread ? "a thread cannot be started: out of memory, or of threads" : error.what());
  } catch (const std::exception& error) {
    complain(error.what());
  }
  return kBadInput;
}

}  // namespace

int command_line(Catalog catalog, int argc, char** argv) {
  return run([&catalog] { return std::move(catalog); }, argc, argv);
}

int command_line(const std::function<void(Catalog&)>& add_entries, int argc, char** argv) {
  const auto with_added = [&add_entries] {
    Catalog catalog = built_in_catalog();
    add_entries(catalog);
    return catalog;
  };
  return run(with_added, argc, argv);
}

}  // namespace remote_touch
