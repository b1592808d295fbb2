// Hashes, in result files, of the recordings that the results were made from. The hashes below are from
// sha256sum, as runners/experiment/settings/provenance.h describes. The test
// tests/system/command_line/inputs runs it on real files.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/sweep/sweep_session.h"
#include "tests/support/test_files.h"

namespace remote_touch::inputs_test {
namespace {

namespace fs = std::filesystem;

class Inputs : public ::testing::Test {
 protected:
  InputPart part(int first = 0, int last = -1) const { return {folder_.path().string(), first, last}; }
  std::string text(int first = 0, int last = -1) const { return input_hashes({part(first, last)}); }
  // Text after the path of the folder.
  std::string rest(const std::string& of) const { return of.substr(folder_.path().string().size()); }
  std::string names(int first = 0, int last = -1) const {
    std::string list;
    for (const InputFile& file : files_of(part(first, last))) list += file.name + " ";
    return list;
  }

  // True if the text changes when the first such letter in this file is changed.
  bool depends_on(const std::string& name, char letter, int first = 0, int last = -1) const {
    const std::string before = text(first, last), bytes = bytes_of(folder_ / name);
    std::string changed = bytes;
    changed.at(bytes.find(letter)) ^= 1;
    folder_.write(name, changed);
    const std::string after = text(first, last);
    folder_.write(name, bytes);
    EXPECT_EQ(text(first, last), before);
    return before != after;
  }

  void write_depth_folder(bool colour_registered) const {
    folder_.write("camera.json",
                  std::string(R"({"width": 3, "height": 2, "fx": 10, "fy": 20, "cx": 1, "cy": 0.5,)") +
                      R"("depth_scale_m": 0.001, "frame_rate_hz": 20, "colour_registered": )" +
                      (colour_registered ? "true}" : "false}"));
    for (const std::string name : {"0000.png", "0001.png", "0002.png"})
      folder_.write("depth/" + name, "image " + name),
          folder_.write("rgb/" + name, "image in colour " + name);
    folder_.write("README.md", "image");
  }

