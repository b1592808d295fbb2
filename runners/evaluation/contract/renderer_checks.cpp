// The contract of every renderer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dissertation/virtual_fixtures/guided_renderer.h"
#include "runners/evaluation/contract/allocation_counter.h"
#include "runners/evaluation/contract/contract_tests.h"
#include "runners/evaluation/verification/metamorphic_checks.h"
#include "runners/experiment/catalog/configuration.h"

namespace remote_touch {

namespace {

std::unique_ptr<Renderer> build(const RendererEntry& entry, const FillSettings& fill) {
  return filled(entry, fill)->build(1000, scenes::kernels());
}

// Returns a flat cloud that supports the proxy. A renderer of forbidden regions receives points with regions
// of 5 mm, because it renders no others.
PointCloud grid_for(const RendererEntry& entry, int n) {
  PointCloud cloud = scenes::flat_grid(n);
  if (contact_model_of(entry.name).renders_only_regions) cloud.fixture_radius_m.assign(cloud.size(), 0.005);
  return cloud;
}

// Presses the HIP 3 cm into a flat cloud and withdraws it again, with a new frame every 33 ticks. Returns the
// output of each tick.
std::vector<RenderOutput> press(const RendererEntry& entry, Renderer& renderer) {
  std::vector<RenderOutput> outputs;
  for (int tick = 0; tick < 200; ++tick) {
    if (tick % 33 == 0) renderer.on_frame(scenes::frame(grid_for(entry, 60), tick / 33));
    const double depth = tick < 100 ? 0.02 - 0.0005 * tick : -0.03 + 0.0005 * (tick - 100);
    outputs.push_back(renderer.step({Vec3(0.0001 * tick, depth, 0)}, 0.001 * tick));
  }
  return outputs;
}

void no_force_in_free_space(const RendererEntry& entry, const FillSettings& fill) {
  const auto renderer = build(entry, fill);
  renderer->on_frame(scenes::frame(grid_for(entry, 40)));
  for (int tick = 0; tick < 50; ++tick) {
    const RenderOutput out = renderer->step({Vec3(0.001 * tick, 0.03, 0)}, 0.001 * tick);
    ASSERT_TRUE(out.force_N.isZero(0)) << "3 cm above the cloud: " << out.force_N.transpose() << " N";
    ASSERT_EQ(static_cast<int>(out.state), static_cast<int>(ContactState::free)) << "the state";
    ASSERT_EQ(static_cast<int>(out.status), static_cast<int>(RenderStatus::ok)) << "the status";
  }
}

void has_as_many_degrees_of_freedom_as_its_entry_says(const RendererEntry& entry, const FillSettings& fill) {
  const auto renderer = build(entry, fill);
  EXPECT_EQ(renderer->step({}, 0).tool.has_value(), entry.degrees_of_freedom == DegreesOfFreedom::six)
      << entry.name;
  renderer->on_frame(scenes::frame(grid_for(entry, 40)));
  EXPECT_EQ(renderer->step({}, 0.001).tool.has_value(), entry.degrees_of_freedom == DegreesOfFreedom::six)
      << entry.name;
}

void pushes_the_hand_out_of_the_surface(const RendererEntry& entry, const FillSettings& fill) {
  const auto renderer = build(entry, fill);
  double highest = 0;
  for (const RenderOutput& out : press(entry, *renderer)) highest = std::max(highest, out.force_N.y());
  EXPECT_GT(highest, 1) << entry.name;
}

// Holds the HIP at a height over the plane of the cloud (m, negative below it) for 300 ticks of 1 ms, so that
// the force is steady at the end. Returns the force along y, N.
double resting_force(Renderer& renderer, double height, double start_s) {
  RenderOutput out;
  for (int tick = 0; tick < 300; ++tick) out = renderer.step({Vec3(0, height, 0)}, start_s + 0.001 * tick);
  return out.force_N.y();
}

// The gate of a device scales forces by this stiffness: a spring that is stiffer than its renderer states is
// unstable.
void is_as_stiff_as_it_says(const RendererEntry& entry, const FillSettings& fill) {
  const auto factory = filled(entry, fill);
  const double said = factory->stiffness_N_per_m();
  const auto renderer = factory->build(1000, scenes::kernels());
  renderer->on_frame(scenes::frame(grid_for(entry, 60)));
  resting_force(*renderer, 0.02, 0);
  const double high = contact_model_of(entry.name).pressed_hip_passes_through ? 0.003 : -0.008,
               deeper = 0.001;
  const double before = resting_force(*renderer, high, 0.3);
  const double stiffness = (resting_force(*renderer, high - deeper, 0.6) - before) / deeper;
  EXPECT_GT(before, 0) << entry.name;
  EXPECT_LT(stiffness, 1.02 * said) << entry.name;
  EXPECT_GT(stiffness, 0.9 * said) << entry.name;
}

void same_input_same_bits(const RendererEntry& entry, const FillSettings& fill) {
  const auto first = build(entry, fill), second = build(entry, fill);
  const auto a = press(entry, *first), b = press(entry, *second);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].proxy_W, b[i].proxy_W) << entry.name;
    EXPECT_EQ(a[i].force_N, b[i].force_N) << entry.name;
    EXPECT_EQ(a[i].steps, b[i].steps) << entry.name;
  }
}

