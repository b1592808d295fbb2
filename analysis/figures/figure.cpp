#include "analysis/figures/figure.h"

#include <limits>
#include <sstream>

namespace remote_touch {
namespace {

std::string text(double value) {
  std::ostringstream out;
  out.exceptions(std::ios::badbit);
  out.precision(6);
  out << value;
  return out.str();
}

std::string range(double low, double high) {
  return "from " + text(low) + " to " + text(high);
}

}  // namespace

const char* verdict_name(Verdict verdict) {
  constexpr const char* kNames[] = {"pass", "fail", "open", "differs", "not run"};
  return kNames[static_cast<int>(verdict)];
}

// Comparisons are written so that NaN fails.
Claim claim_between(const std::string& figure, const std::string& claim, const std::string& paper,
                    double measured, double low, double high, const std::string& unit) {
  const bool holds = measured >= low && measured <= high;
  return {figure, claim, paper, measured, range(low, high), unit, holds ? Verdict::pass : Verdict::fail};
}

Claim claim_at_most(const std::string& figure, const std::string& claim, const std::string& paper,
                    double measured, double limit, const std::string& unit) {
  const Verdict verdict = measured <= limit ? Verdict::pass : Verdict::fail;
  return {figure, claim, paper, measured, "at most " + text(limit), unit, verdict};
}

Claim claim_at_least(const std::string& figure, const std::string& claim, const std::string& paper,
                     double measured, double limit, const std::string& unit) {
  const Verdict verdict = measured >= limit ? Verdict::pass : Verdict::fail;
  return {figure, claim, paper, measured, "at least " + text(limit), unit, verdict};
}

Claim claim_differs(const std::string& figure, const std::string& claim, const std::string& paper,
                    double measured, double low, double high, const std::string& unit) {
  Claim made = claim_between(figure, claim, paper, measured, low, high, unit);
  made.criterion = "expected here: " + made.criterion;
  if (made.verdict == Verdict::pass) made.verdict = Verdict::differs;
  return made;
}

Claim set_up(Claim check) {
  check.set_up = true;
  return check;
}

Claim claim_not_run(const std::string& figure, const std::string& claim, const std::string& reason) {
  return {figure, claim, "-", std::numeric_limits<double>::quiet_NaN(), reason, "", Verdict::not_run};
}

}  // namespace remote_touch
