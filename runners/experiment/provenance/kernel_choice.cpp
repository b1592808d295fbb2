#include "runners/experiment/provenance/kernel_choice.h"

#include <cpuid.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string_view>

#include "core/kernels/depth_kernels.h"
#include "core/kernels/isa.h"
#include "core/kernels/lanes.h"
#include "core/kernels/noise_kernels.h"
#include "core/kernels/proxy_kernels.h"
#include "core/kernels/tool_kernels.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/cache_file.h"

namespace remote_touch {
namespace {

// A plane of points below the proxy, 1 mm apart. There are as many as near a proxy with a radius of 5 mm.
struct ProxyStep {
  static constexpr std::size_t kPoints = 104, kAlong = 13;
  std::array<double, kPoints> x{}, y{}, z{};

  ProxyStep() {
    for (std::size_t i = 0; i < kPoints; ++i) {
      const std::size_t column = i % kAlong, row = i / kAlong;
      x[i] = 1e-3 * (static_cast<double>(column) - 6), y[i] = 1e-3 * (static_cast<double>(row) - 3.5);
    }
  }
  void operator()(const Kernels& kernels) const {
    constexpr int kSteps = 24;
    const PointsView points{x.data(), y.data(), z.data(), nullptr, nullptr, kPoints};
    const ProxyRegions regions{4.99e-3, 5.01e-3, 10e-3, 1.5 * 256, 500};
    const double down[3] = {0, 0, -1};
    for (int i = 0; i < kSteps; ++i) {
      const double p[3] = {1e-5 * i, 0, 5e-3};
      kernels.proxy.contact_query(points, p, regions);
      kernels.proxy.first_hit(points, p, down, 5e-3);
    }
  }
};

struct Noise {
  static constexpr std::size_t kPoints = 2048;
  std::vector<std::uint32_t> index = std::vector<std::uint32_t>(kPoints);
  mutable std::array<std::vector<double>, 3> normal;

  Noise() {
    for (std::size_t i = 0; i < kPoints; ++i) index[i] = static_cast<std::uint32_t>(i);
    for (std::vector<double>& column : normal) column.resize(kPoints);
  }
  void operator()(const Kernels& kernels) const {
    kernels.noise.normals({{1, 2}, {3, 4, 5}}, index.data(), kPoints, normal[0].data(), normal[1].data(),
                          normal[2].data());
  }
};

// Disks on a plane through a ball of 10 mm, whose distance field has nodes 2 mm apart.
struct ToolDisks {
  static constexpr std::size_t kPoints = 256, kAlong = 16, kNodes = 17, kColumns = 16;
  std::vector<float> node;
  std::array<std::vector<double>, 8> point;
  mutable std::array<std::vector<double>, kColumns> disk;
  mutable std::vector<double> nearest = std::vector<double>(kPoints / kLanes);

  ToolDisks() {
    for (std::size_t i = 0; i < kNodes * kNodes * kNodes; ++i) {
      const auto along = [](std::size_t number) { return 2e-3 * (static_cast<double>(number) - 8); };
      const double x = along(i % kNodes), y = along(i / kNodes % kNodes), z = along(i / kNodes / kNodes);
      node.push_back(static_cast<float>(std::sqrt(x * x + y * y + z * z) - 0.01));
    }
    for (std::vector<double>& column : point) column.resize(kPoints);
    for (std::vector<double>& column : disk) column.resize(kPoints + kLanes);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const std::size_t row = i / kAlong;
      point[0][i] = 1e-3 * (static_cast<double>(i % kAlong) - 7.7);
      point[1][i] = 1e-3 * (static_cast<double>(row) - 7.7);
      point[5][i] = 1, point[6][i] = 1e-3;
    }
  }
  void operator()(const Kernels& kernels) const {
    const PointColumns points{point[0].data(), point[1].data(), point[2].data(), point[3].data(),
                              point[4].data(), point[5].data(), point[6].data(), point[7].data()};
    constexpr int kCells = static_cast<int>(kNodes) - 1;
    const PosedField field{
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, node.data(), {kCells, kCells, kCells},
        {-0.016, -0.016, -0.016},          2e-3};
    const auto three = [this](std::size_t first, double*(&columns)[3]) {
      for (std::size_t axis = 0; axis < 3; ++axis) columns[axis] = disk[first + axis].data();
    };
    DiskColumns out{};
    three(0, out.p_T), three(3, out.n_T), three(6, out.gradient_T);
    out.radius = disk[9].data(), out.distance = disk[10].data(), out.slope = disk[11].data();
    out.lower = disk[12].data(), out.bound = disk[13].data(), out.cell = disk[14].data();
    out.extent = disk[15].data();
    constexpr DiskLimits kLimits{4e-3, 2e-3, 3e-4, 4e-3};  // limits for a look-ahead of 2 mm
    std::size_t outside_count = 0;
    kernels.tool.disks_in_field(points, kPoints, 0.5, 1000, field, kLimits, nearest.data(), true, out,
                                outside_count);
  }
};

// Two rows of a plane half a metre away with steps of 0.1 mm, windows of 9 x 9 pixels.
struct DepthRows {
  static constexpr int kWidth = 48, kRows = 2, kHalf = 4, kBorder = 2 * kHalf;
  static constexpr std::ptrdiff_t kStride = kWidth + 2 * kBorder + 2 * kMaxLanes;
  static constexpr std::size_t kSize = static_cast<std::size_t>(kStride * (kRows + 2 * kBorder));
  static constexpr float kStep = 1.0f / 525;         // 1 / f
  mutable std::array<std::vector<float>, 10> plane;  // points of the filter, of the normals; normals; change
  mutable std::vector<float> weights = std::vector<float>(weight_buffer_size(kWidth, kHalf));
  std::vector<float> ray = std::vector<float>(static_cast<std::size_t>(kStride));

