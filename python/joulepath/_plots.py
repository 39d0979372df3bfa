"""Plots by matplotlib."""

from __future__ import annotations

from typing import Any, Mapping


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
