#include "tests/benchmarks/program_benchmark.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/dissertation/tool_motion/motion_program.h"
#include "tests/benchmarks/checked_benchmark.h"
#include "tests/core/dissertation/tool_motion/program_peers.h"
#ifdef REMOTE_TOUCH_NLOPT
#include "tests/core/dissertation/tool_motion/nlopt_program.h"
#endif

namespace remote_touch::benchmarks {
namespace {

using Problem = peers::Problem<6>;
using Vector = peers::Vector<6>;

// The programs are many, in turn, so that the processor cannot learn their branches.
constexpr int kProblems = 64;

// Random rows around a point near the origin that fulfils them, and a random target.
struct Problems {
  std::vector<Problem> all;
  std::vector<QuadraticProgram<6>> programs;
  std::vector<Vector> answers;

  explicit Problems(int rows) {
    std::mt19937_64 random(static_cast<unsigned>(rows));
    std::normal_distribution<double> normal;
    const auto vector = [&] { return Vector(Vector::NullaryExpr([&] { return normal(random); })); };
    for (int i = 0; i < kProblems; ++i) {
      Problem problem;
      problem.target = vector();
      for (int j = 0; j < rows; ++j) {
        const Vector row = vector();
        problem.add(row, -0.5 * std::abs(normal(random)));
      }
      programs.push_back(problem.program());
      answers.push_back(peers::min_distance(problem).y);
      all.push_back(problem);
    }
  }

  template <class Solve>
  bool agree(const Solve& solve, double tolerance) const {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!((solve(i) - answers[i]).norm() < tolerance)) return false;
    return true;
  }
};

template <class Solve>
void add_solver(const std::string& name, const std::shared_ptr<const Problems>& problems, double tolerance,
                const Solve& solve) {
  add(
      name, [=] { return problems->agree([&](std::size_t i) { return solve(*problems, i); }, tolerance); },
      [=](benchmark::State& state) {
        std::size_t i = 0;
        for (auto _ : state) {
          benchmark::DoNotOptimize(solve(*problems, i));
          i = (i + 1) % kProblems;
        }
      });
}

}  // namespace

void add_programs() {
  for (const int rows : {6, 50}) {
    const auto problems = std::make_shared<const Problems>(rows);
    const std::string count = std::to_string(rows);
    add_solver("program_ours/" + count, problems, 1e-10,
               [](const Problems& p, std::size_t i) { return p.programs[i].nearest(p.all[i].target).y; });
#ifdef REMOTE_TOUCH_NLOPT
    add_solver("program_nlopt/" + count, problems, 1e-6,
               [](const Problems& p, std::size_t i) { return peers::nlopt_nearest(p.all[i]); });
#endif
  }
}

}  // namespace remote_touch::benchmarks
