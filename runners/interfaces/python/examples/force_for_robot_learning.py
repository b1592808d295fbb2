"""A teleoperator with force feedback for robot learning: demonstrations that were felt.

TouchTeleoperator has the methods of LeRobot's class Teleoperator, without importing it. send_feedback() gets the observation of
the robot, with what its depth camera saw; between two calls the device is served at 1 kHz. Device and robot are simulated here: a
hand that pokes at a beating heart, and a robot that follows at once.

Run it: PYTHONPATH=build/release/python python3 runners/interfaces/python/examples/force_for_robot_learning.py
"""
import numpy as np
import remote_touch as rt

RATE_HZ, HAPTIC_RATE_HZ = 30, 1000
AXES = ("x", "y", "z")


class ScriptedDevice:
    """Stands for the driver of a haptic device: it says where the hand is, and takes a force."""

    def __init__(self):
        self.ticks, self.force_N = 0, np.zeros(3)

    def position_m(self):
        self.ticks += 1
        return np.array([0.0, 0.12 - 0.07 * np.sin(np.pi * self.ticks / HAPTIC_RATE_HZ), 0.0])

    def set_force(self, force_N):
        self.force_N = force_N


class TouchTeleoperator:
    name = "touch"
    action_features = {f"hand.{axis}": float for axis in AXES} | {f"force.{axis}": float for axis in AXES}
    feedback_features = {"points": (None, 3), "captured_s": float}
    is_calibrated = True

    def __init__(self, device, renderer="proxy", settings=None):
        self.device, self.made_by = device, (renderer, settings or {})
        self.is_connected, self.ticks, self.hand_m = False, 0, np.zeros(3)

    def connect(self, calibrate=True):
        self.touch = rt.stepper(*self.made_by, set={"haptic_rate_hz": HAPTIC_RATE_HZ})
        self.is_connected = True

    def calibrate(self):
        pass

    def configure(self):
        pass

    def get_action(self):
        """Serves the device until the next frame is due; before the first frame without a force. A real one has its own thread."""
        for _ in range(HAPTIC_RATE_HZ // RATE_HZ):
            self.hand_m = self.device.position_m()
            self.device.set_force(self.touch.step(self.hand_m, self.ticks / HAPTIC_RATE_HZ).force_N)
            self.ticks += 1
        return {f"hand.{axis}": float(value) for axis, value in zip(AXES, self.hand_m)} | {
            f"force.{axis}": float(value) for axis, value in zip(AXES, self.device.force_N)}

    def send_feedback(self, feedback):
        self.touch.frame(feedback["points"], feedback["captured_s"])

    def disconnect(self):
        self.device.set_force(np.zeros(3))
        self.is_connected = False


class SimulatedRobot:
    """Follows the action at once, and sees a scene of the catalog."""

    def __init__(self):
        self.scene, self.frames, self.tool_m = rt.scene("beating-heart", width=320, height=240, focal_px=262), 0, np.zeros(3)

    def get_observation(self):
        self.frames += 1
        return {"tool": self.tool_m, "points": self.scene.cloud(self.frames - 1), "captured_s": (self.frames - 1) / RATE_HZ}

    def send_action(self, action):
        self.tool_m = np.array([action[f"hand.{axis}"] for axis in AXES])


def demonstration(robot, teleoperator, frames):
    """What a policy learns from: an array of the tool's position and the felt force for each frame, frames x 6."""
    recorded = []
    teleoperator.connect()
    for _ in range(frames):
        observation = robot.get_observation()
        action = teleoperator.get_action()
        teleoperator.send_feedback(observation)
        robot.send_action(action)
        recorded.append([*robot.tool_m, *(action[f"force.{axis}"] for axis in AXES)])
    teleoperator.disconnect()
    return np.array(recorded)


if __name__ == "__main__":
    felt = demonstration(SimulatedRobot(), TouchTeleoperator(ScriptedDevice(), settings={"stiffness_N_per_m": 300}), frames=30)
    force_N = np.linalg.norm(felt[:, 3:], axis=1)
    print(f"{len(felt)} steps recorded, {np.count_nonzero(force_N)} of them in contact, up to {force_N.max():.2f} N")
