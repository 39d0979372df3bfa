"""Samples over time, planned or measured."""

from __future__ import annotations

import os
from pathlib import Path as FilePath
from typing import Any, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._values import Value


class Log(Value, Mapping[str, "NDArray[np.float64]"]):
    """Channels by the names of a run log's columns (``time_s``, ``linear_speed_m_s`` ...), in SI units: read-only views
    of shape (N,), without copies. A name that is not there raises KeyError. Two logs are equal that have the same channels
    with the same numbers.
    """

    __slots__ = ("_columns", "_value")

    def __init__(self, value: _core.Log) -> None:
        self._value = value
        self._columns = value.columns()

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        if name not in self._columns:
            raise KeyError(f"no channel {name!r}; there are: {', '.join(self._columns)}")
        return self._value.column(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Log):
            return NotImplemented
        return self._columns == other._columns and all(np.array_equal(self[name], other[name], equal_nan=True) for name in self)

    def __repr__(self) -> str:
        rows = len(self[self._columns[0]]) if self._columns else 0
        return f"Log({rows} samples of {', '.join(self._columns)})"

    def text(self) -> str:
        """The samples as a run log (CSV), numbers to the last bit."""
        return self._value.text()

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the run log."""
        FilePath(file).write_text(self.text(), encoding="utf-8", newline="")

    def to_frame(self) -> Any:
        """A pandas.DataFrame with one column per channel; needs pandas."""
        import pandas

        return pandas.DataFrame({name: self[name] for name in self})
