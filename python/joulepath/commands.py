"""Commands of the program as functions: each runs in a process of its own and gives the program's own bytes."""

from __future__ import annotations

import csv
import io
import json
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, Mapping, Union

import numpy as np
from numpy.typing import NDArray

from ._errors import ConfigError, PlanningError, refused
from ._files import save
from ._frames import columns_of, is_frame
from ._inputs import Progress, called, encodable, file_name, text_of
from ._plots import of_answer
from ._records import viewed
from .plans import Plan
from .robots import Robot

#: A file, a dict with a file's keys, or a robot.
Source = Union[str, "os.PathLike[str]", Mapping[str, Any], Robot]
#: The process of a command: FILE_DESCRIPTOR WORDS...
_PROGRAM = "import sys, joulepath._core as c; sys.exit(c.program_main(['joulepath', *sys.argv[2:]], int(sys.argv[1])))"
#: Exit codes that are an answer where the program printed one, beside 0.
_ANSWERS = {"check": (1, 2), "drift": (1, 2), "batch": (1,), "monitor": (1,)}


@dataclass(frozen=True, eq=False)
class Answer:
    """What a command answers. ``text``: its JSON as printed; ``code``: its exit code; ``messages``: what it says beside;
    ``files``: what it writes, by name."""

    command: str
    text: str
    code: int
    messages: str
    files: Mapping[str, bytes]

    @property
    def json(self) -> Any:
        """The printed JSON as a Record, or a tuple of them (a list, or one for each line); None where the program
        printed none: ``text`` has its words."""
        try:
            return viewed(json.loads(self.text))
        except json.JSONDecodeError:
            pass
        try:
            return tuple(viewed(json.loads(line)) for line in self.text.splitlines()) or None
        except json.JSONDecodeError:
            return None

    def table(self, name: str) -> dict[str, NDArray[Any]]:
        """Columns of a written CSV file, shape (N,): float64, or text where a cell is neither a number nor empty."""
        if name not in self.files:
            raise refused("name", repr(name), "one of: " + ", ".join(self.files))
        header, *rows = csv.reader(io.StringIO(self.files[name].decode()))
        return {key: _column([row[k] for row in rows]) for k, key in enumerate(header)}

    def plot(self, axes: Any = None) -> Any:
        """A ``front`` or a ``sweep``: energy over duration; a ``compare``: energy by profile; a ``batch``: energy and duration
        by mission, on two axes; a ``calibrate``: the constants' changes. Needs matplotlib. Returns the axes. Raises ConfigError
        for other commands."""
        return of_answer(self, axes)

    def save(self, directory: str | os.PathLike[str], *, force: bool = False) -> FilePath:
        """Writes the command's files. Raises ConfigError where one exists, unless ``force`` is given."""
        return save(directory, self.files, force)


def _column(cells: list[str]) -> NDArray[Any]:
    try:
        return np.array([float(cell or "nan") for cell in cells])
    except ValueError:
        return np.array(cells)


def _input(name: str, value: Any, folder: FilePath) -> str:
    """The file of an argument; a value is written into the folder."""
    if isinstance(value, Robot):
        value.save(folder / f"{name}.yaml")
        return str(folder / f"{name}.yaml")
    if isinstance(value, Plan) and name == "plan":
        return str(value.save(folder / name))
    if is_frame(value) and any(str(key) == "time_s" for key in getattr(value, "columns", value)):
        columns = columns_of(name, value, frozenset(str(key) for key in getattr(value, "columns", value)))
        rows = zip(*([("" if np.isnan(x) else repr(float(x))) for x in column] for column in columns.values()))
        with open(folder / f"{name}.csv", "w", encoding="utf-8", newline="") as file:
            csv.writer(file).writerows([list(columns), *rows])
        return str(folder / f"{name}.csv")
    if isinstance(value, Mapping):
        (folder / f"{name}.yaml").write_text(text_of(name, _absolute(value, folder)), encoding="utf-8")
        return str(folder / f"{name}.yaml")
    if isinstance(value, (list, tuple)):
        lines = "".join(text_of(f"{name}[{k}]", _absolute(item, folder)) + "\n" for k, item in enumerate(value))
        (folder / f"{name}.jsonl").write_text(lines, encoding="utf-8")
        return str(folder / f"{name}.jsonl")
    return file_name(name, value)


