"""Energy-optimal trajectories for differential-drive robots, and the diagnosis of the sim-to-real gap.

Names end in their SI unit (``energy_J``, ``payload_kg``). Arrays are float64; those that results hold are
read-only views without copies. Long calls release the GIL, and Ctrl-C ends them.

>>> import joulepath as jp
>>> robot = jp.Robot.example()
>>> p = jp.profile(robot, [[0, 0], [2, 0], [4, 1]], payload_kg=5)
>>> p.lower_bound_J <= p.energy_J
True
"""

from ._core import version as __version__
from ._errors import ConfigError, Infeasible, PlanningError
from ._records import Record
from .commands import (Answer, batch, calibrate, check, compare, drift, estimate, experiment, export, front,
                       monitor, sweep)
from .diagnosis import Diagnosis, Run, diagnose
from .energies import Energy, energy
from .logs import Log
from .mapping import map  # noqa: A004
from .online import Command, Follower, Replan, Replanner
from .paths import Path
from .pieces import Drive, drives
from .plans import Plan, Profile, plan, profile
from .robots import Robot
from .simulation import Simulation, simulate

__all__ = [
    "Answer", "Command", "ConfigError", "Diagnosis", "Drive", "Energy", "Follower", "Infeasible", "Log", "Path", "Plan",
    "PlanningError", "Profile", "Record", "Replan", "Replanner", "Robot", "Run", "Simulation", "__version__",
    "batch", "calibrate", "check", "compare", "diagnose", "drift", "drives", "energy", "estimate", "experiment", "export",
    "front", "map", "monitor", "plan", "profile", "simulate", "sweep",
]
