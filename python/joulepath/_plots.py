"""Plots by matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Mapping

import numpy as np

from ._errors import refused

if TYPE_CHECKING:
    from .commands import Answer
    from .logs import Log

FLOOR_INCH, ROW_INCH, MOST_INCH = 4.8, 0.25, 60.0  # height of a figure with a row per mission


def axes_or_new(axes: Any) -> Any:
    """The caller's axes, or those of a new figure."""
    import matplotlib.pyplot as plt

    return plt.subplots(layout="constrained")[1] if axes is None else axes


def bars(axes: Any, values: Mapping[str, float], label: str) -> Any:
    """A bar for each name, the first on top. Returns the axes."""
    axes = axes_or_new(axes)
    axes.barh(list(values), list(values.values()))
    axes.invert_yaxis()
    axes.set_xlabel(label)
    return axes


def over_time(axes: Any, log: Log) -> Any:
    """Speed and power of a motion over time. Returns the two axes."""
    import matplotlib.pyplot as plt

    if axes is None:
        _, axes = plt.subplots(2, 1, sharex=True)
    t = log["time_s"]
    axes[0].plot(t, log["linear_speed_m_s"], label="speed, m/s")
    axes[0].plot(t, log["angular_speed_rad_s"], label="yaw rate, rad/s")
    axes[1].plot(t, log["battery_power_W"], label="battery power, W")
    axes[1].set_xlabel("time, s")
    for axis in axes:
        axis.legend()
    return axes


def of_answer(answer: Answer, axes: Any) -> Any:
    """The plot of a command's answer; ConfigError where it has nothing to plot."""
    if answer.command not in _PLOTS:
        why = _NONE.get(answer.command, "")
        raise refused("plot", f"an answer of {answer.command}", "one of " + ", ".join(_PLOTS), why)
    return _PLOTS[answer.command](answer, axes)


def _compare(answer: Answer, axes: Any) -> Any:
    return bars(axes, {profile.name: profile.energy_J for profile in answer.json.profiles if profile.feasible}, "energy, J")


def _front(answer: Answer, axes: Any) -> Any:
    axes, points = axes_or_new(axes), answer.json.points
    axes.plot([p.duration_s for p in points], [p.energy_J for p in points], marker=".", label="least energy")
    for name in dict.fromkeys(baseline.name for baseline in answer.json.baselines):
        driven = [b for b in answer.json.baselines if b.name == name and b.feasible]
        axes.plot([b.duration_s for b in driven], [b.energy_J for b in driven], ".", label=name)
    axes.set(xlabel="duration, s", ylabel="energy, J")
    axes.legend()
    return axes


def _sweep(answer: Answer, axes: Any) -> Any:
    """A dot for each design: sums over its missions. Those outside of a constraint are crosses, those without a plan are
    left out."""
    if "sweep.csv" not in answer.files:
        raise refused("plot", "a shard of a sweep", "a whole sweep", "joulepath merge joins shards")
    table, parameters = answer.table("sweep.csv"), answer.json.parameters
    _, first, design = np.unique(table["design"], return_index=True, return_inverse=True)
    energy_J, duration_s = (np.bincount(design, table[key]) for key in ("energy_J", "duration_s"))
    meets = np.bincount(design, table["meets_constraints"] != "yes") == 0
    planned = np.isfinite(energy_J)
    if not planned.any():
        raise refused("plot", "a sweep in which no design has a plan", "a design with a plan", "sweep.csv has the reasons")
    varied = next((p for p in parameters if len(set(table[p.name][first])) > 1), parameters[0])
    levels = table[varied.name][first]
    label = varied.name if varied.key.endswith("." + varied.name) else f"{varied.name} ({varied.key})"
    axes = axes_or_new(axes)
    kinds = [(marker, name, planned & chosen) for marker, name, chosen in
             (("o", "keeps the constraints", meets), ("x", "outside of a constraint", ~meets)) if (planned & chosen).any()]
    if levels.dtype.kind == "f":
        scale = {"vmin": levels[planned].min(), "vmax": levels[planned].max()}
        for marker, name, chosen in kinds:
            shown = axes.scatter(duration_s[chosen], energy_J[chosen], c=levels[chosen], marker=marker, label=name, **scale)
        axes.figure.colorbar(shown, ax=axes, label=label)
    else:
        for k, level in enumerate(dict.fromkeys(levels[planned])):
            for marker, name, chosen in kinds:
                at = chosen & (levels == level)
                axes.scatter(duration_s[at], energy_J[at], c=f"C{k % 10}", marker=marker,
                             label=f"{level}, {name}" if len(kinds) > 1 else level)
    if len(kinds) > 1 or levels.dtype.kind != "f":
        axes.legend(title=None if levels.dtype.kind == "f" else label)
    axes.set(xlabel="duration, s", ylabel="energy, J")
    return axes


def _batch(answer: Answer, axes: Any) -> Any:
    """Two axes: energy and duration of each mission; a mission without a plan has its status instead of bars."""
    import matplotlib.pyplot as plt

    missions = answer.json if isinstance(answer.json, tuple) else (answer.json,)
    rows = range(len(missions))
    if axes is None:
        height = min(max(FLOOR_INCH, ROW_INCH * len(missions)), MOST_INCH)
        _, axes = plt.subplots(1, 2, sharey=True, layout="constrained", figsize=(8.0, height))
    for axis, key, label in zip(axes, ("energy_J", "duration_s"), ("energy, J", "duration, s")):
        axis.barh(rows, [mission.get(key) or 0.0 for mission in missions])
        axis.set_xlabel(label)
    axes[0].set_yticks(rows, [m.name if m.get("energy_J") is not None else f"{m.name}: {m.status}" for m in missions])
    axes[0].set_ylim(len(missions) - 0.5, -0.5)
    return axes


def _calibrate(answer: Answer, axes: Any) -> Any:
    """Fitted constants beside those of the robot file, with one standard deviation, in % (of the fit where the file has 0);
    unseen ones are left out."""
    fitted = [p for p in answer.json.parameters if p.visibility != "unseen"]
    if not fitted:
        raise refused("plot", "a calibration that fits no constant", "a fitted constant", "json.parameters has the reasons")
    axes, rows = axes_or_new(axes), range(len(fitted))
    percent = [100.0 / abs(p.nominal or p.value or 1.0) for p in fitted]
    axes.errorbar([scale * (p.value - p.nominal) for scale, p in zip(percent, fitted)], rows,
                  xerr=[scale * p.standard_deviation for scale, p in zip(percent, fitted)], fmt="o", capsize=3)
    axes.axvline(0.0, color="gray", linewidth=0.8)
    axes.set_yticks(rows, [f"{p.name}\n{p.nominal:.4g} to {p.value:.4g} {p.unit}".rstrip() for p in fitted])
    axes.set_ylim(len(fitted) - 0.5, -0.5)
    axes.set_xlabel("change from the robot file, % (\u00b1 1 sigma)")
    return axes


_PLOTS: dict[str, Callable[[Answer, Any], Any]] = {
    "compare": _compare, "front": _front, "sweep": _sweep, "batch": _batch, "calibrate": _calibrate}
_NONE = {"check": "it says whether files are valid: json has its notes and errors",
         "experiment": "it writes one run to drive: jp.plan(its mission.yaml, robot=robot) has a plot"}
