// Each rule of a contract finds an entry that breaks it, and everything in the built-in catalog fulfils its
// contract.
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>

#include "analysis/trace/trace.h"
#include "core/points/neighbour_search.h"
#include "runners/evaluation/contract/contract_tests.h"
#include "runners/evaluation/verification/metamorphic_checks.h"
#include "runners/experiment/sessions/session_file.h"
#include "tests/support/test_files.h"

namespace remote_touch::broken_contract_test {
namespace {

// The names of the rules that fail for an entry.
template <class Entry>
std::vector<std::string> broken_rules(const Entry& entry, std::span<const ContractCheck<Entry>> checks) {
  std::vector<std::string> broken;
  for (const ContractCheck<Entry>& check : checks) {
    testing::TestPartResultArray failures;
    {
      const testing::ScopedFakeTestPartResultReporter reporter(&failures);
      check.of(entry, {});
    }
    if (failures.size() > 0) broken.push_back(check.name);
  }
  return broken;
}

using Names = std::vector<std::string>;

// --- renderers: a spring against the plane y = 0, with one mistake ---

enum class Mistake {
  none,
  force_in_free_space,
  counts_its_steps,
  allocates,
  allocates_aligned,
  soft,
  forgets_no_frame,
  blind,
  needs_points,
  six
};

struct SpringSettings {
  double stiffness_N_per_m = 500;
};
Parameters parameters(SpringSettings& s) {
  return {{"stiffness_N_per_m", &s.stiffness_N_per_m, 1, 1e4, "stiffness of the spring, N/m"}};
}
std::string validate(const SpringSettings&) {
  return {};
}
double max_stiffness_N_per_m(const SpringSettings& s) {
  return s.stiffness_N_per_m;
}
RenderedContact rendered_contact(const SpringSettings&) {
  return RenderedContact::unknown();
}

// Defaults outside their ranges.
struct ManySteps : SpringSettings {
  int steps = 5;
};
Parameters parameters(ManySteps& s) {
  return {{"steps", &s.steps, 0, 3, "number of steps"}};
}
struct LongDirection : SpringSettings {
  Vec3 direction{0, 2, 0};
};
Parameters parameters(LongDirection& s) {
  return {{"direction", &s.direction, -1, 1, "a direction"}};
}

template <Mistake kMistake, class SettingsOfIt = SpringSettings>
class Spring final : public Renderer {
 public:
  using Settings = SettingsOfIt;
  Spring(const Settings& settings, double, const Kernels&) : settings_(settings) {}
  void on_frame(const Frame& frame) override { index_ = frame.index, points_ = frame.points->size(); }
  RenderOutput step(const DeviceState& device, double) override {
    RenderOutput out;
    const double depth_m = std::max(0.0, 0.005 - device.position_W.y());
    ++steps_;
    if (kMistake == Mistake::allocates) kept_.assign(static_cast<std::size_t>(steps_), 1.0);
    if (kMistake == Mistake::allocates_aligned) aligned_ = std::make_unique<Aligned>();
    out.frame_index = index_;
    out.proxy_W = device.position_W;
    if (index_ < 0 && kMistake != Mistake::forgets_no_frame) out.status = RenderStatus::no_frame;
    const bool is_finite = device.position_W.allFinite();
    if (!is_finite) out.status = RenderStatus::device_not_finite, out.proxy_W.setZero();
    if (index_ < 0 || !is_finite) return out;
    double force_N = settings_.stiffness_N_per_m * depth_m;
    if (kMistake == Mistake::force_in_free_space) force_N += 0.01;
    if (kMistake == Mistake::counts_its_steps) force_N += 1e-9 * static_cast<double>(total_++ % 1000);
    if (kMistake == Mistake::soft) force_N *= 0.5;
    if (kMistake == Mistake::blind) force_N = 0;
    if (kMistake == Mistake::needs_points && points_ == 0) force_N = std::nan("");
    if (kMistake == Mistake::six) out.tool.emplace();
    out.force_N = Vec3(0, force_N, 0);
    out.proxy_W += Vec3(0, depth_m, 0);
    out.state = force_N > 0 ? ContactState::contact : ContactState::free;
    return out;
  }

