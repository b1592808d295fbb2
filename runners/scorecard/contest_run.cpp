#include "runners/scorecard/contest_run.h"

#include "core/parameters/input_error.h"
#include "runners/provenance/input_hashes.h"
#include "runners/provenance/provenance.h"
#include "runners/sweep/sweep_session.h"

namespace remote_touch {

namespace {

// What makes the file again, in any folder.
std::string command_of(const Contest& contest, const ContestScene& scene, const Contender& contender) {
  return "remote-touch scorecard " + contender.name + " --scene " + scene.name + " --seeds " +
         std::to_string(contest.replicates);
}

}  // namespace

std::vector<ContestSweep> sweeps_of(const Contest& contest, const ContestScene& scene) {
  std::vector<ContestSweep> sweeps;
  for (const Contender& contender : contest.contenders) {
    Sweep sweep = scene.sweep(contender, contest.replicates);
    const std::string name = scene.name + "." + contender.name;
    TextAttributes attributes =
        provenance(sweep.to_json(), command_of(contest, scene, contender), "", input_hashes(sweep.inputs()));
    sweeps.push_back(
        {name, std::move(sweep), std::move(attributes), contest.folder / "runs" / (name + ".h5")});
  }
  return sweeps;
}

void require_same_contest(const std::vector<ContestSweep>& sweeps) {
  for (const ContestSweep& one : sweeps) plan_in_file(one.sweep, {}, one.attributes, one.file);
}

void do_sweeps(const std::vector<ContestSweep>& sweeps, const Kernels& kernels, const std::atomic<bool>* stop,
               const ContestProgress& progress) {
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    progress(i, sweeps.size(), 0);
    SweepSession session(sweeps[i].sweep, {}, sweeps[i].attributes, sweeps[i].file);
    session.run(kernels, stop, [&](std::size_t done, std::size_t total, std::size_t) {
      progress(i, sweeps.size(), static_cast<double>(done) / static_cast<double>(total));
    });
  }
}

}  // namespace remote_touch
