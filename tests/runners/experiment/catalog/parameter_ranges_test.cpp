// Every parameter of the catalogue: the values that it accepts and refuses, and that its value survives being
// written and read.
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/configuration.h"
#include "runners/experiment/settings/json_parameters.h"
#include "tests/support/test_files.h"

namespace remote_touch::parameter_ranges_test {
namespace {

// Programs write NaN as null, but a value made in memory can be NaN.
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Calls visit(make) for everything that has parameters; make() gives a new owner of default settings.
template <class Visit>
void for_each_owner(Visit visit) {
  for (const ExperimentSection& section : experiment_sections())
    for (const SectionEntry& entry : section.entries()) {
      SCOPED_TRACE(std::string(section.key) + " " + entry.name);
      visit(entry.make);
    }
}

template <class Visit>
void for_each_parameter(Visit visit) {
  for_each_owner([&](const auto& make) {
    const auto owner = make();
    for (const Parameter& p : owner->settings()) {
      SCOPED_TRACE(p.name);
      visit(p);
    }
  });
}

template <class Owner>
Json written(Owner& owner) {
  Json json = Json::object();
  write_parameters(owner.settings(), json);
  return json;
}

// Returns the message with which a parameter refuses a value, or an empty text if it accepts the value.
std::string refused(const Parameter& parameter, const Json& value) {
  try {
    read_parameters({{parameter.name, value}}, {parameter}, "part");
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

void expect_taken(const Parameter& parameter, const Json& value) {
  EXPECT_EQ(refused(parameter, value), "");
}

void expect_refused(const Parameter& parameter, const Json& value) {
  const bool lacks_number = std::holds_alternative<double*>(parameter.value) && !value.is_number();
  EXPECT_EQ(refused(parameter, value), "part." + parameter.name + " = " + value.dump() + ": expected " +
                                           (lacks_number ? "a number from " : "") + allowed(parameter));
}

bool is_number(const Parameter& p) {
  return std::holds_alternative<double*>(p.value) || std::holds_alternative<int*>(p.value) ||
         std::holds_alternative<std::uint64_t*>(p.value) || std::holds_alternative<Vec3*>(p.value);
}

// --- lists of parameters ---

TEST(Parameters, NamesAreUniqueAndHelpIsOneLine) {
  for_each_owner([](const auto& make) {
    const auto owner = make();
    std::set<std::string> names;
    for (const Parameter& p : owner->settings()) {
      EXPECT_TRUE(names.insert(p.name).second) << p.name << " is there twice";
      EXPECT_TRUE(std::islower(static_cast<unsigned char>(p.name.front()))) << p.name;
      EXPECT_EQ(p.name.find_first_of(". =\"\n"), std::string::npos) << p.name << " cannot be said with --set";
      EXPECT_FALSE(p.help.empty()) << p.name;
      EXPECT_EQ(p.help.find('\n'), std::string::npos) << p.name;
      EXPECT_NE(p.name, "name") << "is taken by the name of the part";
    }
  });
}

// Names of pure numbers, counts and pixels.
constexpr const char* kPure =
    "gamma max_missed_frames max_exit_steps xi phase_x phase_z steps_per_tick columns rows "
    "first_frame last_frame width height row first_column last_column column seed cell replicate "
    "normal strength min_saturation min_lightness max_lightness filter_window normal_window "
    "normal_step device_scale detections_per_tick colour_noise approach_axis "
    "max_tool_leaves max_patches min_points button fraction layers view_direction threshold "
    "normal_neighbours friction fused_frames view alpha persistence_hits persistence_frames "
    "mean_frames neighbours degree inner_spheres scale delay_ticks velocity_ticks "
    "damping_ratio mean_burst_packets least gain";

// True for pure numbers, counts and pixels, which have no unit, and for names that end in their unit or in
// the kind of fraction that they are.
bool carries_unit(const std::string& name) {
  std::istringstream words(kPure);
  static const std::set<std::string> pure(std::istream_iterator<std::string>(words), {});
  if (name == "value") return true;  // of a change: the unit of the parameter that changes
  return pure.contains(name) || unit_of(name) != nullptr;
}

TEST(Parameters, NumbersCarryTheirUnit) {
  for_each_parameter([](const Parameter& p) {
    std::vector<std::string> names;
    if (is_number(p)) names = {p.name};
    if (const auto* rows = std::get_if<Rows>(&p.value)) names = rows->columns;
    for (const std::string& name : names) EXPECT_TRUE(carries_unit(name)) << name;
  });
}

// Another value than the default, with as many digits as a number can have.
struct Change {
  const Parameter& p;
  double inside(double fraction) const { return p.low + fraction * (p.high - p.low); }
  void operator()(double* v) const { *v = inside(0.31415926535897931); }
  void operator()(int* v) const { *v = static_cast<int>(std::floor(inside(0.4))); }
  void operator()(std::uint64_t* v) const { *v = p.high > 1e19 ? 18446744073709551557u : 4294967291u; }
  void operator()(bool* v) const { *v = !*v; }
  void operator()(std::string* v) const { *v = "a \"name\" \\ of one's own: \u00fc"; }
  void operator()(Vec3* v) const { *v = Vec3(inside(0.1), inside(1.0 / 3), inside(0.7)); }
  void operator()(const Choice& c) const { c.set((c.get() + 1) % static_cast<int>(c.names.size())); }
  void operator()(const Rows& r) const {
    for (std::size_t i = 0; i < 3 * r.columns.size(); ++i)
      r.values->push_back(inside(1 / (3.0 + static_cast<double>(i))));
  }
};

TEST(Parameters, EveryValueSurvivesARoundTrip) {
  for_each_owner([](const auto& make) {
    const auto owner = make(), again = make();
    for (const Parameter& p : owner->settings()) std::visit(Change{p}, p.value);
    const Json changed = written(*owner);
    const Json defaults = written(*again);
    for (const auto& [name, value] : defaults.items()) EXPECT_NE(changed[name], value) << name;
    ASSERT_NO_THROW(read_parameters(Json::parse(changed.dump()), again->settings(), "part"));
    EXPECT_EQ(written(*again), changed);
  });
}

// --- values that a parameter accepts and refuses ---

// Checks each kind of parameter at both ends of its range and slightly outside.
struct Bounds {
  const Parameter& p;
  double below() const { return std::nextafter(p.low, -kInfinity); }
  double above() const { return std::nextafter(p.high, kInfinity); }

  void operator()(double*) const {
    EXPECT_LT(p.low, p.high);
    for (const double v : {p.low, p.high}) expect_taken(p, v);
    for (const double v : {below(), above(), kInfinity, -kInfinity, kNan}) expect_refused(p, v);
  }
  void operator()(int*) const {
    EXPECT_LT(p.low, p.high);
    const auto low = static_cast<std::int64_t>(p.low), high = static_cast<std::int64_t>(p.high);
    for (const std::int64_t v : {low, high}) expect_taken(p, v);
    for (const std::int64_t v : {low - 1, high + 1}) expect_refused(p, v);
    for (const double v : {p.low + 0.5, below(), above(), 1e300, kNan}) expect_refused(p, v);
  }
  void operator()(std::uint64_t*) const {
    expect_taken(p, 0u);
    expect_taken(
        p, p.high > 1e19 ? std::numeric_limits<std::uint64_t>::max() : static_cast<std::uint64_t>(p.high));
    expect_refused(p, -1);
    expect_refused(p, 0.5);
    expect_refused(p, above());
    if (p.high < 1e19) expect_refused(p, static_cast<std::uint64_t>(p.high) + 1);
  }
  void operator()(bool*) const { expect_taken(p, true), expect_taken(p, false); }
  void operator()(std::string*) const { expect_taken(p, ""), expect_taken(p, "a/b c"); }
  void operator()(Vec3*) const {
    EXPECT_LT(p.low, p.high);
    expect_taken(p, {p.low, 0, p.high});
    for (const double v : {below(), above(), kInfinity, kNan}) {
      expect_refused(p, {v, 0, 0});
      expect_refused(p, {0, 0, v});
    }
    expect_refused(p, {0, 0});
    expect_refused(p, {0, 0, 0, 0});
    expect_refused(p, {0, "0", 0});
  }
  void operator()(const Choice& choice) const {
    for (const std::string& name : choice.names) expect_taken(p, name);
    for (const std::string name : {"", "no such name"}) expect_refused(p, name);
    expect_refused(p, choice.names.front() + " ");
  }
  void operator()(const Rows& rows) const {
    const Json row(std::vector<double>(rows.columns.size(), p.high));
    Json long_row = row, high_row = row, text_row = row;
    long_row.push_back(0), high_row.back() = above(), text_row.back() = "0";
    expect_taken(p, Json::array());
    expect_taken(p, Json::array({row, row}));
    expect_refused(p, row);
    for (const Json& wrong : {long_row, high_row, text_row, Json::array(), Json(3)})
      expect_refused(p, Json::array({row, wrong}));
  }
};

TEST(Parameters, AcceptTheEndsOfTheRangeAndRefuseValuesOutside) {
  for_each_parameter([](const Parameter& p) { std::visit(Bounds{p}, p.value); });
}

TEST(Parameters, RefuseEveryOtherKind) {
  for_each_parameter([](const Parameter& p) {
    expect_refused(p, nullptr);
    expect_refused(p, Json::object());
    expect_refused(p, Json::array({Json::object()}));
    if (!std::holds_alternative<bool*>(p.value)) expect_refused(p, true);
    if (!std::holds_alternative<std::string*>(p.value)) expect_refused(p, "1");
    if (!is_number(p) || std::holds_alternative<Vec3*>(p.value)) expect_refused(p, 1);
    if (!std::holds_alternative<Rows>(p.value)) expect_refused(p, Json::array());
  });
}

TEST(Parameters, AWholeNumberMayBeWrittenWithAPoint) {
  int count = 0;
  const Parameters list = {{"count", &count, 0, 10, "a count"}};
  read_parameters(Json::parse(R"({"count": 3.0})"), list, "part");
  EXPECT_EQ(count, 3);
}

TEST(Parameters, ALongValueIsShortenedInTheMessage) {
  int count = 0;
  const Parameter p{"count", &count, 0, 10, "a count"};
  const std::string message = refused(p, std::string(5000, 'x'));
  EXPECT_LT(message.size(), 300u);
  EXPECT_HAS(message, "part.count = \"xxx");
  EXPECT_HAS(message, "...: expected integers 0 to 10");
}

}  // namespace
}  // namespace remote_touch::parameter_ranges_test
