"""Results as values."""

from __future__ import annotations

from typing import Any, NoReturn


class Value:
    """A result that never changes: a copy is the same object. It belongs to its process and is not pickled."""

    __slots__ = ()

    def __copy__(self) -> Any:
        return self

    def __deepcopy__(self, memo: object) -> Any:
        return self

    def __reduce__(self) -> NoReturn:
        raise TypeError(f"a {type(self).__name__} cannot be pickled, because it is bound to its process; pass the data that you need: "
                        "figures, arrays (numpy.array), .json.to_dict(), or files (save)")
