// Everything in the built-in catalog fulfils its contract. Entries that read files receive some that are made
// here.
#include <gtest/gtest.h>

#include "runners/evaluation/contract/contract_tests.h"
#include "runners/experiment/sessions/session_file.h"
#include "tests/support/test_files.h"

namespace remote_touch::built_in_contract_test {
namespace {

// A live session of two frames and some ticks.
void write_session(const std::string& file) {
  const SensorView view{{64, 2, 60, 60, 31.5, 0.5}, 0.001, 30, false, RigidTransform::Identity()};
  SessionWriter session(file, view, RigidTransform::Identity(), {{"config", R"({"haptic_rate_hz": 1000})"}});
  SensorFrame frame;
  frame.depth.assign(128, 500);
  for (int i = 0; i < 2; ++i) {
    frame.number = i, frame.depth[5] = static_cast<std::uint16_t>(480 + i);
    session.append(frame, i / 30.0, 0);
  }
  SessionTick tick;
  for (int i = 0; i < 100; ++i) {
    tick.number = i + 3, tick.taken = i % 50 == 0 ? i / 50 : -1;
    tick.device.position_W = Vec3(0.001 * i, 0, 0.5);
    session.append(tick);
  }
  session.finish();
}

// A recording of two depth images, a mask, and a live session.
class Files {
 public:
  Files() {
    folder_.write_depth("depth/0000.png", 500, 64);
    folder_.write_depth("depth/0001.png", 520, 64);
    folder_.write(
        "camera.json",
        R"({"width": 64, "height": 2, "fx": 60, "fy": 60, "cx": 31.5, "cy": 0.5, "depth_scale_m": 0.001,
            "frame_rate_hz": 30})");
    std::vector<std::uint8_t> grey(48);
    for (std::size_t i = 0; i < 48; ++i) grey[i] = static_cast<std::uint8_t>(i % 2 * 255);
    mask_ = folder_.write_png("mask.png", 8, 6, PNG_FORMAT_GRAY, grey.data()).string();
    session_ = (folder_ / "session.h5").string();
    write_session(session_);
  }

  std::string of(const std::string& name) const {
    return name == "live-session" ? session_ : name == "image-mask" ? mask_ : folder_.path().string();
  }

 private:
  TestFolder folder_{"contract"};
  std::string mask_, session_;
};

void name_a_file(const std::string& name, const Parameters& settings) {
  static const Files files;
  for (const Parameter& p : settings)
    if (p.name == "path") *std::get<std::string*>(p.value) = files.of(name);
}

const bool kRegistered = (register_contract_tests(built_in_catalog(), name_a_file), true);

TEST(BuiltIn, ContractsAreRegistered) {
  EXPECT_TRUE(kRegistered);
  EXPECT_GT(testing::UnitTest::GetInstance()->total_test_count(), 300);
}

}  // namespace
}  // namespace remote_touch::built_in_contract_test
