#include "runners/live/sensors/openni2_library.h"

#include <dlfcn.h>

#include <cctype>
#include <filesystem>
#include <mutex>
#include <utility>

#include "core/parameters/input_error.h"

namespace remote_touch::openni2 {

namespace {

namespace fs = std::filesystem;

// The library counts its users, but not safely between threads.
std::mutex& count_mutex() {
  static std::mutex one;
  return one;
}

}  // namespace

std::string error_text() {
  std::string text = openni::OpenNI::getExtendedError();
  for (char& c : text)
    if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.empty() ? "no reason given" : text;
}

std::string driver_folder() {
  Dl_info info{};
  void* symbol = dlsym(RTLD_DEFAULT, "oniInitialize");
  if (symbol == nullptr || dladdr(symbol, &info) == 0) return "OpenNI2/Drivers";
  return (fs::path(info.dli_fname).parent_path() / "OpenNI2/Drivers").string();
}

bool is_file(const std::string& address) {
  std::error_code ignored;
  return fs::is_regular_file(address, ignored);
}

Library::Library() {
  const std::lock_guard lock(count_mutex());
  if (openni::OpenNI::initialize() == openni::STATUS_OK) return;
  const std::string reason = error_text();
  openni::OpenNI::shutdown();
  throw InputError("openni2",
                   "does not start (" + reason + "): expected drivers (lib*.so.0) in " + driver_folder());
}

Library::~Library() {
  const std::lock_guard lock(count_mutex());
  openni::OpenNI::shutdown();
}

std::vector<openni::DeviceInfo> Library::cameras() const {
  openni::Array<openni::DeviceInfo> devices;
  openni::OpenNI::enumerateDevices(&devices);
  std::vector<openni::DeviceInfo> found;
  for (int i = 0; i < devices.getSize(); ++i)
    if (!is_file(devices[i].getUri())) found.push_back(devices[i]);
  return found;
}

LossListener::LossListener(std::string uri) : uri_(std::move(uri)) {
  openni::OpenNI::addDeviceDisconnectedListener(this);
}

LossListener::~LossListener() {
  openni::OpenNI::removeDeviceDisconnectedListener(this);
}

void LossListener::onDeviceDisconnected(const openni::DeviceInfo* device) {
  if (uri_ == device->getUri()) is_lost_ = true;
}

openni::Status wait_for(openni::VideoStream& stream, int timeout_ms) {
  openni::VideoStream* streams[] = {&stream};
  int which = 0;
  return openni::OpenNI::waitForAnyStream(streams, 1, &which, timeout_ms);
}

// Returns the newest frame, which must be available; an invalid one on failure. VideoStream::readFrame()
// would use an uninitialised pointer when it fails.
openni::VideoFrameRef read_from(const openni::VideoStream& stream) {
  openni::VideoFrameRef frame;
  OniFrame* raw = nullptr;
  if (oniStreamReadFrame(stream._getHandle(), &raw) != ONI_STATUS_OK || raw == nullptr) return frame;
  frame._setFrame(raw);  // counts one more user
  oniFrameRelease(raw);
  return frame;
}

}  // namespace remote_touch::openni2

#ifdef __SANITIZE_THREAD__
// The thread sanitizer does not understand the library's locks, so it must ignore them from the moment at
// which the library is loaded.
extern "C" const char* __tsan_default_suppressions() {
  return "mutex:libOpenNI2.so\nmutex:libOniFile.so\ndeadlock:libOpenNI2.so\ndeadlock:libOniFile.so\n";
}
#endif
