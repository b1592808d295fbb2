// The method alone, in a haptic loop in the shape of CHAI3D's: a thread reads the device, asks for the force
// and writes it; another one brings clouds. It uses no experiment and no file.
#include <core/dissertation/proxy/proxy_renderer.h>
#include <core/kernels/kernels.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

using namespace remote_touch;

// Stands for a device such as cGenericHapticDevice; its hand goes down by 0.3 mm in each tick, and stops.
class Device {
 public:
  Vec3 position_m() { return {0, 0.02 - 0.0003 * (tick_ < 100 ? tick_++ : tick_), 0}; }
  void set_force(const Vec3& force_N) { force_N_ = force_N; }
  const Vec3& force_N() const { return force_N_; }

 private:
  int tick_ = 0;
  Vec3 force_N_ = Vec3::Zero();
};

// Stands for a camera: a flat floor, 3 cm wide and deep.
Frame captured(int index, double time_s) {
  PointCloud cloud;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j) cloud.append({0.0015 * i, 0, 0.0015 * j});
  return {index, time_s, time_s, make_search(std::move(cloud))};
}

int main() {
  const auto begin = std::chrono::steady_clock::now();
  const auto now_s = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  std::atomic<std::shared_ptr<const Frame>> newest = std::make_shared<const Frame>(captured(0, now_s()));
  std::atomic<bool> is_running = true;
  std::thread camera([&] {
    for (int index = 1; is_running; ++index) {
      std::this_thread::sleep_for(std::chrono::milliseconds(33));
      newest = std::make_shared<const Frame>(captured(index, now_s()));
    }
  });

  Device device;
  ProxyRenderer renderer({}, 1000, kernels_for(best_isa()));
  std::shared_ptr<const Frame> used;
  RenderOutput out;
  for (int tick = 0; tick < 150;
       ++tick) {  // a real loop runs until it is stopped, as often as the device allows
    if (const auto frame = newest.load(); frame != used) renderer.on_frame(*(used = frame));
    out = renderer.step({device.position_m()}, now_s());
    device.set_force(out.force_N);  // CHAI3D's axes are others: x to the user, z up
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  is_running = false;
  camera.join();
  std::printf("%.3f N up, proxy %.2f mm above the points\n", device.force_N().y(), 1000 * out.proxy_W.y());
  return device.force_N().y() > 1 ? 0 : 1;
}
