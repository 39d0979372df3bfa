"""Many calls at once."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import Any, Callable, Iterable, Mapping, TypeVar

from . import _core
from ._inputs import Progress, called, whole

Result = TypeVar("Result")


def map(function: Callable[..., Result], jobs: Iterable[Any], *, threads: int = 2,
        progress: Progress = None) -> list[Result | Exception]:  # noqa: A001
    """Calls ``function`` for every job on several threads; results are in the order of the jobs.

    A dict is a job's keyword arguments, a tuple its positional ones, anything else its only one. A call that fails gives
    its exception as its result, so that one infeasible job does not cost the others. ``progress(done, total)`` is called after each job; an error of it,
    and Ctrl-C, end all.

    >>> first, second = map(int, ["1", "one"])
    >>> first, type(second).__name__
    (1, 'ValueError')
    """
    called(progress)
    token, threads = _core.StopToken(), whole("threads", threads, 1, 256)

    def call(job: Any) -> Result | Exception:
        try:
            if isinstance(job, Mapping):
                return function(**job)
            return function(*job) if isinstance(job, tuple) else function(job)
        except Exception as error:  # a failure is a value here
            return error

    with ThreadPoolExecutor(threads, initializer=_core.use_stop_token, initargs=(token,)) as pool:
        try:
            futures = [pool.submit(call, job) for job in jobs]
            if progress:
                for done, _ in enumerate(as_completed(futures), 1):
                    progress(done, len(futures))
            return [future.result() for future in futures]
        except BaseException:
            token.stop()
            pool.shutdown(cancel_futures=True)
            raise
