"""On the robot: a planned piece planned again from any state on it, and a follower that turns it into commands.

The path coordinate ``s`` is the arc length (m) along a curve, the angle (rad) of a turn in place; ``rate`` is its
change per second. One Replanner or Follower serves one piece, in one thread.
"""

from __future__ import annotations

import math
from typing import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._errors import refused
from ._inputs import caps, number, numbers, whole
from ._values import Value
from .pieces import Drive, given_drive, on_board_kg

Command = _core.FollowCommand


class Replan(Value):
    """A profile from a situation on: ``t`` (s, from 0), ``s`` (from the situation's place on) and ``rate`` at its nodes.

    Between nodes the acceleration is constant. ``status``: ``optimal`` (on the grid, to 1e-6), ``feasible`` (the budget
    ended), ``late`` (``late_s`` after the deadline, the fastest) or ``stopping`` (``limit`` says what prevents a profile).
    """

    __slots__ = ("_value",)

    def __init__(self, value: _core.ReplanValue) -> None:
        self._value = value

    @property
    def status(self) -> str:
        """``optimal``, ``feasible``, ``late`` or ``stopping``."""
        return self._value.status

    @property
    def t(self) -> NDArray[np.float64]:
        """Times of the nodes, s, shape (N,)."""
        return self._value.t

    @property
    def s(self) -> NDArray[np.float64]:
        """Path coordinates of the nodes, m or rad, shape (N,); the first is the situation's place."""
        return self._value.s

    @property
    def rate(self) -> NDArray[np.float64]:
        """Change of the path coordinate per second at the nodes, m/s or rad/s, shape (N,)."""
        return self._value.rate

    @property
    def duration_s(self) -> float:
        """Until the end of the piece."""
        return self._value.duration_s

    @property
    def energy_J(self) -> float:
        """Energy at the battery's terminals, standby included, as the grid counts it."""
        return self._value.energy_J

    @property
    def gap_percent(self) -> float:
        """Bound of the distance from the least energy on the grid; not a number if unknown."""
        return self._value.gap_percent

    @property
    def price_of_time_W(self) -> float:
        """Energy that a later deadline saves per second."""
        return self._value.price_of_time_W

    @property
    def late_s(self) -> float:
        """After the deadline."""
        return self._value.late_s

    @property
    def above_cap_until(self) -> float:
        """The robot is faster than a speed limit here: braking ends at this path coordinate."""
        return self._value.above_cap_until

    @property
    def overrun(self) -> float:
        """Beyond ``stop_at`` or the end, where the robot cannot stop before."""
        return self._value.overrun

    @property
    def limit(self) -> str:
        """What prevents a profile, of ``stopping``."""
        return self._value.limit

    @property
    def iterations(self) -> int:
        """Of the solver."""
        return self._value.iterations

    def __repr__(self) -> str:
        return f"Replan({self.status}, {self.energy_J:.6g} J, {self.duration_s:.6g} s)"


