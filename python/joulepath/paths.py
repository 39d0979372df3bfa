"""Given paths, without a search."""

from __future__ import annotations

import os
import sys
import warnings

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._errors import refused
from ._inputs import file_name, number, numbers, points
from ._values import Value


FAR_POINTS_M = 200.0  # between neighbors; a path file is doubted from three points on
LONG_PATH_M = 5000.0


def _doubt_units(waypoints: NDArray[np.float64]) -> None:
    """Warns of coordinates in cm or mm: points too far apart, or a path too long, for a building or a yard."""
    apart_m = np.hypot(*np.diff(waypoints, axis=0).T)
    middle_m, total_m = float(np.sort(apart_m)[len(apart_m) // 2]), float(apart_m.sum())
    if middle_m >= FAR_POINTS_M or total_m > LONG_PATH_M:
        told = f"points of the path are {middle_m:.4g} m apart (median)" if middle_m >= FAR_POINTS_M else f"the path has {total_m:.4g} m"
        warnings.warn(f"xy: {told}: are the coordinates in cm, or in mm?", stacklevel=_levels_of_the_package())


def _levels_of_the_package() -> int:
    """The stacklevel of a warning at the caller of the package, raised by the caller of this function."""
    frame, levels = sys._getframe(1), 1
    while frame.f_back is not None and str(frame.f_globals.get("__name__")).startswith(f"{__package__}."):
        frame, levels = frame.f_back, levels + 1
    return levels


class Path(Value):
    """A path on the floor: curves with continuous curvature, and turns in place between them.

    >>> path = Path([[0, 0], [1, 0], [2, 1]])
    >>> 2.4 < path.length_m < 2.5
    True
    """

    __slots__ = ("_value",)

    def __init__(self, xy: ArrayLike, *, corner_radius_m: ArrayLike | None = None) -> None:
        """The natural cubic spline through waypoints, shape (N, 2) in meters.

        With ``corner_radius_m`` (one number, or one per waypoint): straight lines whose corners are rounded with
        that smallest radius; at a radius of 0 the robot turns in place. Points that look like cm
        or mm are a UserWarning. Raises ConfigError.
        """
        waypoints = points("xy", xy)
        radius: NDArray[np.float64] | None = None
        if corner_radius_m is not None:
            radius = (np.full(len(waypoints), number("corner_radius_m", corner_radius_m, least=0.0))
                      if np.ndim(corner_radius_m) == 0 else numbers("corner_radius_m", corner_radius_m))
            if len(radius) != len(waypoints):
                raise refused("corner_radius_m", f"{len(radius)} radii", f"{len(waypoints)}, one per waypoint")
            if (radius < 0).any():
                raise refused("corner_radius_m", f"{radius.min():g}", "numbers >= 0")
        self._value = _core.waypoint_path(waypoints, radius)
        _doubt_units(waypoints)

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> Path:
        """The path of a file: waypoints (CSV) or Bezier curves (YAML). Raises ConfigError.

        What the reader decided, as a stop where the curvature jumps, is a UserWarning.
        """
        path = cls.__new__(cls)
        path._value = _core.load_path(file_name("file", file))
        return path

    @property
    def length_m(self) -> float:
        """Arc length of all curves."""
        return self._value.length_m

    @property
    def turned_rad(self) -> float:
        """Sum of the sizes of all turns in place."""
        return self._value.turned_rad

    def poses(self, step_m: float = 0.05) -> NDArray[np.float64]:
        """Poses along the path, ``step_m`` apart at most, shape (N, 3): x and y in m, heading in rad. Raises ConfigError."""
        log = self._value.poses(number("step_m", step_m, 1e-6 * self.length_m, above=0.0))
        return np.stack([log.column(name) for name in ("position_x_m", "position_y_m", "heading_rad")], axis=1)

    def __repr__(self) -> str:
        return f"Path({self.length_m:.6g} m)"