def _absolute(value: Any, folder: FilePath, key: str = "") -> Any:
    """Names of files in a dict count from the working directory."""
    if isinstance(value, Robot):
        return _input("robot_of_dict", value, folder)
    if isinstance(value, Mapping):
        return {name: _absolute(item, folder, name) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_absolute(item, folder, key) for item in value]
    return os.path.abspath(value) if key in ("robot", "map", "file", "missions") and isinstance(value, (str, os.PathLike)) else value


def _words(options: Mapping[str, Any], folder: FilePath) -> list[str]:
    words: list[str] = []
    for key, value in options.items():
        flag = "--" + key.replace("_", "-")
        if key in ("out", "json", "force", "quiet", "help"):
            raise refused(key, "an option of the command line", "options that change the answer", "save() writes the files")
        if value is True:
            words.append(flag)
        elif value is not None and value is not False:
            # One word: an unknown option is named as such, and its value is no further file.
            words.append(f"{flag}={_input(key, value, folder) if key == 'robot' else encodable(key, str(value))}")
    return words


def _failure(code: int, told: str) -> Exception:
    message = re.sub(r"\Ajoulepath: ", "", told.strip())
    if code == 1:
        return PlanningError(message, None)
    if code != 2:
        return RuntimeError(message or f"the program ended with {code}")
    found = re.search(r"^(?:(.+?):(\d+):(\d+): )?(.+?): found (.*), accepted: (.*?)(?: \((.*)\))?$", message, re.MULTILINE)
    if not found:
        return ConfigError(message)
    file, line, column, key, what, accepted, hint = found.groups()
    return ConfigError(message, file or "", int(line) if line else None, int(column) if column else None, key, what, accepted,
                       hint or "")


def _told(words: list[str], folder: FilePath, progress: Progress) -> tuple[int, str, str]:
    """Exit code of the program, and what it prints and says beside."""
    printed, said = folder / "printed", folder / "said"
    begin, end = os.pipe()
    with os.fdopen(begin) as steps, open(printed, "wb") as out, open(said, "wb") as beside:
        try:
            process = subprocess.Popen([sys.executable, "-c", _PROGRAM, str(end), *words], stdin=subprocess.DEVNULL, stdout=out,
                                       stderr=beside, pass_fds=[end])
        finally:
            os.close(end)
        with process:
            try:
                for line in steps:
                    if progress:
                        progress(*map(int, line.split()))
            except BaseException:
                process.kill()
                raise
    texts = [file.read_text(encoding="utf-8", errors="replace") for file in (printed, said)]
    return process.returncode, texts[0], texts[1]


def _run(command: str, inputs: Mapping[str, Any], options: Mapping[str, Any], out: str = "", json_too: bool = True,
         progress: Progress = None) -> Answer:
    called(progress)
    with tempfile.TemporaryDirectory(prefix="joulepath-") as made:
        folder, target = FilePath(made), FilePath(made) / "out"
        target.mkdir()
        files = [_input(name, value, folder) for name, value in inputs.items()]
        place = [] if not out else ["--out", str(target / out) if out != "." else str(target)]
        words = [command, *_words(options, folder), *place, *(["--json"] if json_too else []), "--", *files]
        code, *told = _told(words, folder, progress)
        text, messages = (part.replace(f"{made}/", "") for part in told)
        if code and not (code in _ANSWERS.get(command, ()) and text.strip()):
            raise _failure(code, messages)
        written = {str(file.relative_to(target)): _bytes(file, made) for file in sorted(target.rglob("*")) if file.is_file()}
    return Answer(command, text, code, messages, written)


def _bytes(file: FilePath, folder: str) -> bytes:
    """Content without the temporary folder's name, where it is text."""
    content = file.read_bytes()
    return content.replace(f"{folder}/".encode(), b"") if file.suffix in (".json", ".jsonl", ".html", ".csv", ".yaml") else content


