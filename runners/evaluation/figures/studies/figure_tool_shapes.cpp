// Edges, corners, balls and walls that pass through a plate that is pressed onto them. The distance by which
// one frame may move them is derived (tools/shape_jumps.h) and measured. Simulated; not in the dissertation.
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "analysis/trace/interval_estimates.h"
#include "core/points/vector.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/carried_limits.h"

namespace remote_touch {

namespace {

constexpr double kFirstSpeed_m_per_s = 0.03, kWallTilt_deg = 80;  // values of the sweeps
const std::vector<double> kThickness_m = {0.005, 0.01, 0.02};

// Conversion of a sweep's strengths, and of jumps, to the drawn quantity.
struct Scale {
  std::string units, y_label;
  double offset = 0, factor = 1, per_jump = kJumpFrames_hz;
};
const Scale kSpeed{"m/s", "speed (m/s)", kFirstSpeed_m_per_s, 1 / kJumpFrames_hz, kJumpFrames_hz};

Scale sideways() {  // a wall approaches along its normal by less than it moves
  return {"m/s", "speed (m/s)", 0, 1, kJumpFrames_hz / sin_cos(kWallTilt_deg * kRadiansPerDegree).first};
}

struct Family {
  std::string table, title;
  Column setting;  // axis of the sweep; its values begin at the setting `first`
  std::string x_label;
  std::size_t first = 0;
  Scale scale = kSpeed;
  std::function<Jump(Carrier, double setting)> jump;
  std::optional<std::pair<double, double>> y_range = {};
  DerivedLimit bound_m = {};  // bound_m of `jump`, if it can be had faster
};

// Counts runs in bins of strength / bound, and the runs that are certainly below or certainly above the
// bound.
class Pool {
 public:
  static constexpr int kBins = 15;
  void add(Carrier rule, double strength, const Jump& jump, double per_jump, const EventCounts& lost) {
    OfRule& of = rules_[static_cast<std::size_t>(rule)];
    const int bin = static_cast<int>(strength / (jump.bound_m * per_jump) / kWidth);
    if (bin < kBins) of.bins[bin].add(lost);
    if (strength < jump.least_m * per_jump) of.below.add(lost);
    if (strength > jump.most_m * per_jump) of.above.add(lost);
  }
  const EventCounts& below(Carrier rule) const { return rules_[static_cast<std::size_t>(rule)].below; }
  const EventCounts& above(Carrier rule) const { return rules_[static_cast<std::size_t>(rule)].above; }
  Table table() const {
    Table table{"pooled", "All without noise"};
    std::vector<double> ratio;
    for (int bin = 0; bin < kBins; ++bin) ratio.push_back((bin + 0.5) * kWidth);
    table.add("ratio", "1", "speed divided by the derived bound, middle of a bin", ratio);
    for (const CarrierName& carrier : kCarriers) {
      TableRows rows;
      for (const EventCounts& bin : rules_[static_cast<std::size_t>(carrier.rule)].bins) {
        const Estimate carried = estimated_fraction(EventCounts{bin.without, bin.events, bin.unknown});
        rows.push_back({carried.value, carried.low, carried.high, static_cast<double>(bin.runs())});
      }
      const std::string column = carrier.column;
      add_rows(table,
               {{column + "_carried", "1", "fraction of runs that are carried"},
                {column + "_low", "1", "lower end of its 95 % interval"},
                {column + "_high", "1", "upper end of its 95 % interval"},
                {column + "_runs", "1", "number of runs"}},
               rows);
    }
    return table;
  }

