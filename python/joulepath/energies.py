"""The energy of any motion, by the model."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._errors import refused
from ._inputs import samples, times
from ._plots import bars
from ._values import Value
from .logs import Log
from .robots import Robot, robot_of


class Energy(Value):
    """Energy of a motion at the battery's terminals."""

    __slots__ = ("_value",)

    def __init__(self, value: _core.EnergyValue) -> None:
        self._value = value

    @property
    def total_J(self) -> float:
        """Energy, standby included."""
        return self._value.total_J

    @property
    def causes_J(self) -> dict[str, float]:
        """Joules by cause; they add up to ``total_J``. An effect of the robot file stands under its name."""
        return self._value.causes_J()

    @property
    def battery_loss_J(self) -> float:
        """Loss in the battery's internal resistance, beside ``total_J``."""
        return self._value.battery_loss_J

    @property
    def distance_m(self) -> float:
        """Distance driven, forward and back."""
        return self._value.distance_m

    @property
    def duration_s(self) -> float:
        """From the first to the last sample."""
        return self._value.duration_s

    @property
    def power(self) -> Log:
        """Wheel speed, torque, current, voltage and power at the samples."""
        return Log(self._value.power())

    def plot(self, axes: Any = None) -> Any:
        """Energy by cause; needs matplotlib. Returns the axes."""
        least_J = 1e-9 * abs(self.total_J)  # less is rounding
        return bars(axes, {cause: joules for cause, joules in self.causes_J.items() if abs(joules) > least_J}, "energy, J")

    def __repr__(self) -> str:
        return f"Energy({self.total_J:.6g} J, {self.distance_m:.6g} m, {self.duration_s:.6g} s)"


LONGEST_START_S = 300.0  # to the greatest speed, at the steepest


def _doubt_times(at: np.ndarray, speed: np.ndarray) -> None:
    """Warns of a clock in ms: a motion that takes minutes to come to speed."""
    steepest, most = np.abs(np.diff(speed) / np.diff(at)).max(), np.abs(speed).max()
    stands = np.abs(speed).min() < 0.1 * most
    if stands and 0 < LONGEST_START_S * steepest < most:
        warnings.warn(f"t: the motion needs {most / steepest:.4g} s to come to {most:.4g} m/s at its steepest; are the times "
                      "in ms?", stacklevel=3)


def energy(robot: Robot, t: ArrayLike, v: ArrayLike, w: ArrayLike = 0.0, *, payload_kg: ArrayLike = 0.0) -> Energy:
    """Energy of a motion: times ``t`` (s), speeds ``v`` (m/s), yaw rates ``w`` (rad/s), ``payload_kg``.

    ``t`` has shape (N,) and increases; the others have shape (N,) or are one number. Speeds are linear between the
    samples. Raises ConfigError.

    >>> e = energy(Robot.example(), t=[0, 1, 2, 3], v=[0, 0.5, 0.5, 0])
    >>> abs(sum(e.causes_J.values()) - e.total_J) < 1e-9
    True
    """
    at = times("t", t)
    if len(at) < 2:
        raise refused("t", f"{len(at)} samples", "2 samples or more")
    most = {unit: _core.greatest_size(unit) for unit in ("speed_m_s", "rate_rad_s", "payload_kg")}
    speed = samples("v", v, len(at), -most["speed_m_s"], most["speed_m_s"])
    _doubt_times(at, speed)
    return Energy(_core.energy(robot_of(robot)._value, at, speed,
                               samples("w", w, len(at), -most["rate_rad_s"], most["rate_rad_s"]),
                               samples("payload_kg", payload_kg, len(at), 0.0, most["payload_kg"])))
