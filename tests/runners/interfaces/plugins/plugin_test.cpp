// Renderers in shared libraries. The libraries are test doubles: tests/doubles/plugin_renderers.cpp,
// plugin_mistakes.c; and endless_plugin.c here.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/storage/digest.h"
#include "analysis/trace/trace.h"
#include "core/dissertation/proxy/proxy_renderer.h"
#include "runners/evaluation/contract/contract_tests.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/plugins/plugin_library.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::plugin_test {
namespace {

// The good renderer keeps every contract.
Catalog good_renderer() {
  Catalog own;
  own.add(load_plugin(PLUGIN_RENDERERS).front());
  return own;
}
const bool kRegistered = (register_contract_tests(good_renderer()), true);

const RendererEntry& entry_of(const std::string& name) {
  static const std::vector<RendererEntry> all = load_plugin(PLUGIN_RENDERERS);
  return find_entry(std::span<const RendererEntry>(all), name, "renderer");
}

std::unique_ptr<Renderer> build(const std::string& name) {
  return entry_of(name).make()->build(1000, scenes::kernels());
}

TEST(Plugin, ARendererGivesTheSameBitsAsTheOneBuiltIn) {
  ASSERT_TRUE(kRegistered);
  for (const char* experiment : {"fig4.11", "fig4.12", "fig4.14", "fig5.5"}) {
    SCOPED_TRACE(experiment);
    const Json built_in = Json::parse(Experiment::load(experiment).to_json());
    Json other = built_in, plugged = built_in;
    other["renderer"] = {{"name", "proxy"}};
    plugged["renderer"] = {{"name", "plug-in-proxy"}};
    const Trace a = simulate(Experiment::from_json(other)), b = simulate(Experiment::from_json(plugged));
    EXPECT_EQ(digest(a.columns()), digest(b.columns()));
    EXPECT_GT(std::count_if(a.force_N.begin(), a.force_N.end(), [](const Vec3& f) { return !f.isZero(0); }),
              10);
  }
}

TEST(Plugin, SettingsAreThoseOfTheLibrary) {
  const auto factory = entry_of("plug-in-proxy").make();
  const Parameters settings = factory->settings();
  ASSERT_EQ(settings.size(), 2u);
  EXPECT_EQ(settings[0].name, "r1_m");
  EXPECT_FALSE(settings[0].is_live);
  EXPECT_TRUE(settings[1].is_live);
  EXPECT_EQ(*std::get<double*>(settings[0].value), ProxyParameters{}.r1_m);
  EXPECT_EQ(factory->contact().rest_distance_m, ProxyParameters{}.contact_radius_m());
  *std::get<double*>(settings[0].value) = 0.5;
  EXPECT_HAS(factory->validate(), "r1_m");
  EXPECT_HAS(refusal([&] { factory->build(1000, scenes::kernels()); }),
             "plug-in renderer plug-in-proxy: create");
}

TEST(Plugin, AProblemIsOneLine) {
  const auto step = [](const char* name) {
    return refusal([&] {
      const auto renderer = build(name);
      renderer->on_frame(scenes::frame(scenes::flat_grid(10)));
      renderer->step({}, 0);
    });
  };
  EXPECT_EQ(step("throws"), "plug-in renderer throws: step: threw an exception: the spring broke");
  EXPECT_EQ(step("refuses-step"), "plug-in renderer refuses-step: step: the spring is tired");
  EXPECT_HAS(step("refuses-frame"), "plug-in renderer refuses-frame: on_frame: xxxx");
  EXPECT_EQ(step("unknown-state"), "plug-in renderer unknown-state: state = 9: expected 0 to 2");
}

TEST(Plugin, ALibraryWithAMistakeIsRefused) {
  const auto load = [](int mistake) {
    return refusal([&] {
      load_plugin(std::string(PLUGIN_FOLDER "/libplugin_mistake_") + std::to_string(mistake) + ".so");
    });
  };
  EXPECT_HAS(load(0), "has no renderer for version 1 of the interface");
  EXPECT_HAS(load(1), "a renderer without name or summary");
  EXPECT_HAS(load(2), "mistaken: degrees_of_freedom: expected 3 or 6");
  EXPECT_HAS(load(3), "mistaken: lacks the function step");
  EXPECT_HAS(load(4), "mistaken: a_m = nan: expected 0 to 2");
  EXPECT_HAS(load(5), "mistaken: has live settings and no set_values");
  EXPECT_HAS(load(7), "mistaken: settings: expected at most");
  EXPECT_HAS(load(8), "mistaken: contact_model");
  EXPECT_HAS(refusal([] { load_plugin(ENDLESS_PLUGIN); }), "has too many renderers: expected at most 1000");
  Catalog catalog = built_in_catalog();
  EXPECT_EQ(refusal([&] { catalog.add(load_plugin(PLUGIN_FOLDER "/libplugin_mistake_6.so").front()); }),
            "renderer \"proxy\": is in the catalog already");
}

// A renderer whose functions that free something throw; its prepared frames are this number.
int number_to_free = 0;
remote_touch_renderer throws_when_freed() {
  remote_touch_renderer functions{};
  functions.name = "throws-when-freed", functions.summary = "for tests";
  functions.degrees_of_freedom = 3;
  functions.create = [](const double*, double, char*, std::size_t) -> void* { return &number_to_free; };
  functions.destroy = [](void*) { throw std::runtime_error("it cannot be destroyed"); };
  functions.prepare = [](const void*, const remote_touch_frame*, char*, std::size_t) -> void* {
    return &number_to_free;
  };
  functions.release = [](void*) { throw std::runtime_error("it cannot be released"); };
  return functions;
}

TEST(Plugin, AnExceptionOfAFunctionThatFreesIsIgnored) {
  const remote_touch_renderer functions = throws_when_freed();
  const auto factory = plugin_factory(functions);
  EXPECT_EQ(factory->validate(), "");
  auto renderer = factory->build(1000, scenes::kernels());
  Frame frame = scenes::frame(scenes::flat_grid(10));
  renderer->prepare(frame);
  EXPECT_TRUE(frame.prepared);
  frame.prepared.reset();
  renderer.reset();
}

// Returns a renderer whose functions throw a number, which is no std::exception.
remote_touch_renderer throws_a_number() {
  remote_touch_renderer functions{};
  functions.name = "throws-a-number", functions.summary = "for tests", functions.degrees_of_freedom = 3;
  functions.max_stiffness_N_per_m = [](const double*) -> double { throw 1; };
  functions.rest_distance_m = [](const double*) -> double { throw 1; };
  functions.create = [](const double*, double, char*, std::size_t) -> void* { throw 1; };
  return functions;
}

TEST(Plugin, ANumberThatIsThrownIsAnInputErrorOfItsFunction) {
  const remote_touch_renderer functions = throws_a_number();
  const auto factory = plugin_factory(functions);
  const auto text = [](const std::string& function) {
    return "plug-in renderer throws-a-number: " + function + ": threw an exception";
  };
  EXPECT_EQ(refusal([&] { factory->stiffness_N_per_m(); }), text("max_stiffness_N_per_m"));
  EXPECT_EQ(refusal([&] { factory->contact(); }), text("rest_distance_m"));
  EXPECT_EQ(refusal([&] { factory->validate(); }), text("create"));
  EXPECT_EQ(refusal([&] { factory->build(1000, scenes::kernels()); }), text("create"));
}

TEST(Plugin, OtherFilesAreRefused) {
  const TestFolder folder("plugin");
  const auto load = [](const std::string& file) { return refusal([&] { load_plugin(file); }); };
  EXPECT_HAS(load((folder / "absent.so").string()), "no such file");
  EXPECT_HAS(load(folder.path().string()), "no such file");
  EXPECT_HAS(load(folder.write("text.so", "not a library").string()), "--plugin");
  EXPECT_HAS(load(folder.write("empty.so", "").string()), "--plugin");
}

}  // namespace
}  // namespace remote_touch::plugin_test
