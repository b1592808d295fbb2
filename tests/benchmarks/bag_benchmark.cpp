// Frames of 640 x 480 pixels from bags of ROS, as a run reads them: from the file to the cloud, on one
// thread. Each frame is read once after the bag was opened, so that every CRC is computed. Every cloud is
// compared with the positions that were written before it is timed.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "scenarios/recordings/bag_frames.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/support/bag_files.h"

namespace remote_touch::benchmarks {
namespace {

constexpr int kWidth = 640, kHeight = 480, kFrames = 8;

float depth_m(int frame) {
  return 0.8f + 0.01f * static_cast<float>(frame);
}

bool is_as_written(const PointCloud& cloud, int frame) {
  const double z_m = depth_m(frame);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const auto i = static_cast<std::size_t>(v * kWidth + u);
      const Vec3 p(0.1 * (u - 319.5) * z_m, 0.1 * (v - 239.5) * z_m, z_m);
      if (!((cloud.point(i) - p).norm() < 1e-5)) return false;
    }
  return cloud.image && std::abs(cloud.image->camera.fx - 10) < 1e-3;
}

void add_kind(const std::filesystem::path& file, const std::string& name) {
  add(
      name,
      [=] {
        const BagFrames frames(file, {});
        bool right = frames.captured_s().size() == kFrames;
        for (int i = 0; right && i < kFrames; ++i)
          right = is_as_written(frames.cloud(static_cast<std::size_t>(i), 10), i);
        return right;
      },
      [=](benchmark::State& state) {
        std::optional<BagFrames> frames;
        std::size_t i = 0;
        for (auto _ : state) {
          if (i == 0) frames.emplace(file, BagChoice{});
          benchmark::DoNotOptimize(frames->cloud(i, 10));
          i = (i + 1) % kFrames;
        }
        state.counters["frames_per_s"] =
            benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
      });
}

}  // namespace
}  // namespace remote_touch::benchmarks

int main(int argc, char** argv) {
  using namespace remote_touch;
  using namespace remote_touch::benchmarks;
  const auto folder =
      std::filesystem::temp_directory_path() / ("bag_benchmark." + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::vector<BagMessage> messages;
  for (int i = 0; i < kFrames; ++i)
    messages.push_back(
        {"/points", "sensor_msgs/msg/PointCloud2", i,
         cloud_message(MessageBytes::Format::cdr, 1 + 33'000'000LL * i, kWidth, kHeight, depth_m(i))});
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    add_kind(folder / name, "bag_cloud/" + name);
  };
  for (const std::string compression : {"", "lz4", "zstd"})
    write((compression.empty() ? "plain" : compression) + ".mcap",
          mcap_file(messages, {true, true, true, compression, 1}));
  write_db3((folder / "sqlite.db3").string(), messages);
  add_kind(folder / "sqlite.db3", "bag_cloud/sqlite.db3");
  const int code = run_benchmarks(argc, argv);
  std::filesystem::remove_all(folder);
  return code;
}
