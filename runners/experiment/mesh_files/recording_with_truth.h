// A recording as a scenario whose true surface may come from mesh files.
#pragma once

#include "runners/experiment/mesh_files/mesh_file.h"
#include "scenarios/recordings/recorded_scene.h"

namespace remote_touch {

class RecordingWithTruth final : public RecordedScene {
 public:
  using Settings = RecordedScene::Settings;
  RecordingWithTruth(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
      : RecordedScene(settings, key, kernels,
                      [](const std::filesystem::path& file) { return read_mesh(file); }) {}
};

}  // namespace remote_touch
