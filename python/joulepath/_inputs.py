"""Conversion of arguments for the compiled module; invalid ones raise an error with their name."""

from __future__ import annotations

import json
import math
import os
from typing import Any, Callable, Mapping, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._errors import ConfigError, refused

#: Called with the numbers of finished and of expected steps.
Progress = Optional[Callable[[int, int], Any]]


def numbers(name: str, value: ArrayLike, ndim: int = 1, least: float = -math.inf, most: float = math.inf) -> NDArray[np.float64]:
    """Finite numbers as a contiguous float64 array; integers and other floats are converted."""
    if np.ma.isMaskedArray(value):
        raise refused(name, "a masked array", "an array without a mask", "drop or fill the masked samples")
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise refused(name, "rows of different lengths", f"an array with {ndim} axes") from error
    if array.dtype.kind not in "fiu":
        raise refused(name, f"values of type {array.dtype}", "real numbers")
    if array.ndim != ndim:
        raise refused(name, f"shape {array.shape}", f"an array with {ndim} {'axis' if ndim == 1 else 'axes'}")
    with np.errstate(over="ignore"):  # of long double
        array = np.ascontiguousarray(array, dtype=np.float64)
    good = np.isfinite(array) & (array >= least) & (array <= most)
    if not good.all():
        index = tuple(int(i) for i in np.argwhere(~good)[0])
        where = "".join(f"[{i}]" for i in index)
        bounded = least > -math.inf or most < math.inf
        raise refused(name + where, f"{array[index]:g}", f"a number from {least:g} to {most:g}" if bounded else "a finite number")
    return array


def points(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """Two points or more as an (N, 2) array."""
    most_m = _core.greatest_size("x_m")
    array = numbers(name, value, 2, -most_m, most_m)
    if array.shape[1] != 2:
        hint = "transpose it?" if array.shape[0] == 2 else ""
        raise refused(name, f"shape {array.shape}", "shape (N, 2): one row per point", hint)
    if array.shape[0] < 2:
        raise refused(name, f"{array.shape[0]} points", "2 points or more")
    return array


def samples(name: str, value: ArrayLike, count: int, least: float, most: float) -> NDArray[np.float64]:
    """``count`` samples within bounds; one number counts for all."""
    if np.ndim(value) == 0:
        value = np.full(count, number(name, value))
    array = numbers(name, value, 1, least, most)
    if len(array) != count:
        raise refused(name, f"{len(array)} samples", f"{count}, as t has, or one number")
    return array


def times(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """Times that increase strictly."""
    array = numbers(name, value)
    late = np.flatnonzero(np.diff(array) <= 0)
    if late.size:
        raise refused(f"{name}[{late[0] + 1}]", f"{array[late[0] + 1]:.9g} after {array[late[0]]:.9g}",
                      "times that increase strictly")
    return array


def number(name: str, value: Any, least: float = -math.inf, above: float = -math.inf, most: float = math.inf) -> float:
    """A finite number; ``least`` and ``most`` are included, ``above`` is excluded."""
    if type(value) is float and math.isfinite(value) and above < value and least <= value <= most:
        return value
    accepted = f"a number > {above:g}" if above > -math.inf else f"a number >= {least:g}" if least > -math.inf else "a finite number"
    accepted += f" and <= {most:g}" if most < math.inf else ""
    if isinstance(value, (bool, np.bool_, str, bytes)) or value is None:
        raise refused(name, repr(value), accepted)
    try:
        result = float(value)
    except (TypeError, ValueError) as error:
        raise refused(name, repr(value), accepted) from error
    except OverflowError as error:
        raise refused(name, "a number beyond the range of float64", accepted) from error
    if not (math.isfinite(result) and above < result and least <= result <= most):
        raise refused(name, f"{result:g}", accepted)
    return result


def whole(name: str, value: Any, least: int, most: int) -> int:
    """A whole number between two bounds."""
    if type(value) is int and least <= value <= most:
        return value
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, np.integer)) or not least <= value <= most:
        raise refused(name, repr(value), f"a whole number from {least} to {most}")
    return int(value)


def called(progress: Any) -> Progress:
    """A function for progress, or None."""
    if progress is not None and not callable(progress):
        raise refused("progress", repr(progress), "a function of two numbers, or None")
    return progress  # type: ignore[no-any-return]


def caps(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """Speed limits along a path, shape (N, 3): from (m), to (m), speed (m/s)."""
    rows = np.empty((0, 3)) if np.size(value) == 0 else numbers(name, value, 2)
    if rows.shape[1] != 3:
        raise refused(name, f"shape {rows.shape}", "shape (N, 3): from (m), to (m), speed (m/s)")
    if (rows[:, 2] <= 0).any() or (rows[:, 1] < rows[:, 0]).any():
        raise refused(name, "a row with from > to, or with a speed <= 0", "from <= to, and a speed > 0")
    return rows


def one_of(name: str, value: Any, words: tuple[str, ...]) -> str:
    """One of several words."""
    if not isinstance(value, str) or value not in words:
        raise refused(name, repr(value), "one of: " + ", ".join(words))
    return str(value)


def text_of(name: str, value: Any) -> str:
    """A dict or list as JSON; numpy's numbers and arrays, mappings and tuples are accepted."""
    def plain(item: Any) -> Any:
        if isinstance(item, Mapping):
            return dict(item)
        if isinstance(item, (np.ndarray, np.generic)):
            return item.tolist()
        raise refused(name, f"a value of type {type(item).__name__}", "values that JSON supports")

    try:
        text = json.dumps(value, default=plain, allow_nan=False, ensure_ascii=False)
    except ConfigError:
        raise
    except ValueError as error:
        if "Out of range" not in str(error):
            raise refused(name, "a value that contains itself", "values that JSON supports") from error
        raise refused(name, "a number that is not finite", "finite numbers", "leave the key out instead") from error
    except TypeError as error:
        raise refused(name, "a key that is not a string", "values that JSON supports") from error
    except RecursionError as error:
        raise refused(name, "lists and maps of great depth", "values that JSON supports") from error
    return encodable(name, text)


def encodable(name: str, text: str) -> str:
    """A text that UTF-8 can encode."""
    try:
        text.encode()
    except UnicodeEncodeError as error:
        raise refused(name, ascii(text[max(0, error.start - 20):error.end]), "text that UTF-8 can encode") from error
    return text


def file_name(name: str, value: Any) -> str:
    """The name of a file."""
    if not isinstance(value, (str, bytes, os.PathLike)):
        raise refused(name, f"a value of type {type(value).__name__}", "a file's name")
    text = encodable(name, os.fsdecode(value))
    if "\0" in text:
        raise refused(name, ascii(text), "a file's name")
    return text
