// claims.json: the claims of a folder's figures, with their verdicts.
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
  // Keeps the claims of an earlier call in the folder until their figure is made again. order: names of the
  // figures, in the order of the file.
  ClaimsFile(std::filesystem::path file, std::vector<std::string> order);
  ~ClaimsFile();
  ClaimsFile(const ClaimsFile&) = delete;
  ClaimsFile& operator=(const ClaimsFile&) = delete;

  // Replaces a figure's claims and writes the file, so that an interruption keeps what is done.
  void replace(const std::string& figure, std::span<const Claim> claims);

 private:
  std::filesystem::path file_;
  std::vector<std::string> order_;
  std::unique_ptr<std::vector<nlohmann::ordered_json>> claims_;  // a list for each name; last: other figures
};

}  // namespace remote_touch
