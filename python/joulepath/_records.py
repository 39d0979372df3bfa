"""Read-only views of JSON results."""

from __future__ import annotations

from typing import Any, Iterator, Mapping


class Record(Mapping[str, Any]):
    """A JSON object whose keys are attributes too.

    >>> record = Record({"a": {"b": [1, 2]}})
    >>> record.a.b[0] == record["a"]["b"][0] == 1
    True
    """

    __slots__ = ("_values",)

    def __init__(self, values: Mapping[str, Any]) -> None:
        object.__setattr__(self, "_values", {key: viewed(value) for key, value in values.items()})

    def __getitem__(self, key: str) -> Any:
        return self._values[key]

    def __getattr__(self, key: str) -> Any:
        if key.startswith("__"):
            raise AttributeError(key)
        try:
            return self._values[key]
        except KeyError:
            raise AttributeError(f"no {key!r} here; there are: {', '.join(self._values)}") from None

    def __setattr__(self, key: str, value: object) -> None:
        raise AttributeError("results are read-only")

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._values]

    def __repr__(self) -> str:
        return f"Record({self.to_dict()!r})"

    def __reduce__(self) -> tuple[object, ...]:
        return (Record, (self.to_dict(),))

    def to_dict(self) -> dict[str, Any]:
        """The same as plain dicts and lists."""
        return {key: plain(value) for key, value in self._values.items()}


def viewed(value: Any) -> Any:
    if isinstance(value, Record):
        return value
    if isinstance(value, Mapping):
        return Record(value)
    if isinstance(value, (list, tuple)):
        return tuple(viewed(item) for item in value)
    return value


def plain(value: Any) -> Any:
    if isinstance(value, Record):
        return value.to_dict()
    if isinstance(value, tuple):
        return [plain(item) for item in value]
    return value
