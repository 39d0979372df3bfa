"""Plans driven on a simulated robot."""

from __future__ import annotations

import functools
import re
from typing import Any, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._errors import named_by, refused
from ._inputs import number, text_of, whole
from ._plots import over_time
from .logs import Log
from .plans import Plan
from .robots import Robot, robot_of

Effects = Mapping[str, Mapping[str, Any]]


class Simulation(Log):
    """The log of the sensors of a simulated run."""

    __slots__ = ("__dict__", "_run")

    def __init__(self, run: _core.SimulationValue) -> None:
        super().__init__(run.log())
        self._run = run

    @functools.cached_property
    def executed(self) -> Log:
        """The exact values at the samples and at the start, without sensor errors."""
        return Log(self._run.executed())

    @property
    def t(self) -> NDArray[np.float64]:
        """Time of ``executed``, s, shape (N,); the sensors' first sample is the second."""
        return self.executed["time_s"]

    @property
    def v(self) -> NDArray[np.float64]:
        """Exact speed, m/s, shape (N,)."""
        return self.executed["linear_speed_m_s"]

    @property
    def w(self) -> NDArray[np.float64]:
        """Exact yaw rate, rad/s, shape (N,)."""
        return self.executed["angular_speed_rad_s"]

    @property
    def power_W(self) -> NDArray[np.float64]:
        """Exact power at the battery's terminals, W, shape (N,)."""
        return self.executed["battery_power_W"]

    def plot(self, axes: Any = None) -> Any:
        """Exact speed and power over time; needs matplotlib. Returns the two axes."""
        return over_time(axes, self.executed)

    @property
    def energy_J(self) -> float:
        """Energy at the battery's terminals, standby included."""
        return self._run.energy_J

    @property
    def duration_s(self) -> float:
        """Until the robot stands at the end."""
        return self._run.duration_s


def simulate(plan: Plan, robot: Robot | None = None, *, effects: Effects | Sequence[Effects] = (), seed: int = 1,
             ideal_sensors: bool = False, time_of_day_s: float = 0.0, sample_rate_Hz: float = 50.0) -> Simulation:
    """Drives a plan on a simulated robot, as ``joulepath simulate`` does.

    ``robot`` is the model of the controller (None: the plan's). ``effects`` are those of the catalog that this model
    lacks: ``{"rolling_resistance": {"coefficient": 0.01}}``, or a list of such dicts where one stands twice; a ``side``
    is ``left`` or ``right``. ``seed`` is that of the sensors' noise; ``ideal_sensors`` have none. ``sample_rate_Hz``: 1 to
    1000. ``time_of_day_s``: at the start, for effects that change with it. The GIL is released meanwhile. Raises ConfigError.

    >>> from joulepath import profile
    >>> p = profile(Robot.example(), [[0, 0], [2, 0]])
    >>> log = simulate(p, effects={"rolling_resistance": {"coefficient": 0.02}}, seed=3)
    >>> log.energy_J > p.energy_J
    True
    """
    if not isinstance(plan, Plan):
        raise refused("plan", type(plan).__name__, "a Plan or a Profile")
    groups = [effects] if isinstance(effects, Mapping) else effects
    if isinstance(groups, str) or not isinstance(groups, Sequence) or not all(isinstance(group, Mapping) for group in groups):
        raise refused("effects", repr(effects), "a dict {effect: {parameter: value}}, or a list of such dicts")
    listed = [{name: settings} for group in groups for name, settings in group.items()]
    places = ["effects" if isinstance(effects, Mapping) else f"effects[{index}]" for index, group in enumerate(groups) for _ in group]

    def place(file: str, key: str) -> str | None:
        entry = re.match(r"\[(\d+)\]", key)
        return (places[int(entry[1])] + key[entry.end():] if entry else "effects") if file == "effects" else None

    with named_by(place):
        return Simulation(_core.simulate(
            plan._value, None if robot is None else robot_of(robot)._value, text_of("effects", listed),
            bool(ideal_sensors), number("time_of_day_s", time_of_day_s), number("sample_rate_Hz", sample_rate_Hz, 1.0, most=1000.0),
            whole("seed", seed, 0, 2**64 - 1)))
