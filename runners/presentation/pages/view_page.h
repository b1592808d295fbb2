// A page of the viewer below a size limit: one self-contained HTML file, which reads nothing else.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/presentation/pages/shown_run.h"

namespace remote_touch {

// The viewer's script and style, which the build made from runners/presentation/pages/page and embedded in
// the program. Both empty in a program that was built without Node.
std::string_view viewer_script();
std::string_view viewer_style();

// Returns an HTML page of the viewer: its script and style, what to show as JSON, and numbers, compressed.
// json: names the arrays in bytes as PackedArrays::add() does. Throws InputError without viewer_script().
std::string page_file(const std::string& title, const std::string& json, const std::string& bytes);

// Returns the bytes as a page stores them: gzip, then Base64.
std::string gzip_base64(const std::string& bytes);

struct ViewOptions {
  std::size_t max_bytes = 20'000'000;       // size of the page; points are left out until it fits
  std::filesystem::path claims = {};        // a claims.json, for shown_claims(); empty: none
  const Kernels* kernels = nullptr;         // pre: set
  const std::atomic<bool>* stop = nullptr;  // when set, ends with Interrupted
};

struct ViewPage {
  std::string html;
  std::string shown;  // number of shown points in words, a line for each run
};

// Shows the runs and the entries of `page`. numbers: arrays that `page` already names. Throws InputError,
// about the first run, if the page would be too large without any points, and in a program that was built
// without the viewer (see viewer_script()).
ViewPage view_page(const std::string& title, const std::vector<std::unique_ptr<ShownRun>>& runs,
                   const Json& page, const PackedArrays& numbers, const ViewOptions& options);

}  // namespace remote_touch
