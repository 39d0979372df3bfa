"""Plans: missions, and profiles along a path."""

from __future__ import annotations

import functools
import html
import json
import math
import os
from pathlib import Path as FilePath
from typing import Any, Mapping, Sequence, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._errors import Infeasible, PlanningError, refused
from ._files import save
from ._inputs import Progress, called, caps, file_name, number, numbers, one_of, text_of, times, whole
from ._plots import over_time
from ._records import Record
from ._values import Value
from .logs import Log
from .paths import Path
from .robots import Robot, robot_of

SOLVERS = ("ipopt", "fast")


class Plan(Value):
    """An energy-optimal plan. ``json`` holds all of plan.json; its main parts are attributes here. ``t``, ``s``, ``v``, ``a``,
    ``w`` and ``power_W`` are read-only views of shape (N,)."""

    def __init__(self, value: _core.PlanValue) -> None:
        self._value = value

    @functools.cached_property
    def json(self) -> Record:
        """plan.json (schema joulepath/plan/1)."""
        return Record(json.loads(self._value.json))

    @property
    def status(self) -> str:
        """``optimal`` (proven for its paths), ``feasible``, ``infeasible`` or ``failed``."""
        return self._value.status

    @property
    def energy_J(self) -> float:
        """Energy at the battery's terminals, standby included."""
        return float(self.json.energy_J)

    @property
    def interval_95_J(self) -> tuple[float, float] | None:
        """95 % interval of the energy, from the uncertainty that the robot file states; None where it states none."""
        interval = self.json.energy_interval_95_J
        return None if interval is None else (float(interval[0]), float(interval[1]))

    @property
    def lower_bound_J(self) -> float | None:
        """No profile on these paths takes less; None for a drive of least time."""
        bound = self.json.lower_bound_J
        return None if bound is None else float(bound)

    @property
    def path_lower_bound_J(self) -> float | None:
        """No path of any kind from stop to stop takes less in this time; None where the bound does not cover the mission."""
        bound = self.json.get("path_lower_bound_J")
        return None if bound is None else float(bound)

    @property
    def battery(self) -> Record | None:
        """State of charge over the legs, as plan.json has it; None where the robot file states no capacity."""
        return self.json.get("battery")

    @property
    def winding(self) -> Record | None:
        """Temperatures of the windings over the legs, as plan.json has them; None where the motors state no ``thermal``."""
        return self.json.get("winding")

    @property
    def confidence(self) -> Record | None:
        """With what probability the promises are kept, as plan.json has it; None where ``objective.confidence`` is not stated."""
        return self.json.get("confidence")

    @property
    def duration_s(self) -> float:
        """Driving, waiting and dwell."""
        return float(self.json.duration_s)

    @property
    def legs(self) -> tuple[Record, ...]:
        """The legs as plan.json has them."""
        return tuple(self.json.legs)

    @functools.cached_property
    def robot(self) -> Robot:
        """The robot that was planned for."""
        return Robot._of(self._value.robot)

    @functools.cached_property
    def trajectory(self) -> Log:
        """The samples of trajectory.csv (50 Hz). A plan that cannot be driven has none: AttributeError."""
        if not self._driven:
            raise AttributeError(f"no trajectory: the plan is {self.status}")
        return Log(self._value.trajectory())

    @property
    def t(self) -> NDArray[np.float64]:
        """Time, s, shape (N,)."""
        return self.trajectory["time_s"]

    @property
    def s(self) -> NDArray[np.float64]:
        """Arc length, m, shape (N,)."""
        return self.trajectory["arc_length_m"]

    @property
    def v(self) -> NDArray[np.float64]:
        """Speed, m/s, shape (N,)."""
        return self.trajectory["linear_speed_m_s"]

    @property
    def a(self) -> NDArray[np.float64]:
        """Acceleration, m/s2, shape (N,)."""
        return self.trajectory["linear_acceleration_m_s2"]

    @property
    def w(self) -> NDArray[np.float64]:
        """Yaw rate, rad/s, shape (N,)."""
        return self.trajectory["angular_speed_rad_s"]

    @property
    def power_W(self) -> NDArray[np.float64]:
        """Power at the battery's terminals, W, shape (N,)."""
        return self.trajectory["battery_power_W"]

    @property
    def _driven(self) -> bool:
        return self._value.driven

    @overload
    def at(self, t: float) -> Record: ...

    @overload
    def at(self, t: Sequence[float] | NDArray[Any]) -> Log: ...

    def at(self, t: ArrayLike) -> Record | Log:
        """The plan at a time (s): numbers; or at increasing times, shape (N,): arrays. Exact at each.

        ``energy_J`` counts from the first time. Raises ConfigError for times outside of the plan.
        """
        at = times("t", np.atleast_1d(numbers("t", t, ndim=np.ndim(t))))
        if not self._driven:
            raise AttributeError(f"no trajectory: the plan is {self.status}")
        if len(at) and (at[0] < 0 or at[-1] > self.duration_s):
            raise refused("t", f"{at[0]:g} to {at[-1]:g} s", f"times from 0 to {self.duration_s:g} s")
        found = Log(self._value.at(at))
        return found if np.ndim(t) else Record({name: float(column[0]) for name, column in found.items()})

    def to_frame(self) -> Any:
        """The trajectory as a pandas.DataFrame; needs pandas."""
        return self.trajectory.to_frame()

    def plot(self, axes: Any = None) -> Any:
        """Speed and power over time; needs matplotlib. Returns the two axes."""
        return over_time(axes, self.trajectory)

    def report(self) -> str:
        """report.html: one self-contained page."""
        return self._value.report()

    def save(self, directory: str | os.PathLike[str], *, force: bool = False) -> FilePath:
        """Writes plan.json, trajectory.csv, profile.csv and report.html, byte for byte as ``joulepath plan`` does on the same day.

        Files that exist are overwritten with ``force`` alone, else ConfigError. Returns the directory.
        """
        return save(directory, {"plan.json": self._value.json,
                                "trajectory.csv": self.trajectory.text() if self._driven else None,
                                "profile.csv": self._value.profile_text() if self._driven else None,
                                "report.html": self.report()}, force)

    def _repr_html_(self) -> str:
        return (f'<iframe srcdoc="{html.escape(self.report())}" width="100%" height="900" '
                'style="border: 0"></iframe>')

    def __repr__(self) -> str:
        if self._driven:
            return f"{type(self).__name__}({self.status}, {self.energy_J:.6g} J, {self.duration_s:.6g} s)"
        return f"{type(self).__name__}({self.status})"


