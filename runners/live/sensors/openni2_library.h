// The run-time library of OpenNI 2 and what it tells. Included where the library is installed only.
#pragma once

#include <OpenNI.h>

#include <atomic>
#include <string>
#include <vector>

namespace remote_touch::openni2 {

// The library's own words for its last error, in one line.
std::string error_text();

// Where the library looks for drivers: beside itself.
std::string driver_folder();

bool is_file(const std::string& address);

// Started for as long as this lives, from any thread.
class Library {
 public:
  Library();  // InputError where it does not start
  ~Library();
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  // Without the recordings that are open, which the library takes for devices.
  std::vector<openni::DeviceInfo> cameras() const;
};

// Hears from a thread of the driver that the camera with this URI was unplugged.
class LossListener : public openni::OpenNI::DeviceDisconnectedListener {
 public:
  explicit LossListener(std::string uri);
  ~LossListener() override;

  bool is_lost() const { return is_lost_; }
  void onDeviceDisconnected(const openni::DeviceInfo* device) override;

 private:
  const std::string uri_;
  std::atomic<bool> is_lost_ = false;
};

// STATUS_OK: a frame is there.
openni::Status wait_for(openni::VideoStream& stream, int timeout_ms);

// The newest frame, which has to be there; not valid: failed. VideoStream::readFrame() would take a pointer
// that nobody has set for a frame when it fails.
openni::VideoFrameRef read_from(const openni::VideoStream& stream);

}  // namespace remote_touch::openni2
