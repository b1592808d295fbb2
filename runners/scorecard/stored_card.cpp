#include "runners/scorecard/stored_card.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/figures/result_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "core/parameters/input_error.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

namespace {

constexpr const char* kMadeBy = "a card that `remote-touch scorecard store` wrote";

// Every column of one of its tables.
Table table_in(const Hdf5Reader& file, const std::string& name) {
  Table table{name, {}};
  const std::string folder = "/tables/" + name + "/";
  for (const std::string& path : file.datasets()) {
    if (!path.starts_with(folder)) continue;
    table.columns.push_back(file.column(path));
    table.columns.back().name = path.substr(folder.size());
  }
  if (table.columns.empty()) file.damaged("has no table " + name);
  return table;
}

std::vector<std::string> names_in(const Json& configuration, const char* kind) {
  std::vector<std::string> names;
  for (const auto& item : configuration.at(kind).items()) names.push_back(item.key());
  return names;
}

// Of the methods or scenes of now, those that the stored card has not, or has in another form.
void compare_definitions(const Json& stored, const Json& now, const char* kind, const char* one,
                         std::vector<std::string>& list) {
  for (const auto& item : now.at(kind).items()) {
    const auto found = stored.at(kind).find(item.key());
    if (found == stored.at(kind).end())
      list.push_back(std::string(one) + " " + item.key() + ": not in the stored card");
    else if (*found != item.value())
      list.push_back(std::string(one) + " " + item.key() + ": defined in another way in the stored card");
  }
}

}  // namespace

std::string configuration_of(const BenchmarkPlan& plan) {
  std::vector<BenchmarkScene> scenes;
  for (const ScenePlan& planned : plan.scenes) scenes.push_back(planned.scene);
  return configuration(plan.benchmark.methods, scenes, plan.benchmark.replicates);
}

std::string write_stored_card(const std::filesystem::path& file, const Scorecard& card,
                              const TextAttributes& provenance) {
  const CardNumbers numbers = numbers_of(card);
  return write_figure(file,
                      {kStoredCardFigure,
                       "Stored scorecard",
                       "Successes and means with their intervals, for remote-touch scorecard check.",
                       {counts_table(numbers), means_table(numbers)}},
                      provenance);
}

StoredCard read_stored_card(const std::filesystem::path& file) {
  const Hdf5Reader hdf5(file);
  hdf5.require_kind("figure", kMadeBy);
  if (attribute(hdf5.attributes(), "figure") != kStoredCardFigure)
    throw InputError(file.string(), std::string("not a stored card: expected ") + kMadeBy);
  StoredCard stored{attribute(hdf5.attributes(), "config"), 0, {}, {}, {}};
  try {
    const Json all = Json::parse(stored.configuration);
    stored.replicates = all.at("replicates").get<int>();
    stored.methods = names_in(all, "methods"), stored.scenes = names_in(all, "scenes");
    stored.numbers = numbers_in(table_in(hdf5, "success"), table_in(hdf5, "measures"));
  } catch (const nlohmann::json::exception&) {
    hdf5.damaged("has no configuration of a scorecard");
  } catch (const std::out_of_range& missing) {
    hdf5.damaged(missing.what());
  }
  return stored;
}

std::vector<std::string> differences(const StoredCard& stored, const BenchmarkPlan& plan,
                                     const Scorecard& now) {
  std::vector<std::string> list;
  const Json then = Json::parse(stored.configuration), here = Json::parse(configuration_of(plan));
  compare_definitions(then, here, "methods", "method", list);
  compare_definitions(then, here, "scenes", "scene", list);
  const std::vector<std::string> numbers = differences(stored.numbers, numbers_of(now));
  list.insert(list.end(), numbers.begin(), numbers.end());
  return list;
}

}  // namespace remote_touch
