#include "runners/live/devices/hd_library.h"

namespace remote_touch {

namespace {

const SharedLibrary::Lookup kHdLibrary{
    {"libHD.so", "libHD.so.3.5", "libHD.so.3.4"}, "REMOTE_TOUCH_LIBHD", "3D Systems' OpenHaptics"};

}  // namespace

HdLibrary::HdLibrary() : library(kHdLibrary) {
  library.find("hdInitDevice", init_device);
  library.find("hdDisableDevice", disable_device);
  library.find("hdMakeCurrentDevice", make_current_device);
  library.find("hdBeginFrame", begin_frame);
  library.find("hdEndFrame", end_frame);
  library.find("hdGetError", get_error);
  library.find("hdGetErrorString", get_error_string);
  library.find("hdEnable", enable);
  library.find("hdDisable", disable);
  library.find("hdGetDoublev", get_doublev);
  library.find("hdGetIntegerv", get_integerv);
  library.find("hdSetDoublev", set_doublev);
  library.find("hdGetString", get_string);
  library.find("hdScheduleAsynchronous", schedule_asynchronous);
  library.find("hdUnschedule", unschedule);
  library.find("hdStartScheduler", start_scheduler);
  library.find("hdStopScheduler", stop_scheduler);
}

}  // namespace remote_touch