  const TestFolder folder_{"input_hashes_test"};
};

TEST_F(Inputs, AreHashedAsSha256sumDoes) {
  folder_.write("camera.json", R"({"frame_rate_hz": 5})");
  folder_.write("1.pcd", "first"), folder_.write("2.pcd", "second"), folder_.write("10.pcd", "third");
  EXPECT_EQ(rest(text(1)),
            ": 3 file(s), 31 bytes, sha256 74657a587515759f0e403097b5746b6cfa4608cc870b3ed20e00fb4508ed0137");
  const std::string one = (folder_ / "2.pcd").string();
  EXPECT_EQ(input_hashes({{one}}), one +
                                       ": 1 file(s), 6 bytes, sha256 "
                                       "e4e3500d2a87fddc8612482fc5028ad2834e7794f56a4d8de6d1ef2f77e5bee3");
  EXPECT_EQ(rest(input_hashes({{(folder_ / "").string(), 1}})), "/" + rest(text(1)));
}

TEST_F(Inputs, OddNamesAreHashedAsSha256sumDoes) {
  folder_.write("a\\b\nc.pcd", "x"), folder_.write("\xc3\xa4 b.pcd", "y");
  EXPECT_EQ(rest(text()),
            ": 2 file(s), 2 bytes, sha256 e2f06a70db23da98fa5027242a8d8a51e6eed3adc3bbd923a914ea4a5eea43ac");
  const std::string odd = (folder_ / "a\\b\nc.pcd").string();
  EXPECT_EQ(input_hashes({{odd}}).find('\n'), std::string::npos);
  EXPECT_EQ(in_one_line("a\\b\nc\r"), "a\\\\b\\nc\\r");
}

TEST_F(Inputs, AreTheFilesOfTheFramesAndNoOthers) {
  write_depth_folder(false);
  EXPECT_EQ(names(), "camera.json depth/0000.png depth/0001.png depth/0002.png ");
  EXPECT_EQ(names(1, 1), "camera.json depth/0001.png ");
  EXPECT_TRUE(depends_on("camera.json", '2', 1, 1));  // a value
  EXPECT_TRUE(depends_on("depth/0001.png", 'm', 1, 1));
  for (const std::string name : {"depth/0000.png", "depth/0002.png", "rgb/0001.png", "README.md"})
    EXPECT_FALSE(depends_on(name, 'm', 1, 1)) << name;
  write_depth_folder(true);
  EXPECT_EQ(names(1, 1), "camera.json depth/0001.png rgb/0001.png ");
  EXPECT_TRUE(depends_on("rgb/0001.png", 'm', 1, 1));
  EXPECT_FALSE(depends_on("rgb/0002.png", 'm', 1, 1));
  const std::string before = text();
  fs::rename(folder_ / "depth/0002.png", folder_ / "depth/0003.png");
  EXPECT_NE(text(), before);  // a name counts too
}

TEST_F(Inputs, IncludeTheUsedListsOfTumFolders) {
  for (const std::string name : {"depth/a.png", "depth/b.png", "rgb/p.png", "rgb/q.png", "rgb/r.png"})
    folder_.write(name, "image " + name);
  folder_.write("depth.txt", "# list\n1.0 depth/a.png\n2.0 ./depth//b.png\n2.01 depth/a.png\n");
  folder_.write("rgb.txt", "# list\n1.0 rgb/p.png\n1.5 rgb/r.png\n2.005 rgb/q.png\n");
  EXPECT_EQ(names(), "./depth/b.png depth.txt depth/a.png rgb.txt rgb/p.png rgb/q.png ");
  EXPECT_EQ(names(1, 1), "./depth/b.png depth.txt rgb.txt rgb/q.png ");
  EXPECT_TRUE(depends_on("depth.txt", 'l', 1, 1) && depends_on("rgb.txt", 'l', 1, 1));  // their comments
  EXPECT_TRUE(depends_on("depth/b.png", 'm', 1, 1) && depends_on("rgb/q.png", 'm', 1, 1));
  EXPECT_FALSE(depends_on("depth/a.png", 'm', 1, 1) || depends_on("rgb/p.png", 'm', 1, 1));
  EXPECT_FALSE(depends_on("rgb/r.png", 'm'));
  write_depth_folder(false);
  EXPECT_EQ(names(0, 0), "camera.json depth.txt depth/a.png ");
}

TEST_F(Inputs, NamedFromElsewhereComeFromTheFolder) {
  const TestFolder other("input_hashes_test_elsewhere");
  const std::string file = other.write("a.png", "depth").string();
  folder_.write("depth.txt", "1.0 " + file + "\n");
  const std::string name = files_of(part()).front().name;
  EXPECT_EQ(name.substr(0, 3), "../");
  EXPECT_TRUE(fs::equivalent(folder_ / name, file));
}

TEST_F(Inputs, HaveOneLinePerRecording) {
  write_depth_folder(false);
  const std::string cloud = folder_.write("x.pcd", "cloud").string();
  InputHashes hashes;
  EXPECT_EQ(hashes.text(), "");
  hashes.add({part(0, 0), {cloud}, part(2, 2)});
  const std::string all = hashes.text();
  EXPECT_EQ(rest(all).substr(0, 14), ": 3 file(s), 1");
  EXPECT_HAS(all, "\n" + cloud + ": 1 file(s), 5 bytes, sha256 ");
  EXPECT_EQ(input_hashes({{cloud}, part(2, 2), part(0, 0), part(2, 2)}), all);
  // Only the union of the parts counts.
  EXPECT_EQ(input_hashes({part(0, 0), part(1, 1), part(2, 2)}), text());
  EXPECT_EQ(input_hashes({part(0, 1), part(1, 2)}), text());
}

TEST_F(Inputs, MissingOnesAreRefusedAsByARun) {
  const std::string nowhere = (folder_ / "nowhere").string();
  InputHashes hashes;
  EXPECT_THROW(hashes.add({{nowhere}}), MissingInput);
  EXPECT_EQ(hashes.text(), "");
  write_depth_folder(false);
  const auto refused = [&](const InputPart& of) { return refusal([&] { input_hashes({of}); }); };
  EXPECT_HAS(refused(part(0, 7)), "last_frame = 7: expected 0 to 2");
  EXPECT_HAS(refused(part(3)), "first_frame = 3");
  fs::create_directory(folder_ / "depth/0003.png");
  EXPECT_HAS(refused(part()), "0003.png: cannot be read");
  fs::remove(folder_ / "camera.json");
  EXPECT_HAS(refused(part()), "camera.json: is missing");
}

TEST_F(Inputs, AreRefusedIfTheyChangeDuringARun) {
  write_depth_folder(false);
  const std::string before = text(0, 1);
  require_unchanged({part(0, 1)}, before);
  folder_.write("depth/0002.png", "not used");
  require_unchanged({part(0, 1)}, before);
  folder_.write("depth/0001.png", "another image");
  const std::string message = refusal([&] { require_unchanged({part(0, 1)}, before); });
  EXPECT_HAS(message, folder_.path().string() + ": changed while it was read (");
  EXPECT_HAS(message, "expected files that no program writes");
}

// Three short runs on a cloud.
class SweepInputs : public Inputs {
 protected:
  std::string write_cloud(const std::string& more = "") const {
    return folder_.write("cloud.pcd", xyz_header("2", "ascii") + "0 0 0.5\n0.001 0 0.5\n" + more).string();
  }
  // Calls done() after each run.
  template <class Done>
  bool run(const Done& done) {
    return SweepSession(sweep_, {}, attributes_, result_)
        .run(kernels_for(best_isa()), nullptr, [&](auto, auto, auto) { done(); });
  }
  std::size_t runs_in(RunState state) const { return read_sweep(result_).result.runs_in(state).size(); }

