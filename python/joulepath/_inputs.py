"""Arguments as the compiled part takes them; what cannot be meant is refused with its name."""

from __future__ import annotations

import json
from typing import Any, Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import refused


def numbers(name: str, value: ArrayLike, ndim: int = 1) -> NDArray[np.float64]:
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
    array = np.ascontiguousarray(array, dtype=np.float64)
    finite = np.isfinite(array)
    if not finite.all():
        index = tuple(int(i) for i in np.argwhere(~finite)[0])
        where = "".join(f"[{i}]" for i in index)
        raise refused(name + where, str(array[index]), "a finite number")
    return array


def points(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """Two points or more as an (N, 2) array."""
    array = numbers(name, value, ndim=2)
    if array.shape[1] != 2:
        hint = "transpose it?" if array.shape[0] == 2 else ""
        raise refused(name, f"shape {array.shape}", "shape (N, 2): one row per point", hint)
    if array.shape[0] < 2:
        raise refused(name, f"{array.shape[0]} points", "2 points or more")
    return array


def samples(name: str, value: ArrayLike, count: int) -> NDArray[np.float64]:
    """``count`` samples; one number stands for all."""
    if np.ndim(value) == 0:
        return np.full(count, number(name, value))
    array = numbers(name, value)
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


def number(name: str, value: Any, least: float | None = None, above: float | None = None) -> float:
    """A finite number; ``least`` is accepted itself, ``above`` is not."""
    accepted = ("a finite number" if least is None and above is None
                else f"a number >= {least:g}" if least is not None else f"a number > {above:g}")
    if isinstance(value, (bool, np.bool_, str, bytes)) or value is None:
        raise refused(name, repr(value), accepted)
    try:
        result = float(value)
    except (TypeError, ValueError) as error:
        raise refused(name, repr(value), accepted) from error
    good = np.isfinite(result) and (least is None or result >= least) and (above is None or result > above)
    if not good:
        raise refused(name, f"{result:g}", accepted)
    return result


def whole(name: str, value: Any, least: int, most: int) -> int:
    """A whole number between two bounds."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= most:
        raise refused(name, repr(value), f"a whole number from {least} to {most}")
    return int(value)


def one_of(name: str, value: Any, words: tuple[str, ...]) -> str:
    """One of some words."""
    if value not in words:
        raise refused(name, repr(value), "one of: " + ", ".join(words))
    return str(value)


def text_of(name: str, value: Any) -> str:
    """A dict or list as JSON; numpy's numbers and arrays, mappings and tuples are fine in it."""
    def plain(item: Any) -> Any:
        if isinstance(item, Mapping):
            return dict(item)
        if isinstance(item, (np.ndarray, np.generic)):
            return item.tolist()
        raise refused(name, f"a value of type {type(item).__name__}", "what JSON can hold")

    try:
        return json.dumps(value, default=plain, allow_nan=False, ensure_ascii=False)
    except ValueError as error:
        if "Out of range" not in str(error):
            raise
        raise refused(name, "a number that is not finite", "finite numbers", "leave the key out instead") from error
