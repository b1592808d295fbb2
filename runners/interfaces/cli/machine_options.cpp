// The options of live sessions, and of the commands about this machine.
#include <CLI/CLI.hpp>

#include "runners/interfaces/cli/subcommands.h"

namespace remote_touch {

namespace {

void add_live(Subcommands& commands) {
  auto [command, live] = commands.add(
      "live", "run an experiment in real time, with a depth sensor and a haptic device", command_live);
  command
      ->add_option("experiment", live->experiment,
                   "a name from `remote-touch list`, a JSON file, or a recorded live session")
      ->required();
  add_set(command, live->overrides, "parameter=value, for example safety.max_force_N=3");
  command->add_option(
      "--device", live->device,
      "haptic device, SCHEME:ADDRESS; see remote-touch devices (default: sim:, with --view browser:)");
  CLI::Option* const view =
      command->add_flag("--view", live->view, "show the run in a browser, where the mouse moves the hand");
  command->add_option("--view-port", live->view_port, "port of the page on 127.0.0.1; 0: any free port")
      ->check(CLI::Range(0, 65535))
      ->needs(view)
      ->capture_default_str();
  command->add_option("--depth", live->depth, "depth sensor, SCHEME:ADDRESS; see remote-touch devices")
      ->capture_default_str();
  command->add_option("--duration", live->duration_s, "duration in seconds (default: until SIGINT)")
      ->check(between(1e-3, 1e6));
  command->add_option(
      "--record", live->record,
      "record device and sensor to this HDF5 file; until the end the recording is FILE.unfinished");
  command->add_option("-o,--output", live->output, "the HDF5 file for the trace");
  command->add_flag("--strict", live->strict,
                    "a note on the session is an error: exit code 2, after everything is stored");
  command->add_option(
      "--report", live->report,
      "write timing and counts to this HDF5 file (a figure for scripts/plot); also on SIGUSR1");
  auto [recover, kept] = commands.add(
      "recover", "make a recording from the file that an interrupted live session has left", command_recover);
  recover
      ->add_option("file", kept->file, "FILE.unfinished, which live --record FILE leaves; it is not changed")
      ->required();
  recover->add_option("-o,--output", kept->output, "the HDF5 file to write")->required();
  commands.add("devices", "list sensors, haptic devices and OpenCL devices: what was found, or why not",
               command_devices);
  auto [other, jitter] =
      commands.add("jitter", "measure the timing of the haptic loop on this machine", command_jitter);
  other->add_option("--duration", jitter->duration_s, "duration in seconds")
      ->check(between(0.01, 86400.0))
      ->capture_default_str();
  other->add_option("--rate", jitter->rate_hz, "ticks per second")
      ->check(between(1.0, 100000.0))
      ->capture_default_str();
}

void add_cache(Subcommands& commands) {
  auto [command, cache] = commands.add(
      "cache",
      "show folder and size of the cache of tools and measured times, and the instruction set in use",
      command_cache);
  command
      ->add_option("--max", cache->max_MB,
                   "remove the files used longest ago until at most this many MB are left; 0: all files")
      ->check(between(0, 1e9));
}

}  // namespace

void add_commands_of_machines(Subcommands& commands) {
  add_live(commands);
  add_cache(commands);
}

}  // namespace remote_touch