  const std::filesystem::path result_ = folder_ / "sweep.h5";
  const Sweep sweep_ =
      Sweep::from_json(R"({"experiment": {"scenario": {"name": "recording", "path": ")" + write_cloud() +
                           R"("}, "renderer": {"name": "proxy"}, "duration_s": 0.01,
              "trajectory": {"name": "waypoints", "waypoints": [[0, 0, 0.4, 0], [0, 0, 0.4, 0.01]]}},
          "measures": ["max_force"], "axes": [{"parameter": "renderer.steps_per_tick", "values": [10, 20, 30]}]})",
                       "test");
  const TextAttributes attributes_{{"config", sweep_.to_json()},
                                   {"input_digests", input_hashes(sweep_.inputs())}};
};

// The first run that ends changes the recording: no run of that call is kept, and the next call does them
// all.
TEST_F(SweepInputs, UndoTheRunsOfASweepIfTheyChangeDuringIt) {
  EXPECT_HAS(refusal([&] { run([&] { write_cloud("\n"); }); }), "changed while it was read");
  EXPECT_EQ(runs_in(RunState::pending), 3u);
  write_cloud();
  EXPECT_TRUE(run([] {}));
  EXPECT_EQ(runs_in(RunState::done), 3u);
}

// The sweep fails as it does if the file cannot be written, or if a run finds no memory.
TEST_F(SweepInputs, UndoTheRunsOfASweepThatFailsIfTheyChangeDuringIt) {
  const auto fail_with = [&](const std::string& more) {
    run([&] {
      write_cloud(more);
      throw InputError("a full disk");
    });
  };
  EXPECT_HAS(refusal([&] { fail_with("\n"); }), "changed while it was read");
  EXPECT_EQ(runs_in(RunState::done), 0u);
  write_cloud();
  EXPECT_EQ(refusal([&] { fail_with(""); }), "a full disk");
  EXPECT_GT(runs_in(RunState::done), 0u);
}

