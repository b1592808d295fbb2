// The cameras behind the library: the part that the test doubles of depth cameras' libraries share. A test
// sets their state and reads it. Each double exports them under the name camera_double. Only one thread may
// use them.
//
// They are test doubles: they have the vendors' signatures and none of their behaviour. A test that passes
// with them shows what an adapter calls, not what a camera does.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runners/live/devices/clock.h"
#include "tests/doubles/simulated_clock.h"

namespace remote_touch {

// The lens of a camera double: that of Brown and Conrady, with a rational part. It is written from the
// equations, without the vendors' sources.
struct CameraLens {
  int width = 640, height = 480;
  double fx = 500, fy = 502, cx = 321.3, cy = 238.6;
  std::array<double, 6> k{};  // radial: three of the numerator, three of the denominator
  double p1 = 0, p2 = 0;      // tangential
  double max_radius = 1.7;    // rays farther from the axis are not seen

  using Point = Eigen::Vector2d;

  // Returns a lens of the Azure Kinect for its smallest images, which distorts.
  static CameraLens distorted_k4a() {
    return {.fx = 250, .fy = 251, .cx = 160.2, .cy = 143.1, .k = {-0.1, 0.01, 0, 0, 0, 0}, .p1 = 1e-3};
  }

  // Returns the position on the plane z = 1 where the lens shows this ray.
  Point distorted(const Point& ray) const {
    const double x = ray.x(), y = ray.y(), r2 = x * x + y * y;
    const double radial =
        (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]))) / (1 + r2 * (k[3] + r2 * (k[4] + r2 * k[5])));
    return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  }
  std::optional<Point> pixel_of(const Point& ray) const {
    if (ray.norm() > max_radius) return {};
    const Point at = distorted(ray);
    return Point(cx + fx * at.x(), cy + fy * at.y());
  }
  // Newton's method with differences solves it.
  std::optional<Point> ray_of(const Point& pixel) const {
    const Point wanted((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
    Point ray = wanted;
    for (int i = 0; i < 30; ++i) {
      const Point error = distorted(ray) - wanted;
      if (error.norm() < 1e-12) return ray.norm() > max_radius ? std::nullopt : std::optional(ray);
      constexpr double kStep = 1e-6;
      Eigen::Matrix2d slope;
      slope.col(0) = (distorted(ray + Point(kStep, 0)) - distorted(ray - Point(kStep, 0))) / (2 * kStep);
      slope.col(1) = (distorted(ray + Point(0, kStep)) - distorted(ray - Point(0, kStep))) / (2 * kStep);
      ray -= slope.inverse() * error;
    }
    return {};
  }
};

class CameraDouble {
 public:
  static constexpr const char* kExport = "camera_double";
  using Bytes = std::vector<std::uint8_t>;

  struct State {
    std::vector<std::string> serials = {"000123", "CL2F"};
    int held_by_others = -1;  // the number of a camera that cannot be opened
    CameraLens lens;          // lens of all cameras; its size is that of the mode
    double metres_per_unit = 0.001, rate_hz = 30;
    // They see the plane normal . p = distance_m. Every hole_every-th pixel measures nothing (0: no holes).
    Eigen::Vector3d normal{0, 0, 1};
    double distance_m = 0.5;
    int hole_every = 0;

    // Frame n, from 1 on, comes n periods after the start.
    std::function<double(int)> stamp_s = [](int number) { return 5 + number / 30.0; };
    std::function<int(int)> reported_number = [](int number) { return number; };
    std::function<bool(int)> has_depth = [](int) { return true; };
    int silent_after = 0, lost_after = 0;  // number of frames before it happens; 0: never
    int row_gap_bytes = 0, missing_bytes = 0, missing_rows = 0;
    int format = -1;  // wrong format of the frames, -1: the right one

    int fail_at = 0;        // the call of this number fails, from 1 on
    std::string fail_name;  // and so do the calls of this name
    // The rest concerns the rs2 interface only.
    int version = 25605;
    int model = 4;          // lens model: Brown and Conrady
    bool is_alone = false;  // depth comes alone, not with other streams in one frame
    bool has_depth_sensor = true, sends_depth = true;
  };

  // --- for tests ---
  void follow(SimulatedClock* clock) { simulated_ = clock; }
  void reset() {
    state = {};
    calls_.clear(), held_.clear(), misuse_.clear(), image_.clear();
    is_started_ = false;
  }
  // Calls in order, without those that map between pixels and rays.
  const std::vector<std::string>& calls() const { return calls_; }
  int count(const std::string& name) const {
    return static_cast<int>(std::count(calls_.begin(), calls_.end(), name));
  }
  std::string last_call() const { return calls_.empty() ? "no call" : calls_.back(); }
  std::size_t held() const { return held_.size(); }  // handles that were not given back
  const std::vector<std::string>& misuse() const { return misuse_; }
  bool is_started() const { return is_started_; }

  State state;

  // --- for the library ---
  Clock& clock() const { return simulated_ ? *simulated_ : steady_clock(); }
  // Returns true if the call has to fail.
  bool enter(const char* name) {
    calls_.emplace_back(name);
    return static_cast<int>(calls_.size()) == state.fail_at || name == state.fail_name;
  }
  // Returns a handle of that kind, which must be given back once. Its content lives as long.
  void* hold(const char* kind, Bytes content = {}) {
    auto* handle = new Bytes(std::move(content));
    held_[handle] = {kind, std::unique_ptr<Bytes>(handle)};
    return handle;
  }
  // Returns the content of a handle that begins with a number, and that number.
  static Bytes bytes_of(int number, const Bytes& more = {}) {
    Bytes bytes(sizeof number + more.size());
    std::memcpy(bytes.data(), &number, sizeof number);
    std::copy(more.begin(), more.end(), bytes.begin() + sizeof number);
    return bytes;
  }
  static int number_in(const void* handle) {
    int number = 0;
    std::memcpy(&number, static_cast<const Bytes*>(handle)->data(), sizeof number);
    return number;
  }
  void give_back(const char* kind, const void* handle) {
    if (is_held(kind, handle)) held_.erase(handle);
  }
  bool is_held(const char* kind, const void* handle) {
    const auto found = held_.find(handle);
    const bool is_right = found != held_.end() && found->second.first == kind;
    if (!is_right) misuse_.push_back(last_call() + ": no " + kind);
    return is_right;
  }
  void expect(bool is_right, const char* what) {
    if (!is_right) misuse_.push_back(last_call() + ": " + what);
  }

  void start() {
    is_started_ = true;
    start_ns_ = clock().now_ns();
    last_ = 0;
    image_.clear();
  }
  void stop() { is_started_ = false; }
  bool is_lost() const { return state.lost_after > 0 && due() > state.lost_after; }
  // The number of the newest frame that has come, or 0 if there is none.
  int due() const {
    if (!is_started_) return 0;
    const double passed_s = 1e-9 * static_cast<double>(clock().now_ns() - start_ns_);
    return static_cast<int>(std::floor(passed_s * state.rate_hz + 1e-6));
  }
  int sent() const {
    int newest = due();
    if (state.silent_after > 0) newest = std::min(newest, state.silent_after);
    if (state.lost_after > 0) newest = std::min(newest, state.lost_after);
    return newest;
  }
  double wait_for_s(int number) const {
    return number / state.rate_hz - 1e-9 * static_cast<double>(clock().now_ns() - start_ns_);
  }
  int last() const { return last_; }
  void take(int number) { last_ = number; }

  int stride() const { return 2 * state.lens.width + state.row_gap_bytes; }
  // The gaps are full of ones.
  Bytes image() {
    if (image_.empty()) draw();
    Bytes bytes(static_cast<std::size_t>(stride()) * static_cast<std::size_t>(state.lens.height), 0xff);
    for (int v = 0; v < state.lens.height; ++v)
      std::memcpy(bytes.data() + v * stride(), image_.data() + v * state.lens.width,
                  2 * static_cast<std::size_t>(state.lens.width));
    bytes.resize(bytes.size() - static_cast<std::size_t>(state.missing_bytes));
    return bytes;
  }

 private:
  void draw() {
    for (int v = 0; v < state.lens.height; ++v)
      for (int u = 0; u < state.lens.width; ++u) {
        const auto ray = state.lens.ray_of({u, v});
        const double slope = ray ? state.normal.dot(Eigen::Vector3d(ray->x(), ray->y(), 1)) : 0;
        const double units = slope > 0 ? state.distance_m / slope / state.metres_per_unit : 0;
        const bool is_hole = state.hole_every > 0 && (u + 3 * v) % state.hole_every == 0;
        image_.push_back(units < 65535 && !is_hole ? static_cast<std::uint16_t>(std::lround(units)) : 0);
      }
  }

  SimulatedClock* simulated_ = nullptr;
  std::vector<std::string> calls_, misuse_;
  std::map<const void*, std::pair<std::string, std::unique_ptr<Bytes>>> held_;
  std::vector<std::uint16_t> image_;
  bool is_started_ = false;
  std::int64_t start_ns_ = 0;
  int last_ = 0;
};

}  // namespace remote_touch

extern "C" remote_touch::CameraDouble* camera_double();