class Replanner:
    """Plans the rest of a piece from any state on it, in about a millisecond. A jerk limit is not kept.

    ``drive``: one of ``drives(plan)``. ``nodes``: of the grid, 10 to 20000. Raises ConfigError.

    >>> import joulepath as jp
    >>> piece, = jp.drives(jp.profile(jp.Robot.example(), [[0, 0], [2, 0]]))
    >>> rest = Replanner(piece).replan(0.5, 0.4, time_left_s=5.0)
    >>> rest.status, rest.duration_s < 5, float(rest.s[0]), round(float(rest.s[-1]), 9)
    ('optimal', True, 0.5, 2.0)
    """

    __slots__ = ("_drive", "_value")

    def __init__(self, drive: Drive, *, nodes: int = 200) -> None:
        self._drive = given_drive(drive)
        self._value = _core.Replanner(drive._value, whole("nodes", nodes, 10, 20000))

    def replan(self, s: float, rate: float, *, payload_kg: float | None = None, time_left_s: float | None = None,
               speed_caps: ArrayLike = (), stop_at: float | None = None, iterations: int = 60,
               cpu_s: float | None = None) -> Replan:
        """The profile of least energy from the path coordinate ``s`` at ``rate`` to the end of the piece, at rest, in time.

        ``payload_kg``: on board now, at most what the robot may carry (None: as planned). ``time_left_s``: to the deadline
        (None: free).
        ``speed_caps``: shape (N, 3), from (m), to (m), speed (m/s). ``stop_at``: the path is blocked from there on.
        ``iterations`` and ``cpu_s`` bound the work; the GIL is released meanwhile. Raises ConfigError.
        """
        return Replan(self._value.replan(
            number("s", s, least=0.0, most=self._drive.length), number("rate", rate, least=0.0),
            on_board_kg(self._drive, payload_kg), math.inf if time_left_s is None else number("time_left_s", time_left_s),
            caps("speed_caps", speed_caps),
            math.inf if stop_at is None else number("stop_at", stop_at), whole("iterations", iterations, 1, 10000),
            math.inf if cpu_s is None else number("cpu_s", cpu_s, above=0.0)))


class Follower:
    """Turns a piece of a plan into speeds, from the robot's pose, ``period_s`` apart; see docs/on_the_robot.md.

    A command holds from ``latency_s`` after its pose on. ``deadline_s``: of the piece's end, from its start (None: as
    planned). A pose farther than ``off_path_m`` or ``off_path_rad`` from the path is handed over: ``off_path``.
    Raises ConfigError.

    >>> import joulepath as jp
    >>> piece, = jp.drives(jp.profile(jp.Robot.example(), [[0, 0], [2, 0]], time_s=6))
    >>> command = Follower(piece).command(0.0, piece.pose(0.0), 0.0, 0.0)
    >>> command.state, command.acceleration_m_s2 > 0
    ('driving', True)
    """

    __slots__ = ("_drive", "_value")

    def __init__(self, drive: Drive, *, deadline_s: float | None = None, period_s: float = 0.05, latency_s: float = 0.05,
                 off_path_m: float = 0.3, off_path_rad: float = 0.8) -> None:
        self._drive = given_drive(drive)
        due_s = drive.end_s - drive.start_s if deadline_s is None else number("deadline_s", deadline_s, above=0.0)
        self._value = _core.Follower(
            drive._value, due_s, number("period_s", period_s, least=0.001, most=1.0),
            number("latency_s", latency_s, least=0.0, most=1.0), number("off_path_m", off_path_m, above=0.0),
            number("off_path_rad", off_path_rad, above=0.0, most=math.pi))

    def command(self, time_s: float, pose: Sequence[float], speed_m_s: float, yaw_rate_rad_s: float, *,
                payload_kg: float | None = None, speed_limit_m_s: float | None = None,
                stop_at_m: float | None = None) -> Command:
        """The command for a pose (x in m, y in m, heading in rad) and the speeds that are measured with it.

        ``time_s``: since the piece's start was due. ``payload_kg``: on board now, at most what the robot may carry (None: as
        planned). ``speed_limit_m_s``: for the rest of the piece. ``stop_at_m``: the path
        is blocked from this coordinate on. Raises ConfigError.
        """
        at = numbers("pose", pose)
        if len(at) != 3:
            raise refused("pose", f"{len(at)} numbers", "x (m), y (m) and heading (rad)")
        return self._value.command(
            number("time_s", time_s), [float(x) for x in at], number("speed_m_s", speed_m_s),
            number("yaw_rate_rad_s", yaw_rate_rad_s),
            on_board_kg(self._drive, payload_kg), None if speed_limit_m_s is None else number("speed_limit_m_s", speed_limit_m_s, least=0.0),
            None if stop_at_m is None else number("stop_at_m", stop_at_m))
