// claims.json: what the figures of a folder claim, and whether it holds.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/figures/figure.h"

namespace remote_touch {

class ClaimsFile {
 public:
  // Keeps what an earlier call left in the folder until the figure is made again. order: the figures' names.
  ClaimsFile(std::filesystem::path file, std::vector<std::string> order);

  // Writes the file: an interruption keeps what is done.
  void replace(const std::string& figure, std::span<const Claim> claims);

 private:
  std::filesystem::path file_;
  std::vector<std::string> order_;
  std::vector<nlohmann::ordered_json> claims_;  // of the figures in that order, and behind them of others
};

}  // namespace remote_touch
