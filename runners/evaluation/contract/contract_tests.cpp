#include "runners/evaluation/contract/contract_tests.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "core/parameters/input_error.h"
#include "runners/evaluation/contract/checks.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

namespace {

// One rule for one entry.
class ContractTest : public testing::Test {
 public:
  explicit ContractTest(std::function<void()> body) : body_(std::move(body)) {}
  void TestBody() override { body_(); }

 private:
  std::function<void()> body_;
};

void register_test(const char* suite, const std::string& name, const std::function<void()>& body) {
  testing::RegisterTest(suite, name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                        [body] { return new ContractTest(body); });
}

template <class Entry>
void register_checks(const char* suite, std::span<const Entry> entries,
                     std::span<const ContractCheck<Entry>> checks, const FillSettings& fill) {
  for (const Entry& entry : entries)
    for (const ContractCheck<Entry>& check : checks)
      register_test(suite, std::string(check.name) + "/" + entry.name,
                    [entry, fill, of = check.of] { of(entry, fill); });
}

template <class Entry>
void add_all(Catalog& catalog, std::span<const Entry> entries) {
  for (const Entry& entry : entries) catalog.add(entry);
}

Catalog with_built_in(const Catalog& catalog) {
  Catalog all = built_in_catalog();
  const Catalog own = own_entries(catalog);
  add_all(all, own.scenarios()), add_all(all, own.fixtures()), add_all(all, own.trajectories());
  add_all(all, own.renderers()), add_all(all, own.measures());
  return all;
}

}  // namespace

void check_settings(Configurable& factory) {
  std::set<std::string> names = {"name"};  // of the entry itself, in every configuration
  for (const Parameter& p : factory.settings()) {
    EXPECT_TRUE(names.insert(p.name).second) << "a setting called " << p.name << ": expected another name";
    EXPECT_FALSE(p.help.empty()) << p.name << ": expected a line of help";
    Json value = Json::object();
    write_parameters({p}, value);
    try {
      read_parameters(value, {p}, "");
    } catch (const InputError& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_EQ(factory.validate(), "");
}

void register_contract_tests(const Catalog& catalog, const FillSettings& fill) {
  use_catalog(with_built_in(catalog));
  register_checks("ScenarioContract", catalog.scenarios(), scenario_checks(), fill);
  register_checks("FixtureContract", catalog.fixtures(), fixture_checks(), fill);
  register_checks("TrajectoryContract", catalog.trajectories(), trajectory_checks(), fill);
  register_checks("RendererContract", catalog.renderers(), renderer_checks(), fill);
  register_checks("MeasureContract", catalog.measures(), measure_checks(), fill);
}

}  // namespace remote_touch
