"""Many plans on the workers of a Dask cluster; needs ``distributed``.

Tasks are shards of ``joulepath batch`` or ``joulepath sweep``. They contain file names only, so workers and client need a
common file system. Each shard runs in a separate process, which ends with its worker. Design: docs/decisions/0701-python.md
"""

from __future__ import annotations

import ctypes
import hashlib
import importlib
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

from . import _core
from ._cluster_inputs import check_flags, command, connected, shard_count, target_of
from ._errors import refused

TRIES = 2  #: processes or workers that a job may end before it is quarantined


class ClusterError(RuntimeError):
    """A run that cannot continue; finished jobs stay, and ``resume=True`` continues."""


def build_id() -> str:
    """Version and digest of the compiled part: only the same build gives the same bytes."""
    return f"{_core.version} {hashlib.sha256(FilePath(_core.__file__).read_bytes()).hexdigest()[:16]}"


@dataclass(frozen=True)
class _Shard:
    number: int
    of: int
    words: tuple[str, ...]  # batch missions.jsonl --nodes 40
    here: str  # directory of the file names in words
    folder: FilePath  # of all shards
    memory_MiB: int
    build: str

    def file(self, name: str = "") -> FilePath:
        return self.folder / str(self.number) / name

    def blame(self, deaths: Counter[tuple[int, int]], reason: str) -> None:
        """Counts a killed process for the first job without a result (with one thread, the planned one); quarantines it at the limit."""
        known = {int(found[1]) for name in ("results.partial.jsonl", "quarantine.jsonl") if self.file(name).exists()
                 for line in self.file(name).read_text().splitlines() if (found := re.match(r'{"index": ?(\d+),.*}$', line))}
        index = next(k for k in range(self.number - 1, sys.maxsize, self.of) if k not in known)
        deaths[self.number, index] += 1
        if deaths[self.number, index] >= TRIES:
            with open(self.file("quarantine.jsonl"), "a", encoding="utf-8") as file:
                file.write(json.dumps({"index": index, "reason": f"{reason}, {TRIES} times"}) + "\n")


def _run_shard(shard: _Shard) -> None:
    """On a worker: runs a shard until it is complete."""
    if build_id() != shard.build:
        raise ClusterError(f"a worker has joulepath {build_id()}, the client {shard.build}")
    deaths: Counter[tuple[int, int]] = Counter()
    words = (sys.executable, "-m", __name__, str(os.getpid()), str(shard.memory_MiB), *shard.words, "--resume", "-j1", "-q",
             "--shard", f"{shard.number}/{shard.of}", "--quarantine", str(shard.file("quarantine.jsonl")), "--out", str(shard.file()))
    while not shard.file("shard.json").exists():
        child = subprocess.Popen(words, cwd=shard.here, stderr=subprocess.PIPE, text=True)
        while child.returncode is None:
            try:
                told = child.communicate(timeout=0.2)[1]
            except subprocess.TimeoutExpired:
                if (shard.folder / "cancelled").exists():
                    child.kill()
        if child.returncode > 0 or deaths.total() >= 100 or (shard.folder / "cancelled").exists():
            raise ClusterError(f"shard {shard.number}/{shard.of} ended with {child.returncode}: {told.strip()[-2000:]}")
        if child.returncode < 0:
            shard.blame(deaths, f"killed its process by {signal.Signals(-child.returncode).name}")


def _wait(client: Any, shards: list[_Shard], progress: Callable[[int, int], None] | None) -> None:
    """Runs all shards. A shard whose workers died is restarted."""
    dask: Any = importlib.import_module("distributed")
    running = {client.submit(_run_shard, shard, pure=False): shard for shard in shards}
    deaths: Counter[tuple[int, int]] = Counter()
    finished = dask.as_completed(list(running))
    try:
        for future in finished:
            shard, error = running.pop(future), future.exception()
            if isinstance(error, dask.KilledWorker):
                shard.blame(deaths, "ended its workers")
                running[again := client.submit(_run_shard, shard, pure=False)] = shard
                finished.add(again)
            elif error:
                raise error
            elif progress:
                progress(len(shards) - len(running), len(shards))
    except BaseException:
        (shards[0].folder / "cancelled").mkdir(exist_ok=True)
        client.cancel(list(running))
        raise


def run(study: str | os.PathLike[str], client: Any, out: str | os.PathLike[str], *, shards: int | None = None,
        options: tuple[str, ...] = (), memory_MiB: int = 0, resume: bool = False,
        progress: Callable[[int, int], None] | None = None) -> FilePath:
    """Runs a study as ``joulepath sweep``, or missions as ``joulepath batch``, on a ``distributed.Client``.

    ``out`` gets the bytes that one process would write. ``options`` are those of the command (``("--nodes", "100")``),
    ``memory_MiB`` limits each process (0: no limit), ``progress`` is called with the numbers of finished and of all shards.
    A job that kills its process twice gets a line with the status ``quarantined`` and the reason. Ctrl-C ends all shards.
    ``resume=True`` keeps the finished jobs of a run that was ended; inputs must not have changed. Raises ClusterError, ConfigError.
    """
    check_flags(resume, progress, memory_MiB)
    target = target_of(out)
    folder = FilePath(f"{target}.shards")
    held = sum(entry.name.isdigit() for entry in folder.glob("*"))  # shards of an unfinished run
    count = shard_count(shards, held, connected(client))
    if target.exists() or (held and not (resume and count == held)):
        raise refused("out", f"{target if target.exists() else folder}, which exists", "a new name, or resume=True with as many shards")
    builds = client.run(build_id, on_error="return").items()  # OSError: a worker that has just died
    if strangers := {worker: build for worker, build in builds if build != build_id() and not isinstance(build, OSError)}:
        raise ClusterError(f"workers with another build of joulepath than {build_id()}: {strangers}")
    common = (command(study, options), os.getcwd(), folder, memory_MiB, build_id())
    shutil.rmtree(folder / "cancelled", ignore_errors=True)
    parts = [_Shard(k, count, *common) for k in range(1, count + 1)]
    for part in parts:
        part.file().mkdir(parents=True, exist_ok=True)
        part.file("quarantine.jsonl").touch()
    _wait(client, parts, progress)
    merge = (sys.executable, "-m", "joulepath", "merge", *(str(part.file()) for part in parts), "-q", "--out", str(target))
    if (merged := subprocess.run(merge, stderr=subprocess.PIPE, text=True)).returncode != 0:
        raise ClusterError(merged.stderr.strip())
    shutil.rmtree(folder)
    return target


if __name__ == "__main__":  # the process of a shard: PARENT MEMORY_MiB WORDS...
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG: it dies with its worker
    if os.getppid() != int(sys.argv[1]):
        sys.exit(130)
    if int(sys.argv[2]) > 0:
        resource.setrlimit(resource.RLIMIT_AS, (int(sys.argv[2]) << 20,) * 2)
    sys.exit(_core.program_main(["joulepath", *sys.argv[3:]]))
