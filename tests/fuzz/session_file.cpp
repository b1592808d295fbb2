// Recorded sessions (content_text.h): view, ticks and frames.
#include "runners/experiment/sessions/session_file.h"

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/sessions/session_scene.h"
#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::session_file {
namespace {

void read(std::string_view bytes) {
  accepts(bytes, [&] {
    const SessionReader session(reader_of(content_of(bytes)));
    const CameraIntrinsics& camera = session.view().camera;
    require(camera.width > 0 && camera.height > 0 && session.haptic_rate_hz() > 0, "a session has a view");
    for (std::size_t i = 0; i < session.tick_count(); ++i) {
      require(session.taken(i) < static_cast<std::int32_t>(session.frame_count()), "a frame was recorded");
      session.device(i);
    }
    for (std::size_t i = 0; i < session.frame_count(); ++i)
      require(session.frame(i).depth.size() == camera.pixels(), "every pixel has a depth");
    Experiment::from_json(session_experiment(session, "fuzz.h5"), "fuzz.h5");
  });
}

const Registered registered("session_file", read);

}  // namespace
}  // namespace remote_touch::fuzz::session_file
