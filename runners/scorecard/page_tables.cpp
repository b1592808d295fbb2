#include "runners/scorecard/page_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runners/scorecard/formatted.h"
#include "runners/scorecard/noise_plot.h"
#include "runners/scorecard/passivity.h"

namespace remote_touch {

namespace {

std::string cell(const std::string& text, const char* kind = "") {
  return std::string("<td") + (*kind ? std::string(" class=\"") + kind + "\"" : "") + ">" + text + "</td>";
}

std::string head(const std::string& text) {
  return "<th>" + escaped(text) + "</th>";
}

std::string method_cell(const Scorecard& card, std::size_t c) {
  return "<th class=\"name\" title=\"" + escaped(card.method_titles[c]) +
         formatted("\"><i class=\"k%zu\"></i>", c) + escaped(card.methods[c]) + "</th>";
}

// Best, worst or neither, of a method.
const char* mark(const Ranking& ranking, std::size_t method) {
  if (ranking.order.empty()) return "";
  if (ranking.has_best && ranking.order.front() == method) return "best";
  if (ranking.has_worst && ranking.order[ranking.ranked - 1] == method) return "worst";
  return "";
}

struct Scale {
  double factor = 1;
  const char* units = "";
};
// Metres and joules in thousandths.
Scale scale_of(const std::string& units) {
  if (units == "m") return {1e3, "mm"};
  if (units == "J") return {1e3, "mJ"};
  if (units == "s") return {1e3, "ms"};
  return {1, units == "1" ? "" : units.c_str()};
}

std::string number(double value) {
  return std::isnan(value) ? "-" : formatted("%.3g", value);
}

std::string with_interval(const MeanDifference& mean, double factor) {
  if (mean.pairs == 0) return "-";
  std::string text = number(factor * mean.mean);
  if (!std::isnan(mean.low))
    text += "<small> " + number(factor * mean.low) + " .. " + number(factor * mean.high) + "</small>";
  return text;
}

const char* better_text(Better better) {
  switch (better) {
    case Better::larger:
      return "larger is better, successes";
    case Better::smaller:
      return "smaller is better, successes";
    case Better::near_zero:
      return "near zero is better, successes";
    case Better::reported:
      break;
  }
  return "not judged, all runs";
}

std::string fraction_text(const Proportion& fraction) {
  return formatted("%.2f <small>%.2f .. %.2f</small>", fraction.fraction, fraction.low, fraction.high);
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// Where both were measured: no NaN may come between numbers that are sorted.
void add_cost(double own_s, double other_s, std::vector<double>& ratio, std::vector<double>& own_us) {
  if (!(std::isfinite(own_s) && std::isfinite(other_s) && own_s > 0 && other_s > 0)) return;
  ratio.push_back(own_s / other_s), own_us.push_back(1e6 * own_s);
}

std::string failure_link(const FailureTrace& failure, const SceneScore& scene) {
  const std::string level = level_text(scene.noise_m[failure.level]);
  if (failure.file.empty())
    return "error at " + level + ", run " + std::to_string(failure.replicate) + ": " + escaped(failure.error);
  return "<a href=\"" + escaped(failure.file) + "\">trace</a> at " + level + ": <code>" +
         escaped(failure.command) + "</code>";
}

}  // namespace

std::string overview_table(const ScorecardPage& page) {
  std::string table = "<table><tr>" + head("") + head("scenes held in more than 90 % of the runs") +
                      head("best alone") + head("worst alone") + head("mean share of successes") + "</tr>";
  for (std::size_t c = 0; c < page.card.methods.size(); ++c) {
    int held = 0, best = 0, worst = 0;
    double sum = 0;
    for (const SceneScore& scene : page.card.scenes) {
      const std::string place = mark(scene.ranking, c);
      held += scene.success_overall[c].fraction > 0.9;
      best += place == "best", worst += place == "worst";
      sum += scene.success_overall[c].fraction;
    }
    const auto scenes = static_cast<double>(std::max<std::size_t>(1, page.card.scenes.size()));
    table += "<tr>" + method_cell(page.card, c) +
             cell(formatted("%d of %zu", held, page.card.scenes.size())) + cell(std::to_string(best)) +
             cell(std::to_string(worst)) + cell(formatted("%.2f", sum / scenes)) + "</tr>";
  }
  return table + "</table>";
}

std::string success_table(const ScorecardPage& page, std::size_t number_of_scene) {
  const SceneScore& scene = page.card.scenes[number_of_scene];
  std::string table = "<table><tr>" + head("noise / r_c");
  for (const double noise : scene.noise_m) table += head(level_text(noise));
  table += head("all, 95 % interval") + head("a typical failure, at the lowest noise that has one") + "</tr>";
  for (std::size_t c = 0; c < page.card.methods.size(); ++c) {
    table += "<tr>" + method_cell(page.card, c);
    for (const Proportion& fraction : scene.success[c]) {
      const char* kind = fraction.events == fraction.runs ? "all" : fraction.events == 0 ? "none" : "some";
      table += cell(formatted("%d/%d", fraction.events, fraction.runs), kind);
    }
    table += cell(fraction_text(scene.success_overall[c]), mark(scene.ranking, c));
    const auto& failure = page.failures[number_of_scene][c];
    table += cell(failure ? failure_link(*failure, scene) : std::string("none"), "left") + "</tr>";
  }
  return table + "</table>";
}

std::string measure_table(const ScorecardPage& page, std::size_t number_of_scene) {
  const SceneScore& scene = page.card.scenes[number_of_scene];
  std::string table = "<table><tr>" + head("");
  for (const JudgedMeasure& measure : scene.measures)
    table += "<th>" + escaped(measure.name) + " " + scale_of(measure.units).units + "<br><small>" +
             better_text(measure.better) + "</small></th>";
  table += "</tr>";
  for (std::size_t c = 0; c < page.card.methods.size(); ++c) {
    table += "<tr>" + method_cell(page.card, c);
    for (const JudgedMeasure& measure : scene.measures) {
      const bool is_judged = measure.better != Better::reported;
      table += cell(with_interval(measure.ranking.mean[c], scale_of(measure.units).factor),
                    is_judged ? mark(measure.ranking, c) : "");
    }
    table += "</tr>";
  }
  return table + "</table>";
}

std::string level_tables(const ScorecardPage& page, std::size_t number_of_scene) {
  const SceneScore& scene = page.card.scenes[number_of_scene];
  if (scene.noise_m.size() < 2) return "";
  std::string text = "<details><summary>measures at each noise level</summary>";
  for (const JudgedMeasure& measure : scene.measures) {
    text += "<table><tr><th>" + escaped(measure.name) + " " + scale_of(measure.units).units + "</th>";
    for (const double noise : scene.noise_m) text += head(level_text(noise));
    text += "</tr>";
    for (std::size_t c = 0; c < page.card.methods.size(); ++c) {
      text += "<tr>" + method_cell(page.card, c);
      for (const MeanDifference& mean : measure.at_level[c])
        text += cell(with_interval(mean, scale_of(measure.units).factor));
      text += "</tr>";
    }
    text += "</table>";
  }
  return text + "</details>";
}

std::string verdict(const Scorecard& card, const SceneScore& scene) {
  const Ranking& ranking = scene.ranking;
  if (ranking.ranked < 2) return "";
  std::string text;
  if (ranking.has_best) {
    text = "Best: " + card.methods[ranking.order.front()] + ".";
  } else if (ranking.top_group.size() == ranking.ranked) {
    text = "No difference between any.";
  } else {
    text = "No difference at the top:";
    for (const std::size_t c : ranking.top_group)
      text += (c == ranking.top_group.front() ? " " : ", ") + card.methods[c];
    text += ".";
  }
  if (ranking.has_worst) text += " Worst: " + card.methods[ranking.order[ranking.ranked - 1]] + ".";
  return text;
}

std::string cost_table(const ScorecardPage& page) {
  const auto& names = page.card.methods;
  const auto proxy = std::find(names.begin(), names.end(), "proxy");
  const std::string reference = proxy != names.end() ? *proxy : names.front();
  std::string table = "<table><tr>" + head("") + head("tick / " + reference + "'s") +
                      head("frame / " + reference + "'s") + head("tick, us") + head("frame, us") + "</tr>";
  for (std::size_t c = 0; c < names.size(); ++c) {
    std::vector<double> tick_ratio, frame_ratio, tick, frame;
    for (const SceneScore& scene : page.card.scenes) {
      const Cost* own = find_cost(page.costs, scene.name, names[c]);
      const Cost* other = find_cost(page.costs, scene.name, reference);
      if (!own || !other) continue;
      add_cost(own->tick_s, other->tick_s, tick_ratio, tick);
      add_cost(own->frame_s, other->frame_s, frame_ratio, frame);
    }
    table += "<tr>" + method_cell(page.card, c) + cell(number(median(tick_ratio))) +
             cell(number(median(frame_ratio))) + cell(number(median(tick))) + cell(number(median(frame))) +
             "</tr>";
  }
  return table + "</table>";
}

std::string audit_table(const Scorecard& audit) {
  const SceneScore& scene = audit.scenes.front();
  const auto named = [&](const char* name) {
    return std::find_if(scene.measures.begin(), scene.measures.end(),
                        [&](const JudgedMeasure& measure) { return measure.name == name; });
  };
  const auto cycles = named("energy_injected"), updates = named("mean_energy_per_update");
  if (cycles == scene.measures.end() || updates == scene.measures.end()) return "";
  std::string table = "<table><tr>" + head("noise / r_c");
  for (const double noise : scene.noise_m) table += head(level_text(noise));
  table += head("runs that are passive and felt") + "</tr>";
  for (std::size_t c = 0; c < audit.methods.size(); ++c) {
    table += "<tr><th class=\"name\" title=\"" + escaped(audit.method_titles[c]) + "\">" +
             escaped(audit.methods[c]) + "</th>";
    for (std::size_t i = 0; i < scene.noise_m.size(); ++i) {
      const MeanDifference& all = cycles->at_level[c][i];
      // The interval excludes zero: energy for certain, or none for certain.
      const char* kind = all.low > 0 ? "worst" : all.high < 0 ? "best" : "";
      table += cell(number(1e3 * all.mean / kPassivityCycles) + " <small>" +
                        number(1e3 * updates->at_level[c][i].mean) + "</small>",
                    kind);
    }
    table += cell(fraction_text(scene.success_overall[c])) + "</tr>";
  }
  return table + "</table>";
}

}  // namespace remote_touch
