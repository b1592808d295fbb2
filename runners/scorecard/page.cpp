#include "runners/scorecard/page.h"

#include <string>

#include "runners/scorecard/noise_plot.h"
#include "runners/scorecard/page_tables.h"

namespace remote_touch {

namespace {

constexpr const char* kStyle = R"(
body{font:15px/1.4 system-ui,sans-serif;max-width:1250px;margin:1.5em auto;padding:0 1em;color:#222}
h2{margin:1.6em 0 .2em;border-top:1px solid #ddd;padding-top:.6em}
table{border-collapse:collapse;margin:.5em 0;font-size:13px}
th,td{border:1px solid #ddd;padding:2px 7px;text-align:right;font-weight:normal;vertical-align:top}
th.name{text-align:left;white-space:nowrap}td.left{text-align:left}
small{color:#777}code{font-size:11px}
i{display:inline-block;width:10px;height:10px;border-radius:5px;margin-right:5px}
td.best{background:#c8ecd2;font-weight:bold}td.worst{background:#f6cdc6}
td.all{background:#eaf7ee}td.none{background:#fbe9e6}
.scene{display:flex;flex-wrap:wrap;gap:0 1.5em;align-items:flex-start}
svg{width:420px;height:190px;font-size:11px}svg text{fill:#555}.grid{stroke:#e4e4e4;fill:none}
.line{fill:none;stroke-width:1.4;opacity:.75}.bar{stroke-width:1;opacity:.55;fill:none}
)";

std::string colours(std::size_t methods) {
  std::string css;
  for (std::size_t c = 0; c < methods; ++c) {
    const std::string n = std::to_string(c), colour = method_colour(c);
    css += ".c" + n + " path{stroke:" + colour + "}.c" + n + " circle{fill:" + colour + "}.k" + n +
           "{background:" + colour + "}\n";
  }
  return css;
}

// What has to be known to read the tables.
std::string how_to_read(const ScorecardPage& page) {
  const std::string runs = std::to_string(page.replicates), seed = std::to_string(kScorecardSeed),
                    tuned = std::to_string(kLastTunedSeed), pairs = std::to_string(kMinPairs);
  return "<p>Each method ran each scene " + runs +
         " times at each noise level, in units of the contact radius r_c = 5 mm (own: the scene has its own "
         "noise). Noise is keyed by seed " +
         seed +
         ", level and number of the run, not by method: all met the same points in the same frames. The "
         "parameters of the tracked sheet were fixed with seeds 1 to " +
         tuned +
         ", which no run here has. Lines are shares of successful runs with Wilson's 95 % intervals. Where "
         "there is no noise and all runs of a method have the same numbers to the last bit, they count as one "
         "run, in every share and mean, and in a comparison where that is so of both.</p>"
         "<p><b>Success.</b> A surface counts as held while the proxy is no deeper than 0.5 r_c below it; popped "
         "through means lost to the other side. This does not ask the same of all: a proxy that is a ball rests "
         "1 r_c above a surface and may sink by 1.5 r_c, one that is a point rests on it, with noise a little "
         "below, and may sink by 0.5 r_c; the surface of metaballs lies higher than either. Direct rendering has "
         "no proxy: its place is the HIP itself, and where a scene presses deeper than 0.5 r_c it is lost. What "
         "is held has to be felt too: a force in the last 0.1 s or, where the path ends in the open, in a "
         "quarter of the ticks.</p>"
         "<p><b>Best and worst</b> are marked only where the paired differences to all others, run by run over "
         "all noise levels, have 95 % intervals on the better, or the worse, side of zero (shares: Agresti and "
         "Min; else the percentile bootstrap with fixed keys); otherwise these runs do not show it. A measure "
         "that is judged is compared over the pairs of runs in which both succeeded, and with fewer than " +
         pairs +
         " such pairs there is no verdict; its means are over the successful runs of each, so who succeeds only "
         "where it is easy has the mean of easy runs. A measure that is not judged has its mean over all runs "
         "that have a number. The intervals are not adjusted for how many comparisons there are.</p>";
}

std::string scene_section(const ScorecardPage& page, std::size_t number) {
  const SceneScore& scene = page.card.scenes[number];
  return "<h2 id=\"" + escaped(scene.name) + "\">" + escaped(scene.name) + "</h2>\n<p>" +
         escaped(scene.title) + ".<br>Success is " + escaped(scene.meaning) + ". <b>" +
         escaped(verdict(page.card, scene)) + "</b></p>\n<div class=\"scene\">" +
         noise_plot(scene, page.card.methods) + "<div>" + measure_table(page, number) + "</div></div>\n" +
         success_table(page, number) + level_tables(page, number) + "\n";
}

std::string costs_section(const ScorecardPage& page) {
  if (page.costs.empty() || page.card.scenes.empty()) return "";
  return "<h2 id=\"costs\">Costs</h2><p>Wall clock on " +
         escaped(page.cpu.empty() ? "the machine that made this page" : page.cpu) +
         ", one thread, one run of each scene at 0.6 r_c, medians over the scenes. Frames came with all their "
         "points made: neither ticks nor frames contain the making of noise. Not the same twice: in costs.json, "
         "outside of every digest. Proxy steps per tick are the measure mean_steps of the sweeps in runs/.</p>" +
         cost_table(page);
}

std::string audit_section(const ScorecardPage& page) {
  if (!page.audit) return "";
  return "<h2 id=\"audit\">Passivity</h2><p>A hand, a mass that a spring and a damper draw along closed cycles, "
         "presses and slides on a plane at rest and is moved by the rendered force. In each cell the energy "
         "that the hand got from the renderer in a cycle, and small from one frame update to the next while "
         "there is force, in mJ: below 0 the renderer took energy, as one does, too, that loses the surface and is "
         "pressed into it again. Red: its 95 % interval is above 0, green: below it; one run alone has none. "
         "v_plus and v_none are the sign of the velocity term of (4.15), minus where nothing is said; k_d3 is "
         "a damper of 3 Ns/m in (4.16), and k_d_minus its printed sign.</p>" +
         audit_table(*page.audit);
}

std::string skipped_section(const ScorecardPage& page) {
  std::string text;
  for (const auto& [name, why] : page.skipped)
    text +=
        "<p id=\"" + escaped(name) + "\"><b>Skipped: " + escaped(name) + "</b>, " + escaped(why) + "</p>\n";
  return text;
}

std::string contents(const ScorecardPage& page) {
  std::string text = "<p>";
  for (const SceneScore& scene : page.card.scenes)
    text += "<a href=\"#" + escaped(scene.name) + "\">" + escaped(scene.name) + "</a> ";
  if (page.audit) text += "<a href=\"#audit\">passivity audit</a> ";
  return text + "<a href=\"#costs\">costs</a></p>";
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else
      safe += c;
  }
  return safe;
}

std::string html(const ScorecardPage& page) {
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Scorecard</title><style>" +
      std::string(kStyle) + colours(page.card.methods.size()) +
      "</style></head><body>\n<h1>Scorecard of 3-DOF renderers</h1>\n" + how_to_read(page) + "\n";
  text += skipped_section(page) + overview_table(page) + "\n" + contents(page) + "\n";
  for (std::size_t i = 0; i < page.card.scenes.size(); ++i) text += scene_section(page, i);
  text += audit_section(page) + "\n" + costs_section(page) + "\n<p><small>" + escaped(page.origin) +
          "; everything simulated. Numbers: scorecard.h5; every run: runs/.</small></p></body></html>\n";
  return text;
}

}  // namespace remote_touch