 private:
  static constexpr double kWidth = 0.1;
  struct OfRule {
    EventCounts bins[kBins], below, above;
  };
  OfRule rules_[std::size(kCarriers)];
};

Table family_table(const Family& family, const CarrySweep& sweep, Pool* pool) {
  Table table{family.table, family.title, {family.setting}};
  const auto& settings = std::get<std::vector<double>>(family.setting.values);
  const Scale& scale = family.scale;
  const auto scaled = [&](double strength) { return scale.offset + scale.factor * strength; };
  for (const CarrierName& carrier : kCarriers) {
    TableRows rows;
    for (std::size_t i = 0; i < settings.size(); ++i) {
      const CarrySweep::Limit limit = sweep.limit(family.first + i, carrier.rule);
      const Jump jump = family.jump(carrier.rule, settings[i]);
      rows.push_back({scaled(limit.carried), scaled(limit.lost), scaled(limit.all_lost),
                      scale.per_jump * jump.least_m, scale.per_jump * jump.bound_m,
                      scale.per_jump * jump.most_m});
      for (std::size_t k = 0; pool && k < sweep.strengths().size(); ++k)
        pool->add(carrier.rule, scaled(sweep.strengths()[k]), jump, scale.per_jump,
                  sweep.lost(family.first + i, k, carrier.rule));
    }
    const std::string column = carrier.column, &units = scale.units;
    add_rows(table,
             {{column + "_carried", units, "all runs are carried up to this"},
              {column + "_first_lost", units, "the next value: a run is lost"},
              {column + "_all_lost", units, "from here on all runs are lost"},
              {column + "_bound_low", units, "derived limit, at least"},
              {column + "_bound", units, "derived limit"},
              {column + "_bound_high", units, "derived limit, at most"}},
             rows);
  }
  return table;
}

Column thickness() {
  return {"thickness", "m", "thickness of the plate", kThickness_m, 1, {}};
}
Column angle(const std::string& name, const std::string& meaning, std::vector<double> deg) {
  return {name, "deg", meaning, std::move(deg), 1, {}};
}

struct FamilySweep {
  const char* sweep;
  std::vector<Family> families;
  bool in_pool = true;
};

std::vector<FamilySweep> shape_sweeps() {
  const std::string h = "thickness h (m)";
  const std::vector<double> slopes = {15, 30, 45, 55};
  return {{"tool-shape-thickness",
           {{"edge_thickness", "Edge, by thickness", thickness(), h, 0, kSpeed,
             [](Carrier rule, double m) { return on_edge(rule, m, kSlope_deg); }},
            {"corner_thickness", "Corner, by thickness", thickness(), h, 3, kSpeed,
             [](Carrier rule, double m) { return on_corner(rule, m, kSlope_deg); }},
            {"ball_thickness", "Ball, by thickness", thickness(), h, 6, kSpeed,
             [](Carrier rule, double m) { return on_ball(rule, m, kRadius_m); }}}},
          {"tool-walls",
           {{"wall_thickness", "Wall, by thickness", thickness(), h, 0, sideways(),
             [](Carrier rule, double m) { return on_plane(rule, m); }}}},
          {"tool-shape-slopes",
           {{"edge_slope", "Edge, by slope", angle("slope", "slope of the flanks", slopes), "slope (deg)", 0,
             kSpeed, [](Carrier rule, double deg) { return on_edge(rule, kPlate_m, deg); }},
            {"corner_slope", "Corner, by slope", angle("slope", "slope of the faces", slopes), "slope (deg)",
             4, kSpeed, [](Carrier rule, double deg) { return on_corner(rule, kPlate_m, deg); }}}},
          {"tool-shape-radii",
           {{"ball_radius",
             "Ball, by radius",
             {"radius", "m", "radius of the ball", std::vector<double>{0.01, 0.02, 0.03, 0.05, 0.1}, 1, {}},
             "radius (m)",
             0,
             kSpeed,
             [](Carrier rule, double m) { return on_ball(rule, kPlate_m, m); }}}},
          {"tool-wall-sides",
           {{"wall_side",
             "Wall, narrow side",
             thickness(),
             h,
             0,
             sideways(),
             [](Carrier rule, double) { return on_plane(rule, 2 * kHalfPlate_m); },
             {{1.0, 1.4}}}}}};
}

std::vector<FamilySweep> turn_sweeps() {
  const std::vector<double> turns = {10, 20, 30}, tilts = {0, 10, 20};
  return {
      {"tool-shape-turns",
       {{"plane_turn", "Plane that turns", angle("turn", "in the frame", turns), "turn in the frame (deg)", 0,
         kSpeed, [](Carrier rule, double deg) { return on_edge(rule, kPlate_m, 0, deg); }},
        {"edge_turn", "Edge that turns", angle("turn", "in the frame", turns), "turn in the frame (deg)", 3,
         kSpeed, [](Carrier rule, double deg) { return on_edge(rule, kPlate_m, kSlope_deg, deg); }}}},
      {"tool-shape-tilts",
       {{"edge_tilt", "Tilted edge", angle("tilt", "tilt of the edge", tilts), "tilt (deg)", 0, kSpeed,
         [](Carrier rule, double deg) {
           Jump jump = on_edge(rule, kPlate_m, kSlope_deg, deg);
           jump.most_m = std::numeric_limits<double>::infinity();  // the plate slides to its gentler side
           return jump;
         }}},
       false}};
}

FamilySweep noise_sweep() {
  const struct {
    const char *table, *title;
    Shape::Kind kind;
  } shapes[] = {{"plane_noise", "Noisy plane", Shape::Kind::flat},
                {"edge_noise", "Noisy edge", Shape::Kind::ridge},
                {"corner_noise", "Noisy corner", Shape::Kind::corner},
                {"ball_noise", "Noisy ball", Shape::Kind::sphere}};
  const std::vector<double> noise = {0.001, 0.002, 0.004};
  FamilySweep sweep{"tool-shape-noise", {}, false};
  for (const auto& shape : shapes) {
    Family family;
    family.table = shape.table, family.title = shape.title, family.x_label = "noise (m)";
    family.setting = {"noise", "m", "standard deviation of the noise on x, y and z", noise, 1, {}};
    family.first = sweep.families.size() * noise.size();
    family.jump = [kind = shape.kind](Carrier rule, double sigma_m) { return on_noise(rule, kind, sigma_m); };
    family.bound_m = [kind = shape.kind](Carrier rule, double sigma_m) {
      return noise_bound_m(rule, kind, sigma_m);
    };
    sweep.families.push_back(family);
  }
  return sweep;
}

// --- claims ---

// Claims that the limit is between the derived ones in every setting of several tables. The measured value is
// the number of settings in which it is not.
void claim_bounded(const Claims& claims, const std::vector<Table>& tables, Carrier rule,
                   const std::string& claim, const std::string& paper = "-") {
  const std::string column = column_of(rule);
  double apart = 0;
  for (const Table& table : tables)
    apart += count_rows_apart(table, column + "_carried", column + "_first_lost", column + "_bound_low",
                              column + "_bound_high");
  claims.at_most(claim + ": number of settings in which this is false", apart, 0, "1", paper);
}

// A row counts if all four runs are carried above the derived speed, or if all four are lost below it. By
// chance that happens in at most 1 of 8 rows, so 3 or more of 12 rows count at most once in five figures.
void claim_bounded_noise(const Claims& claims, const std::vector<Table>& tables, Carrier rule,
                         const std::string& label) {
  const std::string column = column_of(rule);
  double apart = 0;
  for (const Table& table : tables)
    apart += count_rows_apart(table, column + "_carried", column + "_all_lost", column + "_bound_low",
                              column + "_bound_high");
  claims.at_most(
      label +
          ": with noise, half of the plates are lost at the derived speed: number of 12 settings in "
          "which this is false",
      apart, 2, "1");
}

void add_claims(Figure& figure, const std::vector<Table>& still, const std::vector<Table>& turning,
                const std::vector<Table>& tilted, const std::vector<Table>& noisy, const Pool& pool) {
  for (const CarrierName& carrier : kCarriers) {
    const Claims claims(figure, std::string(carrier.label) + ": ");
    const bool printed = carrier.rule == Carrier::voxels;
    const std::string bound = printed                               ? "f_c (h - 2w + drop)"
                              : carrier.rule == Carrier::look_ahead ? "f_c (h + drop)"
                                                                    : "f_c max(h + drop, frame_reach_m)";
    claim_bounded(claims, still, carrier.rule,
                  "edge, corner, ball and wall carry a plate up to the speed " + bound,
                  printed ? "v < f_c (h - 2w), 6.2.4" : "-");
    claim_bounded(claims, turning, carrier.rule,
                  "a plane and an edge that turn carry a plate up to the bound with the drop after the turn");
    claim_bounded(claims, tilted, carrier.rule,
                  "a tilted edge carries a plate at least up to the bound of its steeper flank");
    claim_bounded_noise(Claims(figure), noisy, carrier.rule, carrier.label);
    const EventCounts &below = pool.below(carrier.rule), &above = pool.above(carrier.rule);
    claims.at_least(
        "nearly all plates are carried below the derived bound: lower end of the 95 % interval of the "
        "fraction",
        estimated_fraction(EventCounts{below.without, below.events, below.unknown}).low, 0.97, "fraction");
    claims.at_least(
        "nearly all plates are lost above the derived bound: lower end of the 95 % interval of the "
        "fraction",
        estimated_fraction(above).low, 0.97, "fraction");
  }
}

// Shows the bins about the bound. Farther away all plates are carried, or all are lost.
Panel pool_panel(const Table& pooled, std::pair<double, double> at) {
  std::vector<Curve> curves;
  for (const CarrierName& carrier : kCarriers) {
    const std::string column = carrier.column;
    curves.push_back({pooled.name, "ratio", column + "_low", CurveStyle::intervals, "", 0, column + "_high"});
    curves.push_back({pooled.name, "ratio", column + "_carried", CurveStyle::dots, carrier.label});
  }
  return plot(pooled.title, "speed / derived bound", "fraction carried", std::move(curves),
              {.at = at, .x_range = {{0.6, 1.4}}});
}

// The derived bounds with noise take long to compute, and are nearly straight: 25 samples are enough.
void add_family_panel(Figure& figure, const Family& family, const Table& limits,
                      std::pair<double, double> at) {
  const DerivedLimit bound = [&family](Carrier rule, double setting) {
    return family.scale.per_jump *
           (family.bound_m ? family.bound_m(rule, setting) : family.jump(rule, setting).bound_m);
  };
  add_limit_panel(figure, limits, bound, {family.x_label, family.scale.y_label},
                  {.at = at, .y_range = family.y_range}, family.bound_m ? 25 : 61);
}

}  // namespace

Figure figure_tool_shapes(FigureContext& context) {
  Figure figure{
      "tool-shapes", "Where edges, corners, balls and walls pass through a plate",
      "A surface jumps in one frame against a plate of 40 x 40 mm that a hand presses onto it, by the three "
      "contact rules; frames at 30 Hz; simulated. Where it is not the axis, the plate is 10 mm thick, edges "
      "and corners slope by 30 deg, and the ball has a radius of 40 mm. Dots: up to here every run is "
      "carried. Bars: up to the next value that was tried, at which a run is lost. The three rules are "
      "drawn side by side for each setting. Dashed: derived, no point is left in the plate (printed rule: "
      "in what is not shell; continuous rule: and it moves by more than frame_reach_m, 20 mm); with noise: "
      "half are lost. Fraction carried: of all runs without noise, with 95 % intervals; below 0.6 of "
      "the bound all are carried, above 1.4 none."};
  Pool pool;
  constexpr std::size_t kColumns = 4;
  const auto place = [&] {
    const std::size_t row = figure.panels.size() / kColumns, column = figure.panels.size() % kColumns;
    return std::pair<double, double>(row, column);
  };
  const auto made = [&](const std::vector<FamilySweep>& sweeps) {
    std::vector<Table> tables;
    for (const FamilySweep& of : sweeps) {
      const CarrySweep sweep(context.sweep(Sweep::load(of.sweep)));
      for (const Family& family : of.families) {
        tables.push_back(family_table(family, sweep, of.in_pool ? &pool : nullptr));
        add_family_panel(figure, family, tables.back(), place());
      }
    }
    figure.tables.insert(figure.tables.end(), tables.begin(), tables.end());
    return tables;
  };
  const std::vector<Table> still = made(shape_sweeps()), moved = made(turn_sweeps());
  const std::vector<Table> turning(moved.begin(), moved.end() - 1), tilted{moved.back()};
  const Table pooled = pool.table();
  figure.panels.push_back(pool_panel(pooled, place()));
  const std::vector<Table> noisy = made({noise_sweep()});
  figure.tables.push_back(pooled);
  add_claims(figure, still, turning, tilted, noisy, pool);
  return figure;
}

}  // namespace remote_touch