class Profile(Plan):
    """The plan along one path.

    >>> p = profile(Robot.example(), [[0, 0], [3, 0]])
    >>> len(p.t) == len(p.v) == len(p.power_W)
    True
    >>> p.at(0.0)["linear_speed_m_s"], p.at([0.0, 1.0])["linear_speed_m_s"].shape
    (0.0, (2,))
    """


def _solver_options(solver: Any, nodes: Any, accuracy: Any) -> tuple[str, int, float]:
    """The options as the compiled part takes them."""
    return one_of("solver", solver, SOLVERS), whole("nodes", nodes, 10, 20000), number("accuracy", accuracy, above=0.0)


def _failure(result: Plan, along_path: bool) -> PlanningError:
    message = result._value.message
    if result.status != "infeasible":
        return PlanningError(message, result)
    return Infeasible(message, result, {"duration_s": "time_s"} if along_path else {})


def profile(robot: Robot, xy: ArrayLike | Path, *, payload_kg: float = 0.0, time_s: float | None = None,
            speed_caps: ArrayLike = (), solver: str = "ipopt", nodes: int = 200, accuracy: float = 1e-4) -> Profile:
    """The speed profile of least energy along a path, from rest to rest, within every limit of the robot.

    ``xy``: waypoints, shape (N, 2) in m, or a Path. ``payload_kg``: at most what the robot may carry. ``time_s``: duration;
    None is that of least energy. ``speed_caps``: limits along the path, shape (N, 3), from (m), to (m), speed (m/s).
    ``solver``: ``ipopt`` (reference) or ``fast``. ``nodes``: of the grid, 10 to 20000.
    ``accuracy``: relative, of the energy. Waypoints that look like cm or mm are a UserWarning. The GIL is released meanwhile.
    Raises Infeasible, PlanningError, ConfigError.
    """
    if not (type(robot) is Robot and type(xy) is Path and type(payload_kg) is float and 0.0 <= payload_kg < math.inf
            and (time_s is None or type(time_s) is float and 0.0 < time_s < math.inf)
            and type(solver) is str and solver in SOLVERS and type(nodes) is int and 10 <= nodes <= 20000
            and type(accuracy) is float and 0.0 < accuracy < math.inf):  # else no call and no conversion is needed
        robot, xy = robot_of(robot), xy if isinstance(xy, Path) else Path(xy)
        payload_kg = number("payload_kg", payload_kg, least=0.0)
        time_s = None if time_s is None else number("time_s", time_s, above=0.0)
        solver, nodes, accuracy = _solver_options(solver, nodes, accuracy)
    result = Profile.__new__(Profile)  # before the solver fills the caches with its own data
    result._value, driven = _core.profile(robot._value, xy._value, payload_kg, time_s,
                                          caps("speed_caps", speed_caps), solver, nodes, accuracy)
    if not driven:
        raise _failure(result, along_path=True)
    return result


