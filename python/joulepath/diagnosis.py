"""Diagnosis of the difference between the energy of a robot and the prediction of its model."""

from __future__ import annotations

import functools
import json
import os
import re
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, Iterable, Mapping, Sequence, Union, overload

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._errors import named_by, refused
from ._files import save
from ._frames import columns_of, is_frame, names_read
from ._inputs import Progress, called, encodable, file_name, text_of
from ._plots import bars
from ._records import Record
from ._values import Value
from .robots import Robot, robot_of

#: A file, or columns by name: a pandas.DataFrame, a Log, a dict of arrays.
LogLike = Union[str, "os.PathLike[str]", Mapping[str, Any], Any]
RobotLike = Union[Robot, str, "os.PathLike[str]", Mapping[str, Any]]


@dataclass(frozen=True, eq=False)
class Run:
    """One log with its circumstances; the keys are those of ``runs:`` in a dataset file.

    ``payload_kg`` is a number, or steps ``[{"from_s": 0, "kg": 5}, ...]``; None: the log's column, or 0. ``start_time_s``:
    time of day of its start. ``use``: ``any``, ``diagnosis`` or ``validation``. ``name``: in the answer, for a log in memory.
    """

    log: LogLike
    payload_kg: float | Sequence[Mapping[str, float]] | None = None
    start_time_s: float | None = None
    surface: str | None = None
    use: str | None = None
    name: str | None = None


class Diagnosis(Value):
    """The result of ``diagnose``. ``json`` holds all of diagnosis.json."""

    def __init__(self, value: _core.DiagnosisValue) -> None:
        self._value = value

    @functools.cached_property
    def json(self) -> Record:
        """diagnosis.json (schema joulepath/diagnosis/1)."""
        return Record(json.loads(self._value.json))

    @property
    def verdict(self) -> str:
        """no_gap, explained, partly_explained, unexplained, ambiguous, too_little_data or
        data_suspect."""
        return str(self.json.verdict)

    @property
    def causes(self) -> tuple[Record, ...]:
        """Effects of the catalog that explain the gap, with parameters and their intervals."""
        return tuple(self.json.causes)

    @property
    def where(self) -> tuple[Record, ...]:
        """Shares of the gap by phase, wheel, part of the path, payload ..."""
        return tuple(self.json.where)

    @property
    def data_checks(self) -> tuple[Record, ...]:
        """Channels that contradict physics, as a clock in ms, with the evidence and the entry of ``columns`` that repairs
        them; ``joulepath check`` tells the same. With any of them the verdict is data_suspect."""
        return tuple(self.json.get("data_checks", ()))

    @property
    def artifacts(self) -> tuple[str, ...]:
        """Properties of the logs that are not physics, and what was made of them: derived, missing and held values, ignored
        columns, jumps of the clock.

        >>> diagnose(Robot.example(), [{"time_s": [0.1 * k for k in range(50)], "linear_speed_m_s": [0.01 * k for k in range(50)], "angular_speed_rad_s": [0] * 50}]).artifacts
        ('logs[0]: derived in wheel_speed_left_rad_s, wheel_speed_right_rad_s: from linear and angular speed',)
        """
        return tuple(self.json.artifacts)

    @property
    def missing_channels(self) -> tuple[str, ...]:
        """Channels that not all runs have: motor_current, motor_voltage, battery, pose, gyro, yaw_rate, start_time."""
        return tuple(self.json.missing_channels)

    @property
    def notes(self) -> tuple[str, ...]:
        """What restricts the answer: what the runs cannot show, runs that are left out, a payload that nothing states."""
        return tuple(self.json.notes)

    @functools.cached_property
    def robot(self) -> Robot | None:
        """The corrected robot; None where no correction holds on held-out runs."""
        corrected = self._value.robot()
        return None if corrected is None else Robot._of(corrected)

    def plot(self, axes: Any = None) -> Any:
        """The gap's energy where it lies (``where``); needs matplotlib. Returns the axes."""
        return bars(axes, {f"{cell.axis} {cell.value}": cell.energy_J for cell in self.where}, "gap, J")

    def report(self) -> str:
        """report.html: one self-contained page."""
        return self._value.report()

    def save(self, directory: str | os.PathLike[str], *, force: bool = False) -> FilePath:
        """Writes the same files as ``joulepath diagnose``, byte for byte on the same day.

        Files that exist are overwritten with ``force`` alone, else ConfigError. Returns the directory.
        """
        return save(directory, {"diagnosis.json": self._value.json, "report.html": self.report(),
                                "robot_corrected.yaml": None if self.robot is None else self.robot.text(),
                                "dataset_corrected.yaml": self._value.corrected_dataset(os.fspath(directory))}, force)

    def __repr__(self) -> str:
        causes = ", ".join([*(cause.effect for cause in self.causes), *(f"{c.channel} {c.kind}" for c in self.data_checks)])
        derived = "".join("; " + artifact for artifact in self.artifacts if "derived in " in artifact)
        return f"Diagnosis({self.verdict}{': ' + causes if causes else ''}{derived})"

    def __str__(self) -> str:
        suspects = [f"{c.run}: {c.channel} {c.kind}. {c.evidence}{'' if c.evidence.endswith('?') else '.'} Repair: {c.repair}"
                    for c in self.data_checks]
        told = {"suspect": suspects, "note": self.notes, "artifact": self.artifacts, "missing channel": self.missing_channels}
        return "\n".join([self.json.sentence, *(f"{kind}: {text}" for kind, texts in told.items() for text in texts)])


