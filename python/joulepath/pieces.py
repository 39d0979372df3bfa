"""Pieces of a plan that are driven without a stop.

The path coordinate ``s`` is the arc length (m) along a curve, the angle (rad) of a turn in place.
"""

from __future__ import annotations

import os

from . import _core
from ._errors import refused
from ._inputs import file_name, number
from ._values import Value
from .plans import Plan
from .robots import Robot, robot_of


class Drive(Value):
    """A piece of a plan that is driven without a stop; ``start_s`` and ``end_s`` are in the plan's time."""

    __slots__ = ("_value",)

    def __init__(self, value: _core.PlannedDrive) -> None:
        self._value = value

    @property
    def start_s(self) -> float:
        """When the piece begins."""
        return self._value.start_s

    @property
    def end_s(self) -> float:
        """When its end is due."""
        return self._value.end_s

    @property
    def leg(self) -> int:
        """Number of the leg, from 0."""
        return self._value.leg

    @property
    def is_turn(self) -> bool:
        """A turn in place."""
        return self._value.is_turn

    @property
    def length(self) -> float:
        """Of the path coordinate: m, or rad of a turn in place."""
        return self._value.length

    @property
    def payload_kg(self) -> float:
        """On board at the start, as planned."""
        return self._value.payload_kg

    def pose(self, s: float) -> tuple[float, float, float]:
        """x (m), y (m) and heading (rad) at a path coordinate."""
        x, y, heading = self._value.pose(number("s", s, least=0.0, most=self.length))
        return (x, y, heading)

    def __repr__(self) -> str:
        what = f"turn of {self.length:.4g} rad" if self.is_turn else f"curve of {self.length:.4g} m"
        return f"Drive(leg {self.leg}, {what}, {self.start_s:.4g} to {self.end_s:.4g} s)"


def drives(plan: Plan | str | os.PathLike[str], robot: Robot | None = None) -> tuple[Drive, ...]:
    """The pieces of a plan that are driven without a stop, in order.

    ``plan``: a Plan, or the directory of one; a directory needs the ``robot``. Raises ConfigError.

    >>> import joulepath as jp
    >>> drives(jp.profile(jp.Robot.example(), [[0, 0], [2, 0]], time_s=6))
    (Drive(leg 0, curve of 2 m, 0 to 6 s),)
    """
    if isinstance(plan, Plan):
        planned_for = robot_of(plan.robot if robot is None else robot)
        found = _core.drives_of(plan.trajectory._value, planned_for._value)
    else:
        if robot is None:
            raise refused("robot", "None", "the robot of the plan in this directory")
        found = _core.drives_in(file_name("plan", plan), robot_of(robot)._value)
    return tuple(Drive(value) for value in found)


def given_drive(drive: Drive) -> Drive:
    """The argument, if it is a piece of a plan."""
    if not isinstance(drive, Drive):
        raise refused("drive", f"a value of type {type(drive).__name__}", "one of drives(plan)")
    return drive


def on_board_kg(drive: Drive, payload_kg: float | None) -> float:
    """The payload, within what the robot may carry; None is the planned one."""
    if payload_kg is None:
        return drive.payload_kg
    most_kg = drive._value.max_payload_kg
    given_kg = number("payload_kg", payload_kg, least=0.0)
    if given_kg > most_kg:
        raise refused("payload_kg", f"{given_kg:g}", f"at most {most_kg:g}, limits.max_payload_kg of the robot")
    return given_kg
