// Every kind of cloud, pressed by a hand: with or without rows and columns, normals, colours, and a camera.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/test_files.h"

namespace remote_touch::cloud_kinds {

// A flat plate at y = 0, seen from above, whose cloud has what the settings demand.
class Plate final : public Scenario {
 public:
  struct Settings {
    bool organised = false, normals = false, colours = false;
  };
  Plate(const Settings& settings, const NoiseKey&, const Kernels&) : settings_(settings) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  PointCloud cloud(int) const override {
    constexpr int kSide = 31;
    PointCloud cloud;
    for (int i = 0; i < kSide * kSide; ++i) {
      const Vec3 p(0.002 * (i % kSide - kSide / 2), 0, 0.002 * (i / kSide - kSide / 2));
      settings_.normals ? cloud.append(p, Vec3::UnitY()) : cloud.append(p);
      if (settings_.colours) cloud.colour.push_back(0xFF0000);
    }
    if (settings_.organised) cloud.grid_columns = kSide;
    return cloud;
  }
  double signed_distance(const Vec3& p_W, double) const override { return p_W.y(); }

 private:
  const Settings settings_;
};

inline Parameters parameters(Plate::Settings& s) {
  return {{"organised", &s.organised, 0, 0, "rows and columns"},
          {"normals", &s.normals, 0, 0, "normals"},
          {"colours", &s.colours, 0, 0, "red points"}};
}
inline std::string validate(const Plate::Settings&) {
  return {};
}

// The properties of a kind of cloud, and the settings that make it.
struct Kind {
  std::string scenario;
  std::string press;  // 1 cm deep
  Vec3 outwards;
  bool organised = false, normals = false, colours = false, image = false;
  bool view = true;  // the setting `view` is right by default
};

inline const char* const kDown =
    "[[0, 0.05, 0, 0, 0, 0, 0], [0, -0.01, 0, 0, 0, 0, 0.1], [0, -0.01, 0, 0, 0, 0, 0.05]]";
inline const char* const kForward =
    "[[0, 0, 0.45, 0, 0, 0, 0], [0, 0, 0.51, 0, 0, 0, 0.1], [0, 0, 0.51, 0, 0, 0, 0.05]]";

inline std::string press_on(const Kind& kind, const std::string& renderer, const std::string& rest = "") {
  return R"({"scenario": )" + kind.scenario + R"(, "renderer": )" + renderer +
         R"(, "trajectory": {"name": "poses", "poses": )" + kind.press + R"(}, "duration_s": 0.15)" + rest +
         "}";
}

inline Trace run(const std::string& json) {
  return simulate(Experiment::from_json(json, "test"));
}

class CloudKinds : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    Catalog catalog = built_in_catalog();
    catalog.add(scenario_entry<Plate>("plate", "a flat plate at rest"));
    use_catalog(std::move(catalog));
  }
  static void TearDownTestSuite() { use_catalog(built_in_catalog()); }

  // Returns all kinds of clouds without a camera.
  static std::vector<Kind> plates() {
    std::vector<Kind> all;
    const auto word = [](bool is_on) { return std::string(is_on ? "true" : "false"); };
    for (int i = 0; i < 8; ++i) {
      Kind kind{"", kDown, Vec3::UnitY(), (i & 1) != 0, (i & 2) != 0, (i & 4) != 0};
      kind.scenario = R"({"name": "plate", "organised": )" + word(kind.organised) + R"(, "normals": )" +
                      word(kind.normals) + R"(, "colours": )" + word(kind.colours) + "}";
      all.push_back(kind);
    }
    return all;
  }

  // The plane z = 0.5 m, of 40 x 40 points.
  std::string write_pcd(const std::string& name, bool organised, bool colours) const {
    constexpr int kSide = 40;
    const std::string width = std::to_string(organised ? kSide : kSide * kSide),
                      height = std::to_string(organised ? kSide : 1), more = colours ? " " : "";
    std::string text =
        pcd_header("x y z" + more + (colours ? "rgb" : ""), "4 4 4" + more + (colours ? "4" : ""),
                   "F F F" + more + (colours ? "U" : ""), "1 1 1" + more + (colours ? "1" : ""), width,
                   height, std::to_string(kSide * kSide), "ascii");
    for (int i = 0; i < kSide * kSide; ++i)
      text += std::to_string(0.002 * (i % kSide - 19.5)) + " " + std::to_string(0.002 * (i / kSide - 19.5)) +
              " 0.5" + (colours ? " 16711680\n" : "\n");
    return folder_.write(name, text).string();
  }
  Kind pcd(bool organised, bool colours) const {
    const std::string name = std::string(organised ? "rows" : "list") + (colours ? "_red.pcd" : ".pcd"),
                      file = write_pcd(name, organised, colours);
    return {R"({"name": "recording", "path": ")" + file + "\"}",
            kForward,
            -Vec3::UnitZ(),
            organised,
            false,
            colours,
            organised,
            organised};
  }
  std::vector<Kind> recordings() const {
    return {pcd(false, false), pcd(false, true), pcd(true, false), pcd(true, true)};
  }

  const TestFolder folder_{"frame_needs"};
};

}  // namespace remote_touch::cloud_kinds
