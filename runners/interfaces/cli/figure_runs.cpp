#include "runners/interfaces/cli/figure_runs.h"

#include <omp.h>

#include <cmath>
#include <exception>
#include <mutex>

#include "runners/experiment/simulation/simulation.h"

namespace remote_touch {

namespace {

constexpr double kReportEvery_s = 0.5;

std::vector<double> expected_s(const std::vector<FigureRun>& runs) {
  std::vector<double> list;
  for (const FigureRun& run : runs) list.push_back(run.expected_s());
  return list;
}

}  // namespace

std::vector<FigureRun> quickest_first(const std::vector<FigureRun>& runs) {
  std::vector<FigureRun> ordered;
  for (const std::size_t i : shortest_first(expected_s(runs))) ordered.push_back(runs[i]);
  return ordered;
}

void make_figures(const CommandLine& line, const std::vector<FigureRun>& runs,
                  const std::function<Figure(const FigureEntry&, FigureContext&)>& make,
                  const std::function<void(std::size_t, const FigureContext&, Figure)>& finish,
                  const std::function<void(const FigureProgress&)>& report) {
  const int threads = omp_get_max_threads();
  WorkPool pool(threads);
  std::mutex one_at_a_time;
  std::vector<std::exception_ptr> failures(runs.size() + 1);
  const auto pieces = [&](std::size_t count, const auto& work) { pool.for_each(count, work); };
  std::vector<std::function<void()>> jobs;
  for (std::size_t i = 0; i < runs.size(); ++i)
    jobs.emplace_back([&, i] {
      try {
        if (line.stop && *line.stop) throw Interrupted{};
        FigureContext context(*line.kernels, line.stop, runs[i].coarse, pieces, runs[i].overrides);
        Figure figure = make(*runs[i].entry, context);
        const std::lock_guard lock(one_at_a_time);
        finish(i, context, std::move(figure));
      } catch (...) {
        failures[i] = std::current_exception();
      }
    });
  const std::vector<double> expected = expected_s(runs);
  pool.run(jobs, kReportEvery_s, [&] {
    if (failures.back()) return;
    try {
      const std::vector<JobProgress> progress = pool.progress();
      report({progress, time_left(expected, progress, threads)});
    } catch (...) {  // rethrown when the jobs have ended, because they use local objects
      failures.back() = std::current_exception();
    }
  });
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

std::string progress_text(const std::vector<FigureRun>& runs, const FigureProgress& progress) {
  std::size_t made = 0;
  std::string at_work;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    made += progress.runs[i].state == JobState::done ? 1 : 0;
    if (progress.runs[i].state == JobState::running)
      at_work += (at_work.empty() ? ", making " : ", ") + std::string(runs[i].entry->name);
  }
  return std::to_string(made) + " of " + std::to_string(runs.size()) + at_work + "; about " +
         std::to_string(std::lround(progress.left.all_s)) + " s left";
}

}  // namespace remote_touch
