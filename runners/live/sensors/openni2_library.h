// The run-time library of OpenNI 2. Included only if the library is installed.
#pragma once

#include <OpenNI.h>

#include <atomic>
#include <string>
#include <vector>

namespace remote_touch::openni2 {

// The library's own text for its last error, in one line.
std::string error_text();

// The folder where the library searches for drivers: its own.
std::string driver_folder();

bool is_file(const std::string& address);

// The library is initialised while an object of this class exists, from any thread.
class Library {
 public:
  Library();  // throws InputError if it cannot be initialised
  ~Library();
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  // Returns the cameras, without open recordings, which the library also lists as devices.
  std::vector<openni::DeviceInfo> cameras() const;
};

// Is notified, from a thread of the driver, that the camera with this URI was unplugged.
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

// Returns STATUS_OK if a frame is available.
openni::Status wait_for(openni::VideoStream& stream, int timeout_ms);

// Returns the newest frame; an invalid one on failure. pre: a frame is available. VideoStream::readFrame()
// would use an uninitialised pointer when it fails.
openni::VideoFrameRef read_from(const openni::VideoStream& stream);

}  // namespace remote_touch::openni2