// A surface may vanish for some frames: a frame may be empty, and an image may have measured nothing. The
// hand is pressed before that, stays inside, is withdrawn and pressed again.
void frames_without_points_do_no_harm(const RendererEntry& entry, const FillSettings& fill) {
  PointCloud unmeasured = grid_for(entry, 60);
  unmeasured.y.assign(unmeasured.size(), std::nan(""));
  for (const PointCloud& blank : {PointCloud(), unmeasured}) {
    const auto renderer = build(entry, fill);
    double highest = 0;
    for (int tick = 0; tick < 450; ++tick) {
      const int frame = tick / 33, since = tick % 300;
      if (tick % 33 == 0)
        renderer->on_frame(scenes::frame(frame == 3 || frame == 4 ? blank : grid_for(entry, 60), frame));
      const double height = since < 150 ? 0.02 - 0.0004 * std::min(since, 75) : 0.03;
      const RenderOutput out = renderer->step({Vec3(0.0001 * tick, height, 0)}, 0.001 * tick);
      ASSERT_TRUE(out.force_N.allFinite() && out.proxy_W.allFinite()) << entry.name << " at tick " << tick;
      if (tick >= 300) highest = std::max(highest, out.force_N.y());
    }
    EXPECT_GT(highest, 1) << entry.name << " after the surface came back";
  }
}

// --- live parameters ---

std::vector<std::string> names(const Parameters& parameters) {
  std::vector<std::string> all;
  for (const Parameter& parameter : parameters) all.push_back(parameter.name);
  return all;
}

// Returns another value of the parameter, which is valid together with the unchanged other parameters.
double other_value(const Parameter& parameter) {
  const double value = number_of(parameter);
  if (std::holds_alternative<bool*>(parameter.value)) return 1 - value;
  return value * (parameter.name == "r1_m" ? 0.9 : 1.1);
}

void its_live_parameters_are_those_that_are_marked(const RendererEntry& entry, const FillSettings& fill) {
  const auto factory = filled(entry, fill);
  const auto renderer = factory->build(1000, scenes::kernels());
  EXPECT_EQ(names(renderer->live_parameters()), names(live_ones(factory->settings()))) << entry.name;
  for (const Parameter& parameter : renderer->live_parameters())
    EXPECT_TRUE(std::holds_alternative<double*>(parameter.value) ||
                std::holds_alternative<bool*>(parameter.value))
        << entry.name << ": " << parameter.name;
}

// Presses the HIP into an uneven cloud that rises by 2 mm a frame, so that every live parameter has an
// effect.
std::vector<RenderOutput> press_on_rising(const RendererEntry& entry, Renderer& renderer) {
  std::vector<RenderOutput> outputs;
  for (int tick = 0; tick < 300; ++tick) {
    if (tick % 33 == 0) {
      const int number = tick / 33;
      const double rise_m = 0.002 * number;
      PointCloud cloud = grid_for(entry, 60);
      for (std::size_t i = 0; i < cloud.size(); ++i)
        cloud.y[i] += rise_m + 0.0004 * static_cast<double>(i * i % 7);
      renderer.on_frame({number, 0.001 * tick, 0.001 * tick, scenes::frame(cloud).points});
    }
    const double depth = tick < 100 ? 0.02 - 0.0003 * tick : -0.01;
    outputs.push_back(renderer.step({Vec3(0.0001 * tick, depth, 0)}, 0.001 * tick));
  }
  return outputs;
}

bool same_outputs(const std::vector<RenderOutput>& a, const std::vector<RenderOutput>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const RenderOutput& x, const RenderOutput& y) {
    return x.proxy_W == y.proxy_W && x.force_N == y.force_N;
  });
}