TEST(ChangedInputs, AreListedByPath) {
  const std::string a = "a: b: 1 file(s), 2 bytes, sha256 00", b = "b: 3 file(s), 4 bytes, sha256 11";
  EXPECT_TRUE(changed_inputs("", "").empty());
  EXPECT_TRUE(changed_inputs(a + "\n" + b, a + "\n" + b).empty());
  const auto changed = changed_inputs(a + "\n" + b, "a: b: 1 file(s), 2 bytes, sha256 01\n" + b);
  ASSERT_EQ(changed.size(), 1u);
  EXPECT_EQ(changed[0].path, "a: b");
  EXPECT_EQ(changed[0].before, "1 file(s), 2 bytes, sha256 00");
  EXPECT_EQ(changed[0].now, "1 file(s), 2 bytes, sha256 01");
  ASSERT_EQ(changed_inputs(a, b).size(), 2u);
  EXPECT_EQ(changed_inputs(a, b)[0].now, "absent");
  EXPECT_EQ(changed_inputs(a, b)[1].before, "absent");
}

// --- recordings that experiments and sweeps name ---

TEST(NamedInputs, ASweepHasThoseOfAllItsCells) {
  EXPECT_TRUE(Experiment::load("fig4.12").inputs().empty());
  EXPECT_EQ(Experiment::load("fig4.16-recorded").inputs(),
            (std::vector<InputPart>{{"rgbd/visp_organ_table", 0, 4, true}}));
  EXPECT_TRUE(Sweep::load("fig4.13").inputs().empty());
  const Sweep sweep = Sweep::from_json(
      R"({"experiment": "fig4.16-recorded", "measures": ["mean_steps"],
      "axes": [{"parameter": "scenario.path", "values": ["y", "x"]},
               {"parameter": "scenario.last_frame", "values": [2, 1]}, {"parameter": "seed", "values": [1, 2]}]})",
      "recordings");
  EXPECT_EQ(sweep.inputs(), (std::vector<InputPart>{
                                {"x", 0, 1, true}, {"x", 0, 2, true}, {"y", 0, 1, true}, {"y", 0, 2, true}}));
}

// Runs on x are done, and those on y are not. Recording y may therefore be repaired.
TEST(NamedInputs, AnUnfinishedSweepKeepsThoseOfDoneRuns) {
  const TestFolder folder("input_hashes_test_session");
  const Sweep sweep = Sweep::from_json(
      R"({"experiment": "fig4.16-recorded", "measures": ["mean_steps"],
      "axes": [{"parameter": "scenario.path", "values": ["x", "y"]}, {"parameter": "seed", "values": [1, 2]}]})",
      "recordings");
  const std::string x = "x: 2 file(s), 9 bytes, sha256 00", y = "y: 2 file(s), 9 bytes, sha256 11";
  const auto attributes = [&](const std::string& inputs) {
    return TextAttributes{{"config", sweep.to_json()}, {"input_digests", inputs}};
  };
  SweepResult result = sweep.plan();
  std::get<std::vector<double>>(result.measures[0].values)[0] = 5;
  result.state[0] = RunState::done;
  write_sweep_in_progress(folder / "map.h5", result, attributes(x + "\n" + y));
  const auto planned = [&](const std::string& inputs) {
    return plan_in_file(sweep, {}, attributes(inputs), folder / "map.h5");
  };
  EXPECT_TRUE(planned(x + "\n" + y).in_progress);
  const SweepPlan mended = planned(x + "\n" + y + "2");
  EXPECT_FALSE(mended.in_progress || mended.is_finished);  // the file has to be written anew
  EXPECT_EQ(attribute(mended.made.attributes, "input_digests"), x + "\n" + y + "2");
  EXPECT_EQ(std::get<SweepResult>(mended.made.kept).state[0], RunState::done);
  EXPECT_HAS(refusal([&] { planned(x + "3\n" + y); }), "map.h5: has runs on another recording x (2 file(s)");
  EXPECT_HAS(refusal([&] { planned(""); }), "now absent");
}

}  // namespace
}  // namespace remote_touch::inputs_test
