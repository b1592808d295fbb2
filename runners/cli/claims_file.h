// claims.json: what the figures of a folder claim, and whether it holds.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/figures/figure.h"

namespace remote_touch {

class ClaimsFile {
 public:
  // Keeps what an earlier call left in the folder until the figure is made again. order: the figures' names.
  ClaimsFile(std::filesystem::path file, std::vector<std::string> order);
  ~ClaimsFile();
  ClaimsFile(const ClaimsFile&) = delete;
  ClaimsFile& operator=(const ClaimsFile&) = delete;

  // Writes the file: an interruption keeps what is done.
  void replace(const std::string& figure, std::span<const Claim> claims);

 private:
  std::filesystem::path file_;
  std::vector<std::string> order_;
  std::unique_ptr<std::vector<nlohmann::ordered_json>> claims_;  // in that order; the last: of other figures
};

}  // namespace remote_touch
