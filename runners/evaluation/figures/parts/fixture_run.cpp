#include "runners/evaluation/figures/parts/fixture_run.h"

#include <utility>

#include "analysis/trace/measures.h"
#include "core/kernels/isa.h"
#include "runners/evaluation/figures/parts/figure_form.h"

namespace remote_touch {

namespace {

// Returns the radius at each frame's time of capture, one value for each tick, as the rules compute it.
std::vector<double> radii(const Experiment& experiment, const Trace& trace, const Scenario& scenario) {
  const FixtureAssignment fixtures = experiment.build_fixtures();
  std::vector<double> radius_m;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (i > 0 && !trace.frame_update(i)) {
      radius_m.push_back(radius_m.back());
      continue;
    }
    PointCloud point;
    point.append(Vec3::Zero());
    fixtures.assign(point, scenario.captured_s(trace.frame_index[i]));
    radius_m.push_back(point.fixture_radius_m.front());
  }
  return radius_m;
}

}  // namespace

std::vector<FixtureRun> run_fixtures(FigureContext& context, const std::vector<Experiment>& experiments) {
  std::vector<Trace> traces = context.run(experiments);
  std::vector<FixtureRun> runs;
  for (std::size_t r = 0; r < experiments.size(); ++r) {
    auto scenario = experiments[r].build_scenario(kernels_for(Isa::x86_64));
    std::vector<double> radius_m = radii(experiments[r], traces[r], *scenario);
    runs.push_back({std::move(traces[r]), std::move(scenario), std::move(radius_m)});
  }
  return runs;
}

void add_side_claim(Figure& figure, const std::string& where, const Trace& trace) {
  Claims(figure, where)
      .at_most("the proxy is never on the wrong side of the surface: fraction of ticks in which it is",
               wrong_side_fraction(trace), 0, "fraction", "none");
}

void add_sound_claims(Figure& figure, const std::string& where, const Trace& trace) {
  const Claims claims(figure, where);
  claims.at_most("all numbers are finite: fraction of ticks with one that is not", non_finite_fraction(trace),
                 0, "fraction", "none");
  claims.at_most("the HIP is never held back without force: fraction of ticks in which it is",
                 no_force_fraction(trace, kContactRadius_m), 0, "fraction", "none");
}

}  // namespace remote_touch