  DepthRows() {
    for (std::vector<float>& values : plane) values.resize(kSize);
    for (std::size_t i = 0; i < ray.size(); ++i) ray[i] = kStep * static_cast<float>(i);
    const float filter_scale = 12, normal_scale = 100;  // units per metre
    for (std::size_t i = 0; i < kSize; ++i) {
      const std::size_t column = i % static_cast<std::size_t>(kStride);
      const std::size_t row = i / static_cast<std::size_t>(kStride);
      const float z_m = 0.5f + 1e-4f * static_cast<float>((column + row) % 2);
      const float p_m[3] = {z_m * ray[column], z_m * ray[row], z_m};
      for (std::size_t axis = 0; axis < 3; ++axis)
        plane[axis][i] = filter_scale * p_m[axis], plane[3 + axis][i] = normal_scale * p_m[axis];
    }
  }
  float* start(std::size_t number) const { return plane[number].data() + kBorder * kStride + kBorder; }
  PointPlanes planes(std::size_t first) const {
    return {start(first), start(first + 1), start(first + 2), kStride};
  }
  void operator()(const Kernels& kernels) const {
    const RowBand band{0, kRows, kWidth, kHalf, weights.data()};
    const float step[2] = {kStep, kStep};
    kernels.depth.filter_depth(band, planes(0), start(9));
    kernels.depth.plane_normals(band, planes(3), {ray.data() + kBorder, ray.data() + kBorder}, step,
                                planes(6));
  }
};

// A std::function copies what it calls. The task is shared by these copies, so that its inputs are made once.
template <class Task>
KernelTask task(const char* name) {
  return {name, [made = std::make_shared<const Task>()](const Kernels& kernels) { (*made)(kernels); }};
}

}  // namespace

std::vector<KernelTask> representative_tasks() {
  return {task<ProxyStep>("proxy"), task<Noise>("noise"), task<ToolDisks>("tool"), task<DepthRows>("depth")};
}

namespace {

constexpr int kMinRounds = 3, kMaxRounds = 20;
constexpr double kShortest_s = 1e-9;  // used if the clock did not advance, to keep the logarithm finite

double geometric_mean(const std::vector<double>& times_s) {
  double sum = 0;
  for (const double time_s : times_s) sum += std::log(std::max(time_s, kShortest_s));
  return std::exp(sum / static_cast<double>(times_s.size()));
}

}  // namespace

LevelTimes time_levels(std::span<const Kernels* const> levels, std::span<const KernelTask> tasks,
                       const std::function<double()>& now_s, double max_s) {
  const std::vector<double> unknown(tasks.size(), std::numeric_limits<double>::infinity());
  std::vector<std::vector<double>> least_s(levels.size(), unknown);
  const double start_s = now_s();
  for (int round = 0; round < kMaxRounds; ++round) {
    if (round >= kMinRounds && now_s() - start_s >= max_s) break;
    for (std::size_t t = 0; t < tasks.size(); ++t)
      for (std::size_t l = 0; l < levels.size(); ++l) {
        const double before_s = now_s();
        tasks[t].run(*levels[l]);
        least_s[l][t] = std::min(least_s[l][t], now_s() - before_s);
      }
  }
  LevelTimes times;
  for (const std::vector<double>& of_tasks : least_s) times.push_back(geometric_mean(of_tasks));
  return times;
}

std::size_t fastest_level(const LevelTimes& times) {
  std::size_t chosen = 0;
  for (std::size_t level = 1; level < times.size(); ++level)
    if (times[level] * kClearlyFaster <= times[chosen]) chosen = level;
  return chosen;
}

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
