"""Exceptions of the package."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Callable, Iterator, Mapping

if TYPE_CHECKING:
    from .plans import Plan


class ConfigError(ValueError):
    """An invalid input: a file, a dict or an argument.

    ``file``, ``line`` and ``column`` (from 1) say where it stands, None where there is no such place; ``key`` is
    dotted as in the file (``motor.gear_ratio``) or the argument's name; ``found``, ``accepted`` and ``hint`` are
    the parts of the message.
    """

    def __init__(self, message: str, file: str = "", line: int | None = None, column: int | None = None, key: str = "",
                 found: str = "", accepted: str = "", hint: str = "") -> None:
        super().__init__(message)
        self.file = file or None
        self.line = line
        self.column = column
        self.key = key
        self.found = found
        self.accepted = accepted
        self.hint = hint

    def __reduce__(self) -> tuple[object, ...]:
        return (ConfigError, (str(self), self.file or "", self.line, self.column, self.key, self.found, self.accepted,
                              self.hint))


def refused(key: str, found: str, accepted: str, hint: str = "") -> ConfigError:
    """The error of an argument, in the form of the errors of files."""
    message = f"{key}: found {found}, accepted: {accepted}" + (f" ({hint})" if hint else "")
    return ConfigError(message, key=key, found=found, accepted=accepted, hint=hint)


@contextlib.contextmanager
def named_by(place: Callable[[str, str], str | None]) -> Iterator[None]:
    """Errors of texts and frames that were made from arguments name the argument.

    ``place(file, key)``: the argument, None where the error is that of a file.
    """
    try:
        yield
    except ConfigError as error:
        argument = place(error.file or "", error.key)
        if argument is None:
            raise
        raise refused(argument, error.found, error.accepted, error.hint) from None


class PlanningError(RuntimeError):
    """The solver failed. ``plan`` is the incomplete plan (None in another process than the planning
    one, and of a command)."""

    def __init__(self, message: str, plan: Plan | None) -> None:
        super().__init__(message)
        self.plan: Plan | None = plan

    def __reduce__(self) -> tuple[object, ...]:
        return (_again, (type(self), str(self), {**self.__dict__, "plan": None}))


def _again(kind: type[PlanningError], message: str, values: dict[str, object]) -> PlanningError:
    error = kind.__new__(kind, message)
    error.__dict__.update(values)
    return error


class Infeasible(PlanningError):
    """No plan keeps every limit.

    ``limit`` is the limit that prevents it (a key of ``limits`` without its unit, or ``deadline``, ``path`` ...),
    ``amount`` and ``unit`` by how much, ``place`` where (``leg``, ``arc_length_m``, ``x_m``, ``y_m``), and
    ``relaxation`` the smallest change found that makes it possible, by its key or argument (``time_s``).
    """

    def __init__(self, message: str, plan: Plan, arguments: Mapping[str, str] = {}) -> None:
        for key, argument in arguments.items():
            message = message.replace(key, argument)
        super().__init__(message, plan)
        reason = plan.json.infeasibility
        self.limit: str = reason.constraint
        self.amount: float = reason.amount
        self.unit: str = reason.unit
        self.place: Mapping[str, float] = {key: reason[key] for key in ("leg", "arc_length_m", "x_m", "y_m")}
        self.relaxation: Mapping[str, float] = {arguments.get(key, key): value for key, value in reason.relaxation.items()}
