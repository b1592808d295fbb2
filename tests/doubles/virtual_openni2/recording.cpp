#include "tests/doubles/virtual_openni2/recording.h"

#ifdef REMOTE_TOUCH_VIRTUAL_OPENNI2

#include <OpenNI.h>

#include "tests/doubles/virtual_openni2/pattern.h"

namespace remote_touch::virtual_camera {

namespace {

std::string record(const std::string& file, int frames) {
  openni::Device device;
  openni::VideoStream depth;
  if (device.open("virtual-camera") != openni::STATUS_OK) return "no camera";
  if (depth.create(device, openni::SENSOR_DEPTH) != openni::STATUS_OK) return "no depth";
  openni::VideoMode mode;
  mode.setPixelFormat(openni::PIXEL_FORMAT_DEPTH_1_MM);
  mode.setResolution(kWidth, kHeight), mode.setFps(kRate_hz);
  if (depth.setVideoMode(mode) != openni::STATUS_OK) return "no such mode";
  openni::Recorder recorder;
  if (recorder.create(file.c_str()) != openni::STATUS_OK) return "no file";
  if (recorder.attach(depth) != openni::STATUS_OK) return "not attached";
  if (recorder.start() != openni::STATUS_OK || depth.start() != openni::STATUS_OK) return "not started";
  for (int i = 0; i < frames; ++i) {
    openni::VideoFrameRef frame;
    if (depth.readFrame(&frame) != openni::STATUS_OK) return "no frame";
  }
  // The stream stops first, because the library's recorder and a frame that comes while it ends can wait for
  // each other for ever.
  depth.stop();
  recorder.stop();
  return "";
}

}  // namespace

std::string record_virtual_camera(const std::string& file, int frames) {
  if (openni::OpenNI::initialize() != openni::STATUS_OK) return "the library does not start";
  const std::string problem = record(file, frames);
  openni::OpenNI::shutdown();
  return problem;
}

}  // namespace remote_touch::virtual_camera

#else

std::string remote_touch::virtual_camera::record_virtual_camera(const std::string&, int) {
  return "not compiled in";
}

#endif