@overload
def diagnose(robot: RobotLike | None, logs: str | os.PathLike[str] | LogLike | Run | Iterable[LogLike | Run], *, columns: Mapping[str, Any] | None = None,
             without: Iterable[str] = (), progress: Progress = None) -> Diagnosis: ...


@overload
def diagnose(logs: str | os.PathLike[str] | LogLike | Run | Iterable[LogLike | Run], *, robot: RobotLike | None = None, columns: Mapping[str, Any] | None = None,
             without: Iterable[str] = (), progress: Progress = None) -> Diagnosis: ...


def diagnose(*given: Any, robot: Any = None, logs: Any = None, columns: Mapping[str, Any] | None = None,
             without: Iterable[str] = (), progress: Progress = None) -> Diagnosis:
    """Locates the gap between model and logs, names its cause, measures how much a correction shrinks it.

    ``diagnose(robot, logs)`` or ``diagnose(logs, robot=robot)``. ``logs``: a dataset file (YAML), a log, or a list of logs: file
    names, data frames, dicts of arrays, Logs, or a Run of one of them with its circumstances. Columns are those of the run log
    format, in SI units, of one length; NaN and None are missing values. ``columns`` maps other names and units as in a dataset
    file; a bag's other channels are read as ``joulepath check`` proposes them. ``without``: effects taken out of the catalog.
    ``robot`` may be None with a dataset file, which names its own. ``progress(done, total)`` is called after each log of a
    dataset and each step of the diagnosis; an error of it ends the call. Raises ConfigError, for a value that is no number with
    its column and row.

    >>> diagnose(Robot.example(), [{"time_s": [0, 1], "linear_speed_m_s": [0, "fast"], "angular_speed_rad_s": [0, 0]}])
    Traceback (most recent call last):
    joulepath._errors.ConfigError: logs[0].linear_speed_m_s[1]: found 'fast' of type str, accepted: a finite number, or NaN where a value is missing
    """
    if len(given) > 2 or (len(given) == 2 and (robot is not None or logs is not None)):
        raise TypeError("diagnose() takes a robot and logs, each once")
    if len(given) == 2:
        robot, logs = given
    elif given and logs is None:
        logs = given[0]
    elif given:
        robot = given[0]
    called(progress)
    left_out = [without] if isinstance(without, str) else _words("without", without)
    if isinstance(logs, Run) or is_frame(logs) or _is_file(logs, (".csv", ".mcap", ".db3")):
        logs = [logs]
    if isinstance(logs, (str, os.PathLike)):
        value = None if robot is None else robot_of(robot)._value
        return Diagnosis(_core.diagnose_file(file_name("logs", logs), value, left_out, progress))
    if not isinstance(logs, Iterable):
        raise refused("logs", f"a value of type {type(logs).__name__}", "a dataset file, a log, or a list of logs")
    if robot is None:
        raise refused("robot", "None", "a Robot", "only a dataset file names its robot")
    if columns is not None and not isinstance(columns, Mapping):
        raise refused("columns", f"a value of type {type(columns).__name__}", "a dict, as columns: of a dataset file")
    frames: dict[str, dict[str, NDArray[np.float64]]] = {}
    read = names_read(columns or {})
    runs = [_entry(index, log if isinstance(log, Run) else Run(log), frames, read) for index, log in enumerate(logs)]
    dataset: dict[str, Any] = {"runs": runs} if columns is None else {"runs": runs, "columns": dict(columns)}
    places = {run["file"]: f"logs[{index}]" for index, run in enumerate(runs) if run["file"] in frames}
    with named_by(functools.partial(_place, places)):
        return Diagnosis(_core.diagnose_text(text_of("logs", dataset), "logs", robot_of(robot)._value, frames, left_out, progress))


def _place(frames: Mapping[str, str], file: str, key: str) -> str | None:
    """The argument that an error of the dataset or of a frame is about."""
    if file in frames:
        return frames[file] + (f".{key}" if key else "")
    return re.sub(r"[.]file$", "", re.sub(r"^runs\b", "logs", key)) or "logs" if file == "logs" else None


def _is_file(value: Any, ends: tuple[str, ...]) -> bool:
    return isinstance(value, (str, os.PathLike)) and str(os.fspath(value)).endswith(ends)


def _words(name: str, words: Iterable[str]) -> list[str]:
    if isinstance(words, Iterable):
        listed = list(words)
        if all(isinstance(word, str) for word in listed):
            return [encodable(name, word) for word in listed]
    raise refused(name, repr(words), "names of effects")


def _entry(index: int, run: Run, frames: dict[str, dict[str, NDArray[np.float64]]], read: frozenset[str]) -> dict[str, Any]:
    if isinstance(run.log, (str, os.PathLike)):
        name = file_name(f"logs[{index}]", run.log)
    else:
        name = file_name(f"logs[{index}].name", run.name or f"logs[{index}]")
        frames[name] = columns_of(name, run.log, read)
    entry = {"file": name, "payload_kg": run.payload_kg, "start_time_s": run.start_time_s, "surface": run.surface,
             "use": run.use}
    return {key: value for key, value in entry.items() if value is not None}
