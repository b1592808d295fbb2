// A run of chapter 5's protocol: its trace, the current fixture radius, and the claims that hold for any such
// run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runners/evaluation/figures/parts/figure_context.h"

namespace remote_touch {

struct FixtureRun {
  Trace trace;
  std::unique_ptr<Scenario> scenario;  // scenario of the run, for its ground truth
  std::vector<double> radius_m;        // r_f of the frame in use in each tick

  // Capture time of the frame that the renderer has in tick i.
  double frame_captured_s(std::size_t i) const { return scenario->captured_s(trace.frame_index[i]); }
  // Correct distance of the proxy's centre from the surface, r_f + r_c.
  double boundary_m(std::size_t i) const { return radius_m[i] + kContactRadius_m; }
};

// Runs the experiments in parallel. pre: every point has the same r_f, and no scene ends before its run.
std::vector<FixtureRun> run_fixtures(FigureContext& context, const std::vector<Experiment>& experiments);

// Adds the claim that the proxy is never behind the surface. where: what the text begins with.
void add_side_claim(Figure& figure, const std::string& where, const Trace& trace);
// Adds the claims that all numbers are finite and that there is no force dropout.
void add_sound_claims(Figure& figure, const std::string& where, const Trace& trace);

}  // namespace remote_touch
