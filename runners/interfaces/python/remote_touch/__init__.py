"""Remote Touch from Python: simulate haptic rendering of streaming point clouds, and read the results.

    import remote_touch as rt
    lift = rt.run("fig4.12", seed=7, set={"scenario.noise_sigma_m": 0.003})   # an xarray.Dataset

run, sweep, replay, analyse, compare, describe, list, scorecard and open do what the commands of remote-touch of the same name do.
Renderer, Scenario and Trajectory are base classes of your own ones; register() puts them into the catalog.
All bad input is an InputError, a ValueError of one line.
"""
import os as _os

from remote_touch import _core
from remote_touch._core import Cloud, DepthSensor, Device, Frame, InputError, MissingInput, NoiseKey, Output, Scene, tool_mesh
from remote_touch.calls import Comparison, analyse, compare, describe, list, open, replay, run, scorecard, sweep
from remote_touch.classes import Renderer, Scenario, Setting, Trajectory, register, scene, stepper

__version__ = _core.version()
__all__ = ["Cloud", "Comparison", "DepthSensor", "Device", "Frame", "InputError", "MissingInput", "NoiseKey", "Output", "Renderer",
           "Scenario", "Scene", "Setting", "Trajectory", "analyse", "compare", "describe", "list", "open", "register", "replay",
           "run", "scene", "scorecard", "stepper", "sweep", "tool_mesh"]

InputError.__module__ = __name__  # where users find it
MissingInput.__module__ = __name__
MissingInput.__doc__ = "A recording or another file of data that is not there."
InputError.__doc__ = "Input that cannot be used: one line, what is wrong: what is expected."
# The same variables as for the command line.
_core.choose_kernels(_os.environ.get("REMOTE_TOUCH_ISA", ""))
_core.set_data_folder(_os.environ.get("REMOTE_TOUCH_DATA", ""))
