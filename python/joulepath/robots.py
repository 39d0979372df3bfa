"""The robot: one frozen value with every key of a robot file."""

from __future__ import annotations

import os
from pathlib import Path as FilePath
from typing import Any, Mapping

from . import _core
from ._errors import refused
from ._inputs import encodable, file_name, text_of
from ._records import Record


class Robot:
    """A differential-drive robot with all values of its file. It is read-only; ``replace`` makes a changed copy.

    Every section of the schema (``joulepath schema robot``) is an attribute.

    >>> robot = Robot.example()
    >>> robot.motor.gear_ratio
    24.9
    >>> geared = robot.replace(motor={"gear_ratio": 32})
    >>> geared.motor.gear_ratio, robot.motor.gear_ratio
    (32, 24.9)
    >>> geared == robot
    False
    """

    __slots__ = ("_text", "_value", "_values")
    _text: str
    _value: _core.RobotValue
    _values: Record

    def __init__(self, values: Mapping[str, Any]) -> None:
        """A robot of a dict with the keys of a robot file. Raises ConfigError."""
        if not isinstance(values, Mapping):
            raise refused("robot", f"a value of type {type(values).__name__}", "a dict with the keys of a robot file")
        self._set(_core.robot_of_object(text_of("robot", dict(values))))

    def _set(self, value: _core.RobotValue) -> None:
        object.__setattr__(self, "_value", value)
        object.__setattr__(self, "_text", value.text())
        values: Any = _core.parse_document(self._text, "robot")
        object.__setattr__(self, "_values", Record(values))

    @classmethod
    def _of(cls, value: _core.RobotValue) -> Robot:
        robot = cls.__new__(cls)
        robot._set(value)
        return robot

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> Robot:
        """The robot of a file (YAML or JSON). Raises ConfigError with file, line and key."""
        return cls._of(_core.load_robot(file_name("robot", file)))

    @classmethod
    def parse(cls, text: str, name: str = "robot.yaml") -> Robot:
        """The robot of a file's text; ``name`` appears in error messages. Raises ConfigError with line and key."""
        for key, value in (("text", text), ("name", name)):
            if not isinstance(value, str):
                raise refused(key, f"a value of type {type(value).__name__}", "a text")
        return cls._of(_core.parse_robot(encodable("text", text), encodable("name", name)))

    @classmethod
    def example(cls) -> Robot:
        """The 24 kg laboratory robot that ``joulepath init`` writes."""
        return cls.parse(_core.starter_robot())

    def replace(self, **sections: Any) -> Robot:
        """The same robot with other values.

        A dict replaces the keys that it names and keeps the others; None removes a key or a section; any other
        value (a list of effects, a number) replaces what is there. Raises ConfigError.

        >>> Robot.example().replace(limits={"speed_m_s": 0.5, "max_payload_kg": None}).limits.speed_m_s
        0.5
        """
        return Robot(_merged(self.to_dict(), sections))

    def to_dict(self) -> dict[str, Any]:
        """All keys and values, as the robot's file has them."""
        return self._values.to_dict()

    def text(self) -> str:
        """The robot as a file (YAML) that reads back as the same robot, numbers to the last bit."""
        return self._text

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the robot file."""
        FilePath(file).write_text(self._text, encoding="utf-8", newline="")

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        return getattr(self._values, key)

    def __setattr__(self, key: str, value: object) -> None:
        raise AttributeError("a robot is read-only; replace() makes a changed copy")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._values]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Robot) and self._text == other._text

    def __hash__(self) -> int:
        return hash(self._text)

    def __repr__(self) -> str:
        return f"Robot({self._value.name!r})"

    def __reduce__(self) -> tuple[object, ...]:
        return (Robot.parse, (self._text,))


def _merged(old: Mapping[str, Any], new: Mapping[str, Any]) -> dict[str, Any]:
    result = dict(old)
    for key, value in new.items():
        if value is None:
            result.pop(key, None)
        elif isinstance(value, Mapping) and isinstance(result.get(key), Mapping):
            result[key] = _merged(result[key], value)
        else:
            result[key] = value
    return result


def robot_of(value: Robot | str | os.PathLike[str] | Mapping[str, Any]) -> Robot:
    """A robot, or the robot of a file's name or of a dict."""
    if isinstance(value, Robot):
        return value
    return Robot(value) if isinstance(value, Mapping) else Robot.load(value)
