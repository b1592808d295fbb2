"""Closed forms of the theory, and estimates and fits, as the program computes them.

Units are in the names. The headers in analysis/theory and analysis/trace state the formulas and what is required of the
arguments; help(remote_touch.theory) lists all functions.
"""
from remote_touch import _core as _core

globals().update({name: value for name, value in vars(_core.theory).items() if not name.startswith("_")})
__all__ = sorted(name for name in vars(_core.theory) if not name.startswith("_"))
