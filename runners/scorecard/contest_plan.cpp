#include "runners/scorecard/contest_plan.h"

#include <algorithm>

#include "runners/scorecard/passivity.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

std::vector<ContestSweep> ContestPlan::sweeps() const {
  std::vector<ContestSweep> list;
  for (const ScenePlan& one : scenes) list.insert(list.end(), one.sweeps.begin(), one.sweeps.end());
  // A contender's own force law is in the audit too, and is the same file.
  for (const ContestSweep& one : audit)
    if (std::none_of(list.begin(), list.end(),
                     [&](const ContestSweep& other) { return other.name == one.name; }))
      list.push_back(one);
  return list;
}

ContestPlan plan_of(const Contest& contest) {
  ContestPlan plan;
  plan.contest = contest;
  for (const ContestScene& scene : plan.contest.scenes) {
    try {
      plan.scenes.push_back({scene, sweeps_of(plan.contest, scene)});
    } catch (const MissingRecording& missing) {
      plan.skipped.emplace_back(scene.name, missing.what());
      continue;
    }
    if (scene.name != kPassivityScene) continue;
    for (const Contender& contender : plan.contest.contenders)
      for (Contender& law : force_laws_of(contender)) plan.laws.push_back(std::move(law));
    Contest audit = plan.contest;
    audit.contenders = plan.laws;
    plan.audit = sweeps_of(audit, scene);
  }
  return plan;
}

}  // namespace remote_touch