 private:
  static inline std::atomic<int> total_{0};  // shared state, which no renderer may have
  Settings settings_;
  int index_ = -1, steps_ = 0;
  std::size_t points_ = 0;
  std::vector<double> kept_;
  struct alignas(64) Aligned {
    double value = 0;
  };
  std::unique_ptr<Aligned> aligned_;
};

template <Mistake kMistake, class Settings = SpringSettings>
Names broken_by() {
  declare_contact_model("spring", ContactModel::nothing);
  return broken_rules(
      renderer_entry<Spring<kMistake, Settings>>("spring", DegreesOfFreedom::three, "a spring above a plane"),
      renderer_checks());
}

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

TEST(BrokenRenderer, ASpringWithoutAMistakeKeepsIt) {
  EXPECT_EQ(broken_by<Mistake::none>(), Names{});
}

TEST(BrokenRenderer, EachMistakeIsFound) {
  EXPECT_TRUE(has(broken_by<Mistake::force_in_free_space>(), "NoForceInFreeSpace"));
  EXPECT_TRUE(has(broken_by<Mistake::counts_its_steps>(), "SameInputSameBits"));
  EXPECT_TRUE(has(broken_by<Mistake::allocates>(), "AStepAllocatesNothing"));
  EXPECT_TRUE(has(broken_by<Mistake::allocates_aligned>(), "AStepAllocatesNothing"));
  EXPECT_TRUE(has(broken_by<Mistake::soft>(), "IsAsStiffAsItSays"));
  EXPECT_TRUE(has(broken_by<Mistake::forgets_no_frame>(), "WithoutAFrameTheProxyIsTheHip"));
  EXPECT_TRUE(has(broken_by<Mistake::blind>(), "PushesTheHandOutOfTheSurface"));
  EXPECT_TRUE(has(broken_by<Mistake::needs_points>(), "FramesWithoutPointsDoNoHarm"));
  EXPECT_TRUE(has(broken_by<Mistake::six>(), "HasAsManyDegreesOfFreedomAsItsEntrySays"));
}

TEST(BrokenRenderer, DefaultsOfEveryKindAreInTheirRanges) {
  EXPECT_TRUE(has(broken_by<Mistake::none, ManySteps>(), "ItsDefaultsAreValid"));
  EXPECT_TRUE(has(broken_by<Mistake::none, LongDirection>(), "ItsDefaultsAreValid"));
}

// --- scenarios: a flat grid with one mistake ---

enum class SceneMistake {
  none,
  no_points,
  noise_without_key,
  other_search,
  still_clock,
  long_normals,
  far_away,
  millimetres
};

struct NoSettings {};
Parameters parameters(NoSettings&) {
  return {};
}
std::string validate(const NoSettings&) {
  return {};
}

template <SceneMistake kMistake>
class Grid final : public Scenario {
 public:
  using Settings = NoSettings;
  Grid(const Settings&, const NoiseKey&, const Kernels&) {}
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 5; }
  double captured_s(int frame) const override {
    return kMistake == SceneMistake::still_clock ? 0 : frame / frame_rate_hz();
  }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override {
    PointCloud shown = cloud(frame);
    if (kMistake == SceneMistake::other_search) shown = scenes::flat_grid(39);
    return make_search(std::move(shown));
  }
  PointCloud cloud(int) const override {
    PointCloud made = scenes::flat_grid(kMistake == SceneMistake::no_points ? 0 : 40);
    if (kMistake == SceneMistake::noise_without_key) made.y[7] = 1e-4 * ++asked_;
    if (kMistake == SceneMistake::long_normals)
      made.nx.assign(made.size(), 0), made.ny.assign(made.size(), 1.1), made.nz.assign(made.size(), 0);
    if (kMistake == SceneMistake::far_away)
      for (double& x : made.x) x += 1e6;
    return made;
  }
  double signed_distance(const Vec3& p_W, double) const override {
    return (kMistake == SceneMistake::millimetres ? 1000 : 1) * p_W.y();
  }

