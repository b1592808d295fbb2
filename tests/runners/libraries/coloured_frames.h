// Coloured frames with forbidden regions by hue: all at once on a device, compared with one step after
// another on the CPU.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/points/point_cloud.h"
#include "tests/core/dissertation/depth/depth_cases.h"

namespace remote_touch::coloured_frames {

// Random colours, among them many greys, pure colours and points without a colour.
inline std::vector<std::uint32_t> colours(std::size_t count) {
  std::vector<std::uint32_t> all;
  std::uint32_t random = 1;
  for (std::size_t i = 0; i < count; ++i) {
    random = random * 1664525u + 1013904223u;
    const std::uint32_t level = random >> 24;
    all.push_back(i % 11 == 0  ? kNoColour
                  : i % 5 == 0 ? level * 0x010101u
                  : i % 5 == 1 ? 0xFFu << 8 * ((random >> 8) % 3)
                               : random >> 8);
  }
  return all;
}

// Ranges of hue through red and others, at full and at partial strength, with and without a radius or a
// stiffness.
inline FixtureAssignment rules_by_hue() {
  const auto rule = [](double radius_m, double stiffness, double strength, double from_deg, double to_deg) {
    HueRange::Settings settings;
    settings.values.radius_m = radius_m, settings.values.stiffness_N_per_m = stiffness;
    settings.values.schedule = {0, strength};
    settings.from_deg = from_deg, settings.to_deg = to_deg;
    return std::make_unique<const HueRange>(settings);
  };
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  rules.push_back(rule(0.3, -1, 1, 340, 20));
  rules.push_back(rule(0.05, 900, 0.3, 0, 150));
  rules.push_back(rule(-1, 350.7, 0.45, 100, 260));
  rules.push_back(rule(0.04, -1, 1, 350, 10));  // 0.3 + (0.04 - 0.3) is not 0.04
  return FixtureAssignment(std::move(rules), nullptr, 600);
}

inline bool same_columns(const PointCloud& a, const PointCloud& b) {
  return depth_cases::same_bits(a, b) && depth_cases::same_bits(a.fixture_radius_m, b.fixture_radius_m) &&
         depth_cases::same_bits(a.stiffness_N_per_m, b.stiffness_N_per_m) && a.colour == b.colour;
}

constexpr double kUnit_m = 1e-4;

inline std::vector<std::uint16_t> units_of(const DepthImage& depth) {
  std::vector<std::uint16_t> units;
  for (const double z_m : depth.z_m) {
    const double count = std::round(z_m / kUnit_m);
    units.push_back(count >= 1 && count <= 65535 ? static_cast<std::uint16_t>(count) : 0);
  }
  return units;
}

inline PointCloud on_cpu(PointCloud cloud, const depth_cases::Settings& settings,
                         const FixtureAssignment& fixtures, std::uint64_t off) {
  DepthPipeline(settings, depth_cases::best()).process(cloud);
  fixtures.assign(cloud, 0, off);
  return cloud;
}

// Returns the difference, or an empty text if there is none.
inline std::string cloud_differs(DepthProcessor& device, const depth_cases::Settings& settings,
                                 const PointCloud& measured, std::uint64_t off) {
  const FixtureAssignment fixtures = rules_by_hue();
  PointCloud cloud = measured;
  if (!device.process_all(cloud, fixtures.hue_steps(0, off).value())) return "a cloud was not processed";
  return same_columns(cloud, on_cpu(measured, settings, fixtures, off)) ? "" : "columns of a cloud";
}

inline std::string image_differs(DepthProcessor& device, const depth_cases::Settings& settings,
                                 const scenes::DepthScene& scene, const RigidTransform& X_WC) {
  const FixtureAssignment fixtures = rules_by_hue();
  const HueSteps steps = fixtures.hue_steps(0, 0).value();
  const std::vector<std::uint16_t> units = units_of(scene.depth);
  DepthImage image = scene.depth;
  for (std::size_t i = 0; i < units.size(); ++i)
    image.z_m[i] = units[i] == 0 ? depth_cases::kNaN : units[i] * kUnit_m;
  PointCloud measured = cloud_from_depth(image, scene.camera, X_WC), cloud, without_rules;
  measured.colour = colours(measured.size());
  const RawDepth raw{units.data(), kUnit_m, scene.camera, X_WC, measured.colour};
  const bool is_done = device.process_all(raw, cloud, &steps);
  if (is_done != settings.filter) return "an image was processed only if it was not to be";
  if (!is_done) return {};
  PointCloud expected = on_cpu(measured, settings, fixtures, 0);
  if (!same_columns(cloud, expected)) return "columns of an image";
  if (!device.process_all({raw.units, kUnit_m, raw.camera, X_WC}, without_rules, nullptr))
    return "an image without rules was not processed";
  expected.colour.clear(), expected.fixture_radius_m.clear(), expected.stiffness_N_per_m.clear();
  return same_columns(without_rules, expected) ? "" : "columns of an image without rules";
}

// Compares the device with the CPU on a cloud with all rules, with some and with none, and on a sensor's
// image. Returns the difference, or an empty text if there is none.
inline std::string differs(DepthProcessor& device, const depth_cases::Settings& settings,
                           const scenes::DepthScene& scene, const RigidTransform& X_WC) {
  PointCloud measured = cloud_from_depth(scene.depth, scene.camera, X_WC);
  measured.colour = colours(measured.size());
  for (const std::uint64_t off : {0u, 5u, 15u})
    if (const std::string what = cloud_differs(device, settings, measured, off); !what.empty()) return what;
  return image_differs(device, settings, scene, X_WC);
}

}  // namespace remote_touch::coloured_frames