def check(*files: Source, progress: Progress = None, **options: Any) -> Answer:
    """Validates inputs, as ``joulepath check``: ``json`` has ``ok`` and ``error``, or ``notes`` of each;
    of a dataset that needs repairs ``ok`` is False and ``data_checks`` has them.
    ``progress(done, total)`` is called after each file. Raises ConfigError for options that it does not have."""
    return _run("check", {f"files_{k}": file for k, file in enumerate(files)}, options, progress=progress)


def compare(mission: Source, *, progress: Progress = None, **options: Any) -> Answer:
    """A plan beside the classic profiles, as ``joulepath compare``. Options: the command's. ``progress(done, total)``
    is called after each step. Raises ConfigError, PlanningError."""
    return _run("compare", {"mission": mission}, options, ".", progress=progress)


def front(mission: Source, *, progress: Progress = None, **options: Any) -> Answer:
    """Least energy for each duration, as ``joulepath front``. Options: the command's. ``progress(done, total)`` is
    called after each step and point. Raises ConfigError, PlanningError."""
    return _run("front", {"mission": mission}, options, ".", progress=progress)


def estimate(log: Source | Any, **options: Any) -> Answer:
    """Energy of logged motions, as ``joulepath estimate``; ``log``: a file or a frame. Raises ConfigError."""
    return _run("estimate", {"log": log}, options, ".")


def export(mission: Source | Any, to: str, name: str = "export.json", **options: Any) -> Answer:
    """A plan, log or robot in another format, as ``joulepath export``; ``files`` has it by ``name``. Raises ConfigError,
    PlanningError."""
    if FilePath(name).name != name:
        raise refused("name", repr(name), "a file's name without a directory")
    return _run("export", {"mission": mission}, {"to": to, **options}, name)


def batch(missions: Source | list[Mapping[str, Any]], *, progress: Progress = None, **options: Any) -> Answer:
    """Many missions, as ``joulepath batch``: a directory, a file or a list of dicts. ``json`` has each one's outcome;
    ``code`` is 1 where some cannot be read. ``progress(done, total)`` is called after each mission. Raises
    ConfigError."""
    return _run("batch", {"missions": missions}, options, ".", progress=progress)


def sweep(study: Source, *, progress: Progress = None, **options: Any) -> Answer:
    """Many designs of a robot, as ``joulepath sweep``; ``table("sweep.csv")`` has a row for each.
    ``progress(done, total)`` is called after each plan. Raises ConfigError."""
    return _run("sweep", {"study": study}, options, ".", progress=progress)


def calibrate(dataset: Source, *, progress: Progress = None, **options: Any) -> Answer:
    """Constants fitted to runs, as ``joulepath calibrate``; ``files["robot.yaml"]`` is the fitted robot.
    ``progress(done, total)`` is called after each log and fit. Raises ConfigError."""
    return _run("calibrate", {"dataset": dataset}, options, "robot.yaml", progress=progress)


def experiment(dataset: Source, *, progress: Progress = None, **options: Any) -> Answer:
    """The run that best separates the candidates of a diagnosis, as ``joulepath experiment``:
    ``files["mission.yaml"]``, none where nothing is left to separate (``text`` says so, and ``json`` is None).
    ``progress(done, total)`` is called after each log and step. Raises ConfigError."""
    return _run("experiment", {"dataset": dataset}, options, "mission.yaml", json_too=False, progress=progress)


def drift(*days: Source | Any, progress: Progress = None, **options: Any) -> Answer:
    """Constants that changed since the first day, as ``joulepath drift``: ``code`` is 0 without drift, 1 with it, 2
    where runs cannot tell. ``progress(done, total)`` is called after each log and fit. Raises ConfigError."""
    return _run("drift", {f"days_{k}": day for k, day in enumerate(days)}, options, progress=progress)


def monitor(plan: Plan | str | os.PathLike[str], log: Source | Any, robot: Source | None = None, **options: Any) -> Answer:
    """A drive beside its plan, as ``joulepath monitor``; ``plan``: a Plan, or the directory of one, which needs the ``robot``.
    ``json``: a tuple of events; ``code`` is 1 after an alarm. Raises ConfigError."""
    if robot is None:
        if not isinstance(plan, Plan):
            raise refused("robot", "None", "the robot of the plan in this directory")
        robot = plan.robot
    return _run("monitor", {"plan": plan, "log": log}, {"robot": robot, **options})
