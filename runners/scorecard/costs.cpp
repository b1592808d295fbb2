#include "runners/scorecard/costs.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/whole_file.h"
#include "runners/json_parameters.h"
#include "runners/simulation.h"

namespace remote_touch {

namespace {

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(values.size());
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

}  // namespace

Cost measured_cost(const ContestSweep& sweep, const std::string& scene, const std::string& contender,
                   const Kernels& kernels, const std::atomic<bool>* stop) {
  constexpr std::size_t kLevel = 3;
  const std::size_t cell = std::min(kLevel, sweep.sweep.plan().cell_count() - 1);
  Cost best{scene, contender, std::numeric_limits<double>::infinity(), 0};
  for (int round = 0; round < 2; ++round) {
    std::vector<double> ticks, frames;
    SimulationOptions options;
    options.kernels = &kernels, options.stop = stop;
    options.step_duration_s = &ticks, options.frame_duration_s = &frames;
    simulate(sweep.sweep.experiment(cell, 0), options);
    if (mean(ticks) < best.tick_s) best.tick_s = mean(ticks), best.frame_s = mean(frames);
  }
  return best;
}

void write_costs(const std::filesystem::path& file, const std::vector<Cost>& costs) {
  Json list = Json::array();
  for (const Cost& cost : costs)
    list.push_back({{"scene", cost.scene},
                    {"contender", cost.contender},
                    {"tick_s", number(cost.tick_s)},
                    {"frame_s", number(cost.frame_s)}});
  const std::string text = list.dump(1) + "\n";
  write_whole_file(file, text.data(), text.size());
}

std::vector<Cost> read_costs(const std::filesystem::path& file) {
  std::ifstream in(file);
  const Json list = Json::parse(in, nullptr, false);
  std::vector<Cost> costs;
  if (!list.is_array()) return costs;
  const auto seconds = [](const Json& value) {
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
  };
  for (const Json& item : list) {
    if (!item.is_object() || !item.value("scene", Json()).is_string() ||
        !item.value("contender", Json()).is_string())
      return {};
    costs.push_back({item["scene"].get<std::string>(), item["contender"].get<std::string>(),
                     seconds(item.value("tick_s", Json())), seconds(item.value("frame_s", Json()))});
  }
  return costs;
}

const Cost* find_cost(const std::vector<Cost>& costs, const std::string& scene,
                      const std::string& contender) {
  for (const Cost& cost : costs)
    if (cost.scene == scene && cost.contender == contender) return &cost;
  return nullptr;
}

}  // namespace remote_touch
