"""Logs in memory: the columns of a frame as the compiled module takes them.

Design: docs/decisions/0701-python.md
"""

from __future__ import annotations

import decimal
import numbers
import reprlib
import sys
from typing import Any, Mapping

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._errors import ConfigError, refused
from ._inputs import encodable

ACCEPTED = "a finite number, or NaN where a value is missing"


def names_read(columns: Mapping[str, Any]) -> frozenset[str]:
    """The names of a frame's columns that a log is read from; ``columns`` maps names as in a dataset file."""
    names: set[str] = set()
    for column in _core.log_column_names():
        source = columns.get(column)
        source = source if isinstance(source, Mapping) else {}
        given = source.get("from", column)
        if source.get("absent") is not True:
            names.update(str(name) for name in (given if isinstance(given, (list, tuple)) else [given]))
    return frozenset(names)


def is_frame(log: Any) -> bool:
    """Columns by name: a data frame, a Log, a dict of arrays."""
    return hasattr(log, "columns") or isinstance(log, Mapping)


def columns_of(name: str, log: Any, read: frozenset[str]) -> dict[str, NDArray[np.float64]]:
    """The columns of a frame; those that are not read are empty. Missing values are NaN, as empty cells of a file are."""
    if not is_frame(log):
        raise refused(name, f"a value of type {type(log).__name__}", "a file's name, a data frame, or columns by name")
    columns: dict[str, NDArray[np.float64]] = {}
    headers = [encodable(name, str(key)) for key in getattr(log, "columns", log)]
    for header in headers:
        if headers.count(header) > 1:
            raise refused(f"{name}.{header}", f"{headers.count(header)} columns of this name", "one column of a name")
    for key, header in zip(getattr(log, "columns", log), headers):
        columns[header] = _numbers(f"{name}.{header}", log[key]) if header in read else np.empty(0)
    lengths = {header: len(column) for header, column in columns.items() if header in read}
    for header, length in lengths.items():
        first = next(iter(lengths))
        if length != lengths[first]:
            raise refused(f"{name}.{header}", f"{length} rows", f"{lengths[first]} rows, as {first} has")
    return columns


def _numbers(name: str, column: Any) -> NDArray[np.float64]:
    if np.ma.isMaskedArray(column):
        raise refused(name, "a masked array", "an array without a mask", "fill the masked samples with NaN")
    try:
        array = np.asarray(column)
    except ValueError as error:
        raise refused(name, "rows of different lengths", "one number per row") from error
    if array.ndim != 1:
        raise refused(name, f"shape {array.shape}", "an array with 1 axis")
    if isinstance(column, (list, tuple)) and (array.dtype.kind not in "fiu" or any(isinstance(item, (bool, np.bool_)) for item in column)):
        array = np.array(column, dtype=object)  # numpy would turn all into texts, or truth values into numbers
    values = array if array.dtype.kind in "fiu" else _from_objects(name, array)
    with np.errstate(over="ignore"):  # of long double
        values = np.ascontiguousarray(values, dtype=np.float64)
    infinite = np.flatnonzero(np.isinf(values))
    if infinite.size:
        raise refused(f"{name}[{infinite[0]}]", f"{values[infinite[0]]:g}", ACCEPTED)
    if len(values) and np.isnan(values).all():
        raise refused(name, f"no number in {len(values)} rows", "numbers", "leave the column out if nothing was measured")
    return values


def _from_objects(name: str, array: NDArray[Any]) -> NDArray[np.float64]:
    """Numbers of an array of objects, None and pandas.NA as NaN. Anything else, and arrays of other types, are refused."""
    values = np.full(len(array), np.nan)
    missing = (None, getattr(sys.modules.get("pandas"), "NA", None))
    for row, value in enumerate(array):
        if any(value is sign for sign in missing):
            continue
        values[row] = _number(name, row, value)
    return values


def _number(name: str, row: int, value: Any) -> float:
    foreign = isinstance(value, (bool, np.bool_, np.timedelta64))  # Python and numpy count them among the whole numbers
    if foreign or not isinstance(value, (numbers.Real, decimal.Decimal)):
        raise _refused_value(name, row, value)
    try:
        return float(value)
    except (OverflowError, ValueError) as error:
        raise _refused_value(name, row, value) from error


def _refused_value(name: str, row: int, value: Any) -> ConfigError:
    return refused(f"{name}[{row}]", f"{reprlib.repr(value)} of type {type(value).__name__}", ACCEPTED)
