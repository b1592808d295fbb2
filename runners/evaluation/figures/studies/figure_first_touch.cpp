// The speed at which a surface may first touch the proxy: pop-through without noise, at three frame rates.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/theory/surface_contacts.h"
#include "analysis/trace/interval_estimates.h"
#include "runners/evaluation/figures/parts/pop_through_map.h"

namespace remote_touch {

namespace {

constexpr double kSpacing_m = 0.0015;  // spacing of the points, as in Table 4.2
constexpr int kHandPhases = 9;         // start times for each speed of a hand that moves

// Position of the proxy over the grid.
enum class Over { between_points, point };

FirstTouch touch_at(double frame_rate_hz, Over over) {
  return {kLift.r1_m, 2 * kContactRadius_m - kLift.r1_m,
          over == Over::point ? 0 : kSpacing_m / std::sqrt(2.0), frame_rate_hz};
}

// The fraction of start times at which the proxy was lost, for each speed of the surface.
struct Losses {
  std::string name, meaning;
  FirstTouch touch;
  std::vector<double> speed_m_per_s, lost;
  double phases = 0;  // start times for each speed

  double max_difference() const {
    std::vector<double> differences;
    for (std::size_t i = 0; i < lost.size(); ++i)
      differences.push_back(std::abs(lost[i] - lost_at_first_touch(touch, speed_m_per_s[i])));
    return max_of(differences);
  }
  // The largest fraction lost at the speeds up to a limit, and the smallest above it; NaN if there are none.
  double max_lost_up_to(double limit_m_per_s) const {
    return max_where(
        lost.size(), [&](std::size_t i) { return speed_m_per_s[i] <= limit_m_per_s; },
        [&](std::size_t i) { return lost[i]; });
  }
  double min_lost_above(double limit_m_per_s) const {
    return min_where(
        lost.size(), [&](std::size_t i) { return speed_m_per_s[i] > limit_m_per_s; },
        [&](std::size_t i) { return lost[i]; });
  }
  // Returns the number of speeds at which the formula lies between 0 and 1.
  int undecided_speeds() const {
    return static_cast<int>(std::count_if(speed_m_per_s.begin(), speed_m_per_s.end(), [&](double speed) {
      const double fraction = lost_at_first_touch(touch, speed);
      return fraction > 0 && fraction < 1;
    }));
  }
};

Losses measured(FigureContext& context, Losses losses, const std::vector<std::string>& overrides) {
  const SweepResult result = context.sweep(Sweep::load("first-touch", overrides));
  losses.speed_m_per_s = axis_values(result, 0);
  const std::vector<double>& popped = result.measure("popped_through");
  const std::size_t phases = result.axes[1].length();
  for (std::size_t speed = 0; speed < losses.speed_m_per_s.size(); ++speed) {
    double lost = 0;
    for (std::size_t phase = 0; phase < phases; ++phase)
      lost += popped[result.run(result.cell_at({speed, phase}), 0)];
    losses.lost.push_back(lost / static_cast<double>(phases));
  }
  losses.phases = static_cast<double>(phases);
  return losses;
}

// The stored sweep is at 30 frames per second. At another rate the speeds are scaled so that the surface
// moves the same distances from frame to frame, and the start times are again uniform over one interval
// between frames.
Losses at_rest(FigureContext& context, double frame_rate_hz) {
  const SweepResult stored = Sweep::load("first-touch").plan();
  const double factor = frame_rate_hz / kLift.frame_rate_hz;
  std::vector<double> speeds = axis_values(stored, 0);
  for (double& speed : speeds) speed *= factor;
  const double last_s = axis_values(stored, 1).back() / factor;
  const std::string rate = std::to_string(std::lround(frame_rate_hz));
  return measured(context,
                  {rate + "_hz", rate + " Hz", touch_at(frame_rate_hz, Over::between_points), {}, {}},
                  {"scenario.frame_rate_hz=" + rate, "axes.0.values=" + nlohmann::json(speeds).dump(),
                   "axes.1.to=" + nlohmann::json(last_s).dump()});
}

Losses over_a_point(FigureContext& context) {
  return measured(context, {"over_point", "over a point", touch_at(kLift.frame_rate_hz, Over::point), {}, {}},
                  {"scenario.phase_x=0.5", "scenario.phase_z=0.5"});
}

// The hand presses onto the surface while it rises, 5 to 9 cm below the position where the hand waited.
Losses by_hand(FigureContext& context) {
  const double last_s = (kHandPhases - 1.0) / kHandPhases / kLift.frame_rate_hz;
  return measured(
      context,
      {"by_hand", "a hand presses onto it", touch_at(kLift.frame_rate_hz, Over::between_points), {}, {}},
      {"scenario.start_depth_m=0.1", "trajectory.press_at_s=0.15",
       "axes.1.count=" + std::to_string(kHandPhases), "axes.1.to=" + nlohmann::json(last_s).dump()});
}

// Returns a table with one row for each speed of each element of the list.
Table loss_table(const std::string& name, const std::string& title, const std::vector<Losses>& list) {
  TableRows rows;
  for (const Losses& l : list)
    for (std::size_t i = 0; i < l.lost.size(); ++i)
      rows.push_back({l.touch.frame_rate_hz, l.touch.nearest_beside_m, l.speed_m_per_s[i], l.lost[i],
                      lost_at_first_touch(l.touch, l.speed_m_per_s[i])});
  return table_of(
      name, title,
      {{"frame_rate", "Hz", "f_c"},
       {"nearest_beside", "m", "from the proxy's centre to the nearest points, along the surface"},
       {"speed", "m/s", "speed of the surface"},
       {"lost", "1", "fraction of start times at which the proxy was lost"},
       {"at_rest", "1", "fraction that the formula gives for a proxy at rest"}},
      rows);
}

Table formula_table(const Losses& losses) {
  TableRows rows;
  const double first = max_first_touch_velocity(losses.touch);
  for (int percent = 80; percent <= 220; ++percent) {
    const double speed_m_per_s = 0.01 * percent * first;
    rows.push_back({speed_m_per_s, lost_at_first_touch(losses.touch, speed_m_per_s)});
  }
  return table_of("formula_" + losses.name, "the formula, " + losses.meaning,
                  {{"speed", "m/s", "speed of the surface"},
                   {"lost", "1", "fraction of start times at which the proxy is lost"}},
                  rows);
}

// The lost start times form one interval (surface_contacts.h). The number of evenly spaced start times in
// an interval differs from the formula by less than one.
void add_formula_claim(Figure& figure, const Losses& losses, const std::string& where) {
  Claims(figure, where)
      .at_most(
          ": a proxy at rest is lost at as many start times as the formula says: largest difference of "
          "the fractions",
          losses.max_difference(), 1 / losses.phases, "fraction");
}

void add_rate_claims(Figure& figure, const Losses& losses) {
  const std::string where = losses.meaning + ": ";
  const Claims claims(figure, where), checks(figure, where, &Claim::set_up);
  add_formula_claim(figure, losses, losses.meaning);
  claims.at_most("no proxy is lost up to the speed (r_1^2 - s^2 / 2)^(1/2) f_c: largest fraction lost",
                 losses.max_lost_up_to(max_first_touch_velocity(losses.touch)), 0, "fraction",
                 "r_1 f_c (4.14)");
  checks.at_least("the start time decides at many speeds whether a proxy is lost: number of these speeds",
                  losses.undecided_speeds(), 8, "speeds");
}

void add_hand_claims(Figure& figure, const Losses& losses) {
  const double limit = max_touched_velocity(losses.touch);
  const Claims claims(figure, "a hand presses onto the moving surface, 30 Hz: ");
  claims.at_most("no proxy is lost up to the speed (r_c^2 - s^2 / 2)^(1/2) f_c: largest fraction lost",
                 losses.max_lost_up_to(limit), 0, "fraction");
  claims.at_least("every proxy is lost above the speed (r_c^2 - s^2 / 2)^(1/2) f_c: smallest fraction lost",
                  losses.min_lost_above(limit), 1, "fraction");
}

Panel panel(const std::string& title, const std::vector<Losses>& list, const std::string& table) {
  Panel made{title, "speed of the surface (m/s)", "fraction lost"};
  for (const Losses& losses : list)
    made.curves.push_back(
        {"formula_" + losses.name, "speed", "lost", CurveStyle::line, "derived, " + losses.meaning});
  made.curves.push_back({table, "speed", "lost", CurveStyle::dots, "measured, proxy at rest"});
  return made;
}

}  // namespace

Figure figure_first_touch(FigureContext& context) {
  Figure figure{
      "first-touch", "Pop-through at the first touch",
      "A surface without noise moves evenly towards a proxy at rest. When it first touches the proxy, "
      "the velocity estimate is 0. Drawn is the fraction of 63 start times, uniform over one interval "
      "between two frames, at which the surface passes the proxy (dots), and the derived fraction "
      "(lines). Lower panel: a proxy straight over a point, and a hand that presses onto the moving "
      "surface, so that it touches it between two frames. Simulated."};
  std::vector<Losses> rates;
  for (const double rate_hz : {15.0, 30.0, 60.0}) rates.push_back(at_rest(context, rate_hz));
  for (const Losses& losses : rates) add_rate_claims(figure, losses);
  const std::vector<Losses> points = {over_a_point(context)}, hands = {by_hand(context)};
  add_formula_claim(figure, points[0], "over a point, 30 Hz");
  add_hand_claims(figure, hands[0]);

  for (const Losses& losses : rates) figure.tables.push_back(formula_table(losses));
  figure.tables.push_back(formula_table(points[0]));
  figure.tables.push_back(loss_table("rates", "proxy at rest in the middle of four points", rates));
  figure.tables.push_back(loss_table("over_point", "proxy at rest over a point", points));
  figure.tables.push_back(loss_table("by_hand", "a hand presses onto the moving surface", hands));
  Panel lower = panel("Proxy at rest over a point, and a hand that presses, 30 Hz", points, "over_point");
  lower.curves.push_back({"by_hand", "speed", "lost", CurveStyle::dots, "measured, " + hands[0].meaning});
  figure.panels = {panel("Proxy at rest in the middle of four points", rates, "rates"), lower};
  return figure;
}

}  // namespace remote_touch
