#include "runners/live/view/redirect_page.h"

#include <unistd.h>

#include <cstdlib>

namespace remote_touch {

namespace {

// Returns the name of the file, or an empty name if it cannot be written.
std::string write_redirect(const std::filesystem::path& folder, const std::string& text) {
  std::string file = (folder / "remote-touch-live-XXXXXX.html").string();
  const int descriptor = mkstemps(file.data(), 5);
  if (descriptor < 0) return {};
  const bool is_written = write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(descriptor);
  if (is_written) return file;
  unlink(file.c_str());
  return {};
}

}  // namespace

RedirectPage::RedirectPage(const std::string& address, const std::vector<std::filesystem::path>& folders) {
  const std::string text =
      "<!DOCTYPE html><meta http-equiv=\"refresh\" content=\"0; url=" + address + "\">\n";
  for (const std::filesystem::path& folder : folders)
    if (file_.empty()) file_ = write_redirect(folder, text);
}

RedirectPage::~RedirectPage() {
  if (!file_.empty()) unlink(file_.c_str());
}

}  // namespace remote_touch
