// The run-time library of OpenNI 2. Included only if the library is installed.
#pragma once

#include <OpenNI.h>

#include <atomic>
#include <string>
#include <vector>

namespace remote_touch::openni2 {

// Returns the library's own text for its last error, in one line.
std::string error_text();

// Returns the folder in which the library searches for drivers. It is beside the library's file.
std::string driver_folder();

bool is_file(const std::string& address);

// Keeps the library initialised while an object of this class exists. Any thread may make an object.
class Library {
 public:
  Library();  // throws InputError if it cannot be initialised
  ~Library();
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  // Returns the cameras, without open recordings, which the library also lists as devices.
  std::vector<openni::DeviceInfo> cameras() const;
};

// A thread of the driver notifies this object when the camera with this URI was unplugged.
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

// Waits at most timeout_ms for a frame. Returns STATUS_OK if one is available.
openni::Status wait_for(openni::VideoStream& stream, int timeout_ms);

// Returns the newest frame; an invalid one on failure. pre: a frame is available. VideoStream::readFrame()
// would use an uninitialised pointer when it fails.
openni::VideoFrameRef read_from(const openni::VideoStream& stream);

}  // namespace remote_touch::openni2
