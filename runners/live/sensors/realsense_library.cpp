#include "runners/live/sensors/realsense_library.h"

#include "core/parameters/input_error.h"

namespace remote_touch::rs2 {

namespace {

// The file name contains the minor version; only packages for development add a name without it. Older
// versions can be named with the environment variable.
constexpr int kOldestMinor = 50, kNewestMinor = 69;
constexpr int kMajor = 2;

SharedLibrary::Lookup realsense_lookup() {
  SharedLibrary::Lookup lookup{
      {"librealsense2.so"}, "REMOTE_TOUCH_LIBREALSENSE", "the RealSense SDK (librealsense2)"};
  for (int minor = kNewestMinor; minor >= kOldestMinor; --minor)
    lookup.names.push_back("librealsense2.so." + std::to_string(kMajor) + "." + std::to_string(minor));
  return lookup;
}

std::string text_of_version(int version) {
  return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
         std::to_string(version % 100);
}

}  // namespace

RealSenseLibrary::RealSenseLibrary() : library(realsense_lookup()) {}

int RealSenseLibrary::checked_version() const {
  const int found = Calls(*this, library.file())("does not report its version", get_api_version);
  if (found / 10000 != kMajor)
    throw InputError(library.file(), "is version " + text_of_version(found) + " of its interface: expected " +
                                         std::to_string(kMajor) + ".x");
  return found;
}

std::string RealSenseLibrary::version_text() const {
  return text_of_version(version);
}

std::string RealSenseLibrary::text_of(Error* error) const {
  const char *message = get_error_message(error), *function = get_failed_function(error);
  std::string text = function != nullptr ? function : "";
  if (message != nullptr) text += (text.empty() ? "" : ": ") + std::string(message);
  free_error(error);
  return text.empty() ? "no reason given" : text;
}

void Calls::refuse(const std::string& problem) const {
  throw InputError(name_, problem);
}

void Calls::check(const char* what, Error* error) const {
  if (error != nullptr) refuse(std::string(what) + " (the library says: " + rs2_.text_of(error) + ")");
}

}  // namespace remote_touch::rs2