def plan(mission: str | os.PathLike[str] | Mapping[str, Any], *, robot: Robot | str | os.PathLike[str] | None = None,
         map: str | os.PathLike[str] | None = None, payload_kg: float | None = None, time_s: float | None = None,
         solver: str = "ipopt", nodes: int = 200, seed: int = 1, accuracy: float = 1e-4,
         baselines: bool = True, progress: Progress = None) -> Plan:
    """Plans a mission for the least energy, as ``joulepath plan`` does.

    ``mission``: a file (mission, VDA 5050 order, path), or a dict with the keys of a mission file, whose file names
    are relative to the working directory and whose ``robot`` may be a Robot. ``robot`` and ``map`` replace the
    mission's; ``payload_kg`` and ``time_s`` are for a path. ``solver``, ``nodes`` and ``accuracy`` as of ``profile``;
    ``seed``: of the search for a path; ``baselines``: whether classic profiles are planned for comparison.
    ``progress(done, total)`` is called after each step (of a leg: way, profile, comparison, bound); an error of it ends the
    call. The GIL is released meanwhile. Raises Infeasible, PlanningError, ConfigError.

    >>> route = [[0, 0], [1, 0], [1, 0], [1, 1]]
    >>> drive = plan({"robot": Robot.example(), "legs": [{"path": {"bezier_m": [route]}, "payload_kg": 5}]}, solver="fast")
    >>> drive.status, len(drive.legs), drive.legs[0].payload_kg
    ('optimal', 1, 5.0)
    """
    solver, nodes, accuracy = _solver_options(solver, nodes, accuracy)
    options = (solver, nodes, whole("seed", seed, 0, 2**32 - 1), accuracy, bool(baselines), called(progress))
    if isinstance(mission, Mapping):
        if payload_kg is not None or time_s is not None:
            raise refused("payload_kg" if payload_kg is not None else "time_s", "a value together with a mission",
                          "a value only together with a path", "legs of a mission have their own")
        values = dict(mission)
        if isinstance(values.get("robot"), Robot) and robot is None:
            robot = values["robot"]
        if robot is not None:
            values["robot"] = "robot"  # not read: the value takes its place
        if map is not None:
            values["map"] = file_name("map", map)
        at_hand = None if robot is None else robot_of(robot)._value
        result = Plan(_core.plan_text(text_of("mission", values), "mission", at_hand, *options))
    else:
        name = file_name("robot", robot) if isinstance(robot, (str, os.PathLike)) else ""
        value = None if robot is None or name else robot_of(robot)._value
        result = Plan(_core.plan_file(
            file_name("mission", mission), name, value, "" if map is None else file_name("map", map),
            None if payload_kg is None else number("payload_kg", payload_kg, least=0.0),
            None if time_s is None else number("time_s", time_s, above=0.0), *options))
    if not result._driven:
        raise _failure(result, along_path=time_s is not None)
    return result