void a_live_parameter_changed_before_the_start_is_a_setting(const RendererEntry& entry,
                                                            const FillSettings& fill) {
  const auto unchanged = press_on_rising(entry, *build(entry, fill));
  for (std::size_t i = 0; i < live_ones(filled(entry, fill)->settings()).size(); ++i) {
    const auto factory = filled(entry, fill);
    const Parameter setting = live_ones(factory->settings())[i];
    set_number(setting, other_value(setting));
    ASSERT_EQ(factory->validate(), "") << entry.name << ": " << setting.name;
    const auto made_so = factory->build(1000, scenes::kernels()), changed = build(entry, fill);
    set_number(changed->live_parameters()[i], number_of(setting));
    changed->parameters_changed();
    const auto as_made = press_on_rising(entry, *made_so);
    EXPECT_TRUE(same_outputs(as_made, press_on_rising(entry, *changed)))
        << entry.name << ": " << setting.name;
    EXPECT_FALSE(same_outputs(as_made, unchanged)) << entry.name << ": " << setting.name << " has no effect";
  }
}

// The parameter changes in contact: the force stays finite and bounded, and no memory is allocated.
void a_live_parameter_may_change_in_contact(const RendererEntry& entry, const FillSettings& fill) {
  const auto renderer = build(entry, fill);
  renderer->reserve(4000);
  renderer->on_frame(scenes::frame(grid_for(entry, 60)));
  resting_force(*renderer, 0.02, 0);
  const double height = contact_model_of(entry.name).pressed_hip_passes_through ? 0.003 : -0.008;
  resting_force(*renderer, height, 0.3);
  double time_s = 0.6;
  for (const Parameter& parameter : renderer->live_parameters()) {
    const double before = number_of(parameter);
    for (const double value : {other_value(parameter), before}) {
      const std::size_t allocated = allocation_count();
      set_number(parameter, value);
      renderer->parameters_changed();
      for (int tick = 0; tick < 50; ++tick) {
        const RenderOutput out = renderer->step({Vec3(0, height, 0)}, time_s += 0.001);
        ASSERT_TRUE(out.force_N.allFinite()) << entry.name << ": " << parameter.name;
        EXPECT_LT(out.force_N.norm(), 20) << entry.name << ": " << parameter.name;
      }
      EXPECT_EQ(allocation_count(), allocated) << entry.name << ": " << parameter.name;
    }
  }
}

void a_step_allocates_nothing(const RendererEntry& entry, const FillSettings& fill) {
  const auto renderer = build(entry, fill);
  renderer->on_frame(scenes::frame(grid_for(entry, 100)));
  for (int tick = 0; tick < 300; ++tick) {
    // Approach, press, slide fast, jump across the cloud.
    const Vec3 hip(tick < 200 ? 0 : 0.002 * (tick - 250), tick < 100 ? 0.02 - 0.0004 * tick : -0.02,
                   tick % 50 == 0 ? 0.05 : 0);
    const std::size_t before = allocation_count();
    renderer->step({hip}, 0.001 * tick);
    EXPECT_EQ(allocation_count(), before) << entry.name << " at tick " << tick;
  }
}

// `live` receives its frames as in a live loop: another part of the program prepares them, and keeps each of
// them at least until the next one has been handed over.
void a_prepared_frame_gives_the_same_answers_and_is_taken_without_allocating(const RendererEntry& entry,
                                                                             const FillSettings& fill) {
  const auto plain = build(entry, fill), live = build(entry, fill);
  live->reserve(4000);
  std::vector<Frame> held;
  for (int tick = 0; tick < 200; ++tick) {
    if (tick % 33 == 0) {
      const Frame frame = scenes::frame(grid_for(entry, 60 - tick / 33), tick / 33);
      plain->on_frame(frame);
      held.push_back(frame);
      live->prepare(held.back());
      const std::size_t before = allocation_count();
      live->on_frame(held.back());
      EXPECT_EQ(allocation_count(), before) << entry.name << " at tick " << tick;
    }
    const DeviceState device{Vec3(0.0001 * tick, 0.02 - 0.0004 * std::min(tick, 100), 0)};
    const RenderOutput a = plain->step(device, 0.001 * tick), b = live->step(device, 0.001 * tick);
    ASSERT_EQ(a.proxy_W, b.proxy_W) << entry.name << " at tick " << tick;
    ASSERT_EQ(a.force_N, b.force_N) << entry.name << " at tick " << tick;
  }
}

