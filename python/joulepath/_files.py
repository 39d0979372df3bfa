"""Writing results atomically."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path as FilePath
from typing import Mapping

from ._errors import refused


def save(directory: str | os.PathLike[str], contents: Mapping[str, str | bytes | None], force: bool) -> FilePath:
    """Writes files into a directory. A name without content is a file of older results, which is removed.

    Raises ConfigError where one of them exists and ``force`` is not given.
    """
    target = FilePath(directory)
    for name in contents:
        if (target / name).exists() and not force:
            raise refused("directory", f"{target / name}, a file that exists", "a new name", "force=True overwrites it")
    target.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=target, prefix=".part-") as part:
        for name, content in contents.items():
            if content is not None:
                (FilePath(part) / name).write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))
        for name, content in contents.items():
            if content is None:
                (target / name).unlink(missing_ok=True)
            else:
                os.replace(FilePath(part) / name, target / name)
    return target
