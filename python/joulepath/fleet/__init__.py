"""Fleets with few chargers: who drives what, when and where to charge, with a bound; needs ``ortools``.

Traffic between robots is not modelled. Design: docs/decisions/0701-python.md

>>> from joulepath import fleet
>>> night = fleet.plan("scenarios/fleets/night_shift.yaml")  # doctest: +SKIP
>>> night.status, night.cost_J >= night.bound_J  # doctest: +SKIP
('optimal', True)
"""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Callable, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from .._errors import refused
from .._inputs import number, whole
from ._problem import UNITS_PER_J, Problem, Schedule

if TYPE_CHECKING:
    from ._study import FleetStudy

__all__ = ["FleetPlan", "plan", "study"]


class FleetPlan:
    """A schedule of a fleet, or the verdict why there is none."""

    def __init__(self, source: Any, status: str, schedule: Schedule | None, help_: list[dict[str, Any]]) -> None:
        self._source, self.status, self.schedule, self.help = source, status, schedule, help_

    @property
    def problem(self) -> Problem:
        """The fleet in whole seconds and tenths of a joule."""
        problem: Problem = self._source.problem
        return problem

    @property
    def cost_J(self) -> float:
        """Joules to be bought, with the prices of lateness and use; infinite without a schedule."""
        return self.schedule.cost / UNITS_PER_J if self.schedule else float("inf")

    @property
    def bound_J(self) -> float:
        """No schedule of this fleet costs less that drives to and from chargers at the cheapest speed, with one charge at most between
        two missions."""
        return self.schedule.bound / UNITS_PER_J if self.schedule else float("inf")

    @property
    def gap_percent(self) -> float:
        """(cost - bound)/cost."""
        return 100 * (1 - self.bound_J / self.cost_J) if self.schedule and self.cost_J else 0.0

    @property
    def json(self) -> dict[str, Any]:
        """The content of fleet.json."""
        from ._output import fleet_json

        return fleet_json(self._source, self.status, self.schedule, self.help)

    def simulate(self, runs: int, *, seed: int = 1) -> list[dict[str, Any]]:
        """Drives the schedule so often, with energies drawn from the model's uncertainty, one number for all legs of a robot, and
        with 10 % more friction in one robot; each without and with the dispatcher's rule "charge now". ``save`` writes the figures.

        Rows: case, runs, days (robots that drive, in all runs), breaches (of these, with a level below the reserve), both again
        where the plan comes within 1 % of the battery of the reserve, lateness and waits at chargers (s, of a run). Raises ConfigError.
        """
        from ._hidden import energy_factor
        from ._simulate import cases, most_driven

        whole("runs", runs, 1, 1_000_000)
        if self.schedule is None:
            return []
        factor = energy_factor(self._source, self.schedule, most_driven(self.schedule))
        self._source.executions = cases(self.problem, self.schedule, runs, seed, factor, "10 % more friction")
        return list(self._source.executions)

    def save(self, directory: str | os.PathLike[str], *, force: bool = False, missions: bool = True) -> FilePath:
        """Writes fleet.json and report.html, and of each driven mission, in missions/NAME: plan.json, trajectory.csv, order.json.

        All files are written or none. Files that exist are overwritten with ``force`` alone, else ConfigError.
        """
        from ._output import save

        return save(self._source, self.status, self.schedule, self.help, directory, force, missions)

    def __repr__(self) -> str:
        return f"FleetPlan({self.status}, {self.cost_J:.6g} J, bound {self.bound_J:.6g} J)"


def plan(file: str | os.PathLike[str], *, seed: int = 1, workers: int = 8, limit: float = 60.0, threads: int = 2, cache: bool = True,
         tell: Callable[[str], None] | None = None, stop: Callable[[], bool] | None = None) -> FleetPlan:
    """Plans a fleet file for the least cost.

    ``limit``: deterministic time of the search, about CPU seconds; the same seed, workers and limit give the same plan.
    ``threads``: for the energies of legs, which are cached with ``cache``. ``tell`` gets lines about the progress; the search ends
    with its best schedule when ``stop`` is true. A fleet that cannot be planned has the status ``infeasible`` and the smallest
    helps that work. Raises ConfigError with file, line and key; ImportError without ortools.
    """
    source, options, say = _opened(file, seed, workers, limit, threads, cache, tell)
    from ._search import search
    from ._verdict import helps, reason_of

    status, schedule = search(source.problem, **options, tell=say, stop=stop)
    if status == "infeasible":
        source.reason = reason_of(source, **options)
        return FleetPlan(source, status, None, helps(source, **options))
    if schedule is None:
        raise refused("limit", f"{limit:g}, in which no schedule was found", "a larger limit")
    return FleetPlan(source, status, schedule, [])


def study(file: str | os.PathLike[str], *, places: Sequence[int] = (1, 2, 3), battery_scales: Sequence[float] = (1.0,), seed: int = 1,
          workers: int = 8, limit: float = 20.0, threads: int = 2, cache: bool = True, client: Any = None,
          tell: Callable[[str], None] | None = None) -> FleetStudy:
    """Plans a fleet with each number of places at each charger (0: no charger) and each scale of the batteries.

    ``limit``: of each fleet. ``client``: a ``distributed.Client``, whose workers plan the fleets; they need this package with
    ``ortools``. ``rows`` have charging_places, battery_scale, status, cost_J, bound_J, robots, visits, charged_s, late_s (None without
    a schedule, but for the bound). ``save`` writes study.json, study.csv and report.html. More places are never dearer. Raises ConfigError;
    ImportError without ortools.
    """
    _engine()
    from .._cluster_inputs import connected
    from ._study import FleetStudy, rows_of, values

    counts = tuple(whole("places", int(n) if n.is_integer() else n, 0, 1000) for n in values("places", places, 0.0))
    scales, on = values("battery_scales", battery_scales, 0.01), None if client is None else connected(client)
    source, options, say = _opened(file, seed, workers, limit, threads, cache, tell)
    rows = []
    for row in rows_of(source.problem, counts, scales, on, **options):
        rows.append(row)
        say(f"{row['charging_places']} places, battery x {row['battery_scale']:g}: {row['status']}")
    return FleetStudy(source.content["name"], tuple(rows))


def _opened(file: str | os.PathLike[str], seed: int, workers: int, limit: float, threads: int, cache: bool,
            tell: Callable[[str], None] | None) -> tuple[Any, dict[str, Any], Callable[[str], None]]:
    """The fleet of a file, the options of its searches, and who is told of progress."""
    _engine()
    from ._table import FleetFile

    options = {"seed": whole("seed", seed, 0, 2**31 - 1), "workers": whole("workers", workers, 1, 256),
               "limit": number("limit", limit, above=0.0)}
    say = tell or (lambda _: None)
    return FleetFile(file, threads=threads, cache=cache, progress=lambda done, of: say(f"energies of legs: {done} of {of}")), options, say


def _engine() -> None:
    if importlib.util.find_spec("ortools") is None:
        raise ImportError("joulepath.fleet needs ortools: pip install joulepath[fleet]")