// A step allocates nothing even if guidance and a task run on top of the renderer.
void a_guided_step_allocates_nothing(const RendererEntry& entry, const FillSettings& fill) {
  std::vector<FixtureValues> fixtures(2);
  fixtures[0].label = "table";
  fixtures[1].label = "valve", fixtures[1].role = FixtureRole::guidance;
  SequenceStep lock, activate;
  lock.action = FixtureAction::lock, lock.fixture = "table", lock.not_before_s = 0.05;
  activate.action = FixtureAction::activate, activate.fixture = "valve", activate.start = StepStart::button;
  activate.end = StepEnd::reached, activate.deadline_s = 0.1;
  GuidedRenderer renderer(build(entry, fill), {}, fixtures, {lock, activate},
                          std::make_shared<FixtureSwitches>());
  Frame frame = scenes::frame(grid_for(entry, 100));
  frame.guidance = {{100, Vec3(0.2, 0, 0), Vec3::UnitY()}};
  renderer.on_frame(frame);
  RenderOutput out;
  for (int tick = 0; tick < 300; ++tick) {
    const DeviceState device{Vec3(0, 0.02 - 0.0004 * std::min(tick, 100), 0), Eigen::Quaterniond::Identity(),
                             tick / 10 % 10 == 9 ? 1u : 0u};
    const std::size_t before = allocation_count();
    out = renderer.step(device, 0.001 * tick);
    EXPECT_EQ(allocation_count(), before) << entry.name << " at tick " << tick;
  }
  EXPECT_EQ(out.guidance->sequence_missed, 1) << entry.name;
  EXPECT_TRUE(out.guidance->active) << entry.name;
}

void without_a_frame_the_proxy_is_the_hip(const RendererEntry& entry, const FillSettings& fill) {
  const auto renderer = build(entry, fill);
  const RenderOutput out = renderer->step({Vec3(1, 2, 3)}, 0);
  EXPECT_EQ(out.proxy_W, Vec3(1, 2, 3)) << entry.name;
  EXPECT_EQ(out.status, RenderStatus::no_frame) << entry.name;
  EXPECT_EQ(out.frame_index, -1) << entry.name;
}

void a_device_that_is_not_finite_gets_no_force_and_does_no_harm(const RendererEntry& entry,
                                                                const FillSettings& fill) {
  const auto renderer = build(entry, fill);
  const double height = contact_model_of(entry.name).pressed_hip_passes_through ? 0.002 : -0.02;
  renderer->on_frame(scenes::frame(grid_for(entry, 60)));
  // The HIP is pressed from 2 cm above until the proxy rests, because some proxies move by only millimetres a
  // tick.
  RenderOutput before;
  for (int tick = 0; tick < 100; ++tick)
    before = renderer->step({Vec3(0, tick == 0 ? 0.02 : height, 0)}, 0.001 * tick);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const RenderOutput out = renderer->step({Vec3(0, bad, 0)}, 0.1);
    EXPECT_EQ(static_cast<int>(out.status), static_cast<int>(RenderStatus::device_not_finite));
    EXPECT_TRUE(out.force_N.isZero(0)) << "a HIP that is not finite: " << out.force_N.transpose() << " N";
    EXPECT_TRUE(out.proxy_W.allFinite()) << "the proxy: " << out.proxy_W.transpose();
  }
  const RenderOutput after = renderer->step({Vec3(0, height, 0)}, 0.101);
  EXPECT_LE((after.proxy_W - before.proxy_W).norm(), 1e-3) << "the HIP is back: the proxy moved, m";
  EXPECT_GT(after.force_N.y(), 1) << "the HIP is back: the force before was " << before.force_N.y() << " N";
}

constexpr ContractCheck<RendererEntry> kRendererChecks[] = {
    {"ItsDefaultsAreValid", its_defaults_are_valid},
    {"NoForceInFreeSpace", no_force_in_free_space},
    {"HasAsManyDegreesOfFreedomAsItsEntrySays", has_as_many_degrees_of_freedom_as_its_entry_says},
    {"PushesTheHandOutOfTheSurface", pushes_the_hand_out_of_the_surface},
    {"IsAsStiffAsItSays", is_as_stiff_as_it_says},
    {"SameInputSameBits", same_input_same_bits},
    {"FramesWithoutPointsDoNoHarm", frames_without_points_do_no_harm},
    {"ItsLiveParametersAreThoseThatAreMarked", its_live_parameters_are_those_that_are_marked},
    {"ALiveParameterChangedBeforeTheStartIsASetting", a_live_parameter_changed_before_the_start_is_a_setting},
    {"ALiveParameterMayChangeInContact", a_live_parameter_may_change_in_contact},
    {"AStepAllocatesNothing", a_step_allocates_nothing},
    {"APreparedFrameGivesTheSameAnswersAndIsTakenWithoutAllocating",
     a_prepared_frame_gives_the_same_answers_and_is_taken_without_allocating},
    {"AGuidedStepAllocatesNothing", a_guided_step_allocates_nothing},
    {"WithoutAFrameTheProxyIsTheHip", without_a_frame_the_proxy_is_the_hip},
    {"ADeviceThatIsNotFiniteGetsNoForceAndDoesNoHarm",
     a_device_that_is_not_finite_gets_no_force_and_does_no_harm},
};

}  // namespace

std::span<const ContractCheck<RendererEntry>> renderer_checks() {
  return kRendererChecks;
}

}  // namespace remote_touch
