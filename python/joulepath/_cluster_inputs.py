"""Arguments of ``cluster.run``, checked before anything is written."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, cast

from . import _core
from ._errors import ConfigError, refused
from ._inputs import called, encodable, file_name, whole

MOST_SHARDS = 1_000_000  #: of the program


def check_flags(resume: Any, progress: Any, memory_MiB: Any) -> None:
    """Rejects invalid values before the run."""
    whole("memory_MiB", memory_MiB, 0, sys.maxsize >> 20)
    if not isinstance(resume, bool):
        raise refused("resume", repr(resume), "True or False")
    called(progress)


def target_of(out: Any) -> Path:
    """The absolute name of the directory for the results."""
    return Path(file_name("out", out)).absolute()


def connected(client: Any) -> Any:
    """A client that can run tasks."""
    if not isinstance(client, importlib.import_module("distributed").Client):
        raise refused("client", f"a value of type {type(client).__name__}", "a distributed.Client")
    if client.asynchronous or client.status != "running":
        raise refused("client", "an asynchronous client" if client.asynchronous else f"a client that is {client.status}",
                      "a connected client that is not asynchronous")
    return client


def command(study: Any, options: Any) -> tuple[str, ...]:
    """The words of ``joulepath batch`` or ``joulepath sweep``, after the program checked study, missions and options."""
    if isinstance(options, (str, bytes)) or not hasattr(options, "__iter__"):
        raise refused("options", repr(options), 'words of the command, ("--nodes", "100") for example')
    words = tuple(options)
    for k, word in enumerate(words):
        if not isinstance(word, str) or "\0" in word:
            raise refused(f"options[{k}]", repr(word), "a string, as on the command line")
        encodable(f"options[{k}]", word)
    file = file_name("study", study)
    is_study = os.path.splitext(file)[1] in (".yaml", ".yml") and "missions" in cast(Any, _core.load_document(file))
    words = ("sweep" if is_study else "batch", file, *words)
    with tempfile.TemporaryDirectory() as scratch:  # the last of so many shards has no job
        held = Path(scratch, "held.jsonl")
        held.touch()
        tried = subprocess.run((sys.executable, "-m", "joulepath", *words, "-j1", "-q", "--shard", f"{MOST_SHARDS}/{MOST_SHARDS}",
                                "--quarantine", str(held), "--out", os.path.join(scratch, "none")), stderr=subprocess.PIPE, text=True)
    if tried.returncode != 0:
        raise ConfigError(tried.stderr.strip(), key="options")
    return words


def shard_count(shards: Any, held: int, client: Any) -> int:
    """The number of shards: as asked for, or of the unfinished run, or four per worker."""
    count = whole("shards", shards, 1, MOST_SHARDS) if shards is not None else held or 4 * len(client.nthreads())
    if count == 0:
        raise refused("client", "a cluster without workers", "at least one worker, or shards=",
                      "client.wait_for_workers(1) waits for one")
    return count
