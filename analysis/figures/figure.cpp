#include "analysis/figures/figure.h"

#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace remote_touch {

namespace {

std::string text(double value) {
  std::ostringstream out;
  out.exceptions(std::ios::badbit);
  out.precision(6);
  out << value;
  return out.str();
}

Claim claim_of(std::string figure, std::string claim, std::string paper, double measured,
               std::string criterion, std::string unit, bool holds) {
  return {std::move(figure),
          std::move(claim),
          std::move(paper),
          measured,
          std::move(criterion),
          std::move(unit),
          holds ? Verdict::pass : Verdict::fail};
}

}  // namespace

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::open:
      return "open";
    case Verdict::differs:
      return "differs";
    case Verdict::not_run:
      break;
  }
  return "not run";
}

// Comparisons are written so that NaN fails.
Claim claim_between(std::string figure, std::string claim, std::string paper, double measured, double low,
                    double high, std::string unit) {
  return claim_of(std::move(figure), std::move(claim), std::move(paper), measured,
                  "from " + text(low) + " to " + text(high), std::move(unit),
                  measured >= low && measured <= high);
}

Claim claim_at_most(std::string figure, std::string claim, std::string paper, double measured, double limit,
                    std::string unit) {
  return claim_of(std::move(figure), std::move(claim), std::move(paper), measured, "at most " + text(limit),
                  std::move(unit), measured <= limit);
}

Claim claim_at_least(std::string figure, std::string claim, std::string paper, double measured, double limit,
                     std::string unit) {
  return claim_of(std::move(figure), std::move(claim), std::move(paper), measured, "at least " + text(limit),
                  std::move(unit), measured >= limit);
}

Claim claim_differs(std::string figure, std::string claim, std::string paper, double measured, double low,
                    double high, std::string unit) {
  Claim made = claim_of(std::move(figure), std::move(claim), std::move(paper), measured,
                        "expected here: from " + text(low) + " to " + text(high), std::move(unit),
                        measured >= low && measured <= high);
  if (made.verdict == Verdict::pass) made.verdict = Verdict::differs;
  return made;
}

Claim set_up(Claim check) {
  check.set_up = true;
  return check;
}

Claim claim_not_run(std::string figure, std::string claim, std::string reason) {
  return {std::move(figure),
          std::move(claim),
          "-",
          std::numeric_limits<double>::quiet_NaN(),
          std::move(reason),
          "",
          Verdict::not_run};
}

}  // namespace remote_touch
