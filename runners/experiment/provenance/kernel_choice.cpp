#include "runners/experiment/provenance/kernel_choice.h"

#include <cpuid.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "core/kernels/isa.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/cache_file.h"
#include "runners/experiment/provenance/kernel_tasks.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

constexpr double kMeasured_s = 5e-3;

const CacheKind kTimesKind{"levels", kLevelTimesFormat, 4096};

double steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Packs family, model, stepping and name of the processor. They are read with the instruction CPUID, because
// /proc/cpuinfo is long on large machines, and because virtual machines give different processors the same
// name. No more leaves are read than needed: each takes about 10 us in a virtual machine. Every 64-bit
// processor has these leaves.
void add_processor(CacheWriter& pack) {
  constexpr unsigned kSignature = 1, kName[] = {0x80000002, 0x80000003, 0x80000004};
  unsigned a = 0, b = 0, c = 0, d = 0;
  __cpuid(kSignature, a, b, c, d);
  pack.value(a);  // b, c and d depend on the core that runs this
  for (const unsigned leaf : kName) {
    __cpuid(leaf, a, b, c, d);
    for (const unsigned part : {a, b, c, d}) pack.value(part);
  }
}

const Kernels& forced_level(const std::string& forced) {
  for (const Kernels* kernels : supported_kernels())
    if (kernels->isa == forced) return *kernels;
  throw InputError("REMOTE_TOUCH_ISA = " + forced, std::string("expected x86-64 up to ") +
                                                       supported_kernels().back()->isa + " on this machine");
}

}  // namespace

LevelTimes time_supported_levels() {
  return time_levels(supported_kernels(), representative_tasks(), steady_s, kMeasured_s);
}

const Kernels& choose_kernels(const std::string& forced, const fs::path& cache_folder,
                              const std::function<LevelTimes()>& measure) {
  if (!forced.empty()) return forced_level(forced);
  const auto levels = supported_kernels();
  if (levels.size() == 1) return *levels.front();
  const std::string key = level_times_key();
  std::optional<LevelTimes> times = read_level_times(cache_folder, key, levels.size());
  if (!times) {
    times = measure();
    write_level_times(cache_folder, key, *times);
  }
  return *levels[fastest_level(*times)];
}

std::string level_times_key() {
  CacheWriter pack;
  pack.value(kLevelTimesFormat);
  add_processor(pack);
  pack.text(build_for_keys());
  return pack.hex();
}

std::optional<LevelTimes> read_level_times(const fs::path& folder, const std::string& key,
                                           std::size_t levels) {
  LevelTimes times;
  if (!read_cache_file(folder, kTimesKind, key, [&](Unpacker& unpack) { unpack.list(times); })) return {};
  const bool sound = std::all_of(times.begin(), times.end(),
                                 [](double time_s) { return std::isfinite(time_s) && time_s > 0; });
  if (!sound || times.size() != levels) return {};
  return times;
}

bool write_level_times(const fs::path& folder, const std::string& key, const LevelTimes& times) {
  return write_cache_file(folder, kTimesKind, key, [&](CacheWriter& pack) { pack.list(times); });
}

std::string speeds_text(const LevelTimes& times) {
  std::string text;
  for (std::size_t level = 0; level < times.size(); ++level) {
    char speed[32];
    std::snprintf(speed, sizeof speed, " %.2f", times.front() / times[level]);
    text.append(level == 0 ? "" : ", ").append(supported_kernels()[level]->isa).append(speed);
  }
  return text;
}

}  // namespace remote_touch
