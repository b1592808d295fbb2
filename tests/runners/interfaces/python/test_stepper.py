"""rt.stepper: the bits of rt.run, what it refuses, and what a call costs."""
import json
import re
import time

import numpy as np
import pytest
import remote_touch as rt

# What a run knows and the renderer does not: the hand, the truth, and hashes.
NOT_OF_THE_RENDERER = {"hip_position", "hip_orientation", "signed_distance", "slave_distance", "measured_distance", "frame_hash", "tick_hash"}


@pytest.mark.parametrize(("experiment", "changes"), [
    ("fig4.12", {"scenario.noise_sigma_m": 0.003}), ("tracked-lift", {}), ("tool-lift", {"duration_s": 0.6, "renderer.tool_voxel_m": 0.002}),
    ("fig5.8", {"duration_s": 0.5, "scenario.width": 320, "scenario.height": 240, "scenario.focal_px": 262.5, "fixtures.0.schedule": []})])
def test_steps_have_the_bits_of_a_run(experiment, changes):
    run = rt.run(experiment, set=changes)
    scene = json.loads(run.attrs["config"])["scenario"]
    source = rt.scene(scene.pop("name"), key=rt.NoiseKey(seed=json.loads(run.attrs["config"])["seed"]), **scene)
    stepped, shown = rt.stepper(experiment, set=changes), -1
    orientations = run.hip_orientation.values if "hip_orientation" in run else [None] * run.time.size
    outputs = []
    for time_s, frame, hip, orientation in zip(run.time.values, run.frame_index.values, run.hip_position.values, orientations):
        while shown < frame:
            shown += 1
            stepped.frame(source.cloud(shown), shown / scene["frame_rate_hz"])
        outputs.append(stepped.step(rt.Device(hip, orientation), time_s))
    assert run.contact_count.values.any() and shown > 5
    columns = {name for name, column in run.data_vars.items() if "time" in column.dims} - NOT_OF_THE_RENDERER
    assert columns >= {"force", "proxy_position", "state", "status", "proxy_steps", "slave_command"}
    for column in columns:
        assert np.array_equal([output[column] for output in outputs], run[column].values, equal_nan=True), column
    assert all(np.array_equal(output.force_N, output["force"]) for output in outputs)


def test_a_renderer_is_named_with_its_settings():
    points = np.stack(np.meshgrid(np.linspace(-0.02, 0.02, 41), 0, np.linspace(-0.02, 0.02, 41)), axis=-1).reshape(-1, 3)
    for stiffness_N_per_m in (200, 400):
        stepped = rt.stepper("proxy", {"stiffness_N_per_m": stiffness_N_per_m})
        stepped.frame(points, 0.0)
        for tick in range(200):
            output = stepped.step((0, 0.01 - 0.0001 * tick, 0), tick / 1000)
        assert output.state == "contact" and output.torque_Nm is None
        assert output.force_N == pytest.approx((0, stiffness_N_per_m * 0.0099, 0))  # the HIP is 9.9 mm below the plane


def test_the_status_tells_what_was_wrong_with_frames():
    """As in a run, a step before the first frame has no force, and a frame that is not newer than the last is dropped."""
    names, stepped = re.findall(r"\w+", rt.run("fig4.12", set={"duration_s": 0.01}).status.attrs["flag_meanings"]), rt.stepper("proxy")
    before = stepped.step((0, 0, 0), 0.0)
    assert names[before["status"]] == "no_frame" and before["frame_index"] == -1 and not before.force_N.any()
    for captured_s, status in ((0.5, "ok"), (0.4, "stale_frame_dropped")):
        stepped.frame(np.zeros((3, 3)), captured_s)
        assert names[stepped.step((0, 1, 0), 0.5)["status"]] == status
    assert before["torque"] is None and before["guidance_force"] is None  # the proxy has no tool, and there is no guidance


@pytest.mark.parametrize(("refused", "why"), [
    (lambda s: s.step((0, 0, 0), np.nan), "step: time_s"), (lambda s: s.step((0, 0, 0), 0.4), "no time before that of the last step"),
    (lambda s: s.step((0, np.nan, 0), 1.0), "step: device"), (lambda s: s.frame(np.zeros((3, 2)), 0.6), "points"),
    (lambda s: s.step((0, 0, 0), 0.5)["forces"], "expected a column that the renderer computes: .*force"),
    (lambda s: s.frame(np.zeros((3, 3)), np.inf), "frame: captured_s"), (lambda s: rt.stepper("prox", {}), "expected proxy"),
    (lambda s: rt.stepper("prox"), "expected proxy"), (lambda s: rt.stepper("fig4.122"), "an experiment's name"),
    (lambda s: rt.stepper("proxy", {"stiffness": 1}), "stiffness"), (lambda s: rt.stepper("tool").frame(np.zeros((3, 3)), 0), "normals")])
def test_bad_input_is_refused(refused, why):
    stepped = rt.stepper("proxy")
    stepped.step((0, 0, 0), 0.5)
    with pytest.raises(rt.InputError, match=why):
        refused(stepped)


def test_a_call_is_cheap():
    stepped = rt.stepper("proxy")
    stepped.frame(np.zeros((1, 3)), 0.0)
    count, begin = 5000, time.process_time()
    for tick in range(count):
        stepped.step((0, 0.1, 0), tick / 1000).force_N
    cost_us = (time.process_time() - begin) / count * 1e6
    print(f"\nrt.stepper: {cost_us:.2f} us for a step in free motion, force read")
    assert cost_us < 200  # 1 to 2 us where nothing else runs