 private:
  mutable std::atomic<int> asked_{0};
};

template <SceneMistake kMistake>
Names broken_scene() {
  return broken_rules(scenario_entry<Grid<kMistake>>("grid", "a flat grid"), scenario_checks());
}

TEST(BrokenScenario, AGridWithoutAMistakeKeepsIt) {
  EXPECT_EQ(broken_scene<SceneMistake::none>(), Names{});
}

TEST(BrokenScenario, EachMistakeIsFound) {
  EXPECT_TRUE(has(broken_scene<SceneMistake::no_points>(), "FramesArePure"));
  EXPECT_TRUE(has(broken_scene<SceneMistake::noise_without_key>(), "FramesArePure"));
  EXPECT_TRUE(has(broken_scene<SceneMistake::far_away>(), "FramesArePure"));
  EXPECT_TRUE(has(broken_scene<SceneMistake::other_search>(), "SearchAndCloudShowTheSamePoints"));
  EXPECT_TRUE(has(broken_scene<SceneMistake::still_clock>(), "RatesAndTimesMakeSense"));
  EXPECT_TRUE(has(broken_scene<SceneMistake::long_normals>(), "NormalsAreOneAPointAndOfUnitLength"));
  EXPECT_TRUE(has(broken_scene<SceneMistake::millimetres>(), "TheTrueDistanceIsOne"));
}

// --- trajectories and measures ---

class Jittery final : public Trajectory {
 public:
  using Settings = NoSettings;
  Jittery(const Settings&, const Scenario&) {}
  DeviceState at(double time_s) const override { return {Vec3(0, time_s + 1e-6 * ++asked_, 0)}; }
  double duration_s() const override { return 1; }

 private:
  mutable std::atomic<int> asked_{0};
};

TEST(BrokenTrajectory, AHandThatCountsItsCallsIsFound) {
  EXPECT_EQ(broken_rules(trajectory_entry<Jittery>("jittery", "a hand that is no function of time"),
                         trajectory_checks()),
            (Names{"PosesArePureAndFinite", "IsAtRestAfterTheEnd"}));
}

class Distant final : public Trajectory {
 public:
  using Settings = NoSettings;
  Distant(const Settings&, const Scenario&) {}
  DeviceState at(double) const override { return {Vec3(0, 0, -1001)}; }
  double duration_s() const override { return 1; }
};

TEST(BrokenTrajectory, AHandFarFromTheOriginIsFound) {
  EXPECT_EQ(
      broken_rules(trajectory_entry<Distant>("distant", "a hand beyond all scenes"), trajectory_checks()),
      Names{"PosesArePureAndFinite"});
}

TEST(BrokenMeasure, EachMistakeIsFound) {
  const auto broken = [](const Measure& measure) { return broken_rules(measure, measure_checks()); };
  EXPECT_EQ(broken({"ticks", "1", "number of ticks of the run", MeasuredRuns::all,
                    [](const Trace& trace) { return static_cast<double>(trace.length()); }}),
            Names{});
  EXPECT_EQ(broken({"quiet", "", "without a unit", MeasuredRuns::all, [](const Trace&) { return 0.0; }}),
            Names{"IsDescribed"});
  EXPECT_EQ(broken({"counter", "1", "how often it was asked", MeasuredRuns::all,
                    [calls = std::make_shared<int>(0)](const Trace&) { return 1.0 * ++*calls; }}),
            Names{"TheSameTraceHasTheSameValue"});
  EXPECT_EQ(broken({"inverse", "1", "one divided by the number of ticks", MeasuredRuns::all,
                    [](const Trace& trace) { return 1.0 / static_cast<double>(trace.length()); }}),
            Names{"ATraceWithoutTicksDoesNoHarm"});
}

// --- the built-in catalog: entries that read files receive some that are made here ---

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
}  // namespace remote_touch::broken_contract_test
