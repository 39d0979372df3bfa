"""What one answer says, and whether it is right. The rules stand here and nowhere else."""

import re

import workspace  # noqa: F401 (knows where spoils is)
from spoils import spoils

SILENT = ("no_gap", "too_little_data")  # data_suspect is none: on a sound day it is a false alarm
SIDED = ("dragging_wheel", "current_sensor_offset", "wheel_radius_mismatch")


def truth_of(label):
    return [e["effect"] for e in label["effects"] if not e["foreign"]]


def detectable(label):
    return bool(label["effects"]) and label["oracle"]["detectable"]


def is_material(change):
    """The motors' or the battery's energy changes by at least 1 %, or the pose by 0.02 (m and rad, rms)."""
    return change.get("effect_percent", 0) >= 1 or change.get("effect_pose_rms", 0) >= 0.02


def material(label):
    """The effects together are."""
    return detectable(label) and is_material(label["oracle"])


def each_material(label):
    """Each of several effects is by itself, the others being there."""
    changes = label["oracle"].get("each_change") or {}
    return detectable(label) and bool(changes) and all(map(is_material, changes.values()))


def separable(label):
    """An observer of the same logs tells the single effect from every other effect and pair; None: nobody asked."""
    return label["oracle"].get("separable")


LEAST_BATTERY_percent = 5  # of the battery's energy: a gap that a log of odometry and battery has to show
SILENT_LOSS_percent = 0.2  # of energy, by which a correction may be worse than the nominal file on a fresh day


def shows_in_battery(label):
    return label["oracle"]["battery_percent"] >= LEAST_BATTERY_percent


def effect_of(label):
    """The effect's name of a label such as `dragging_wheel (left)`."""
    return label.split(" (")[0]


def group_of(cause):
    return {cause["effect"]} | {effect_of(label) for label in cause.get("indistinguishable_from") or []}


class Answer:
    """A diagnosis, or a control's answer in the same form."""

    def __init__(self, diagnosis):
        self.raw = diagnosis or {}
        self.verdict = self.raw.get("verdict", "failed")
        self.causes = self.raw.get("causes") or []
        self.names = [cause["effect"] for cause in self.causes]
        self.ranking = [effect_of(entry["effect"]) for entry in self.raw.get("ranking") or []] or list(self.names)
        self.failed = self.verdict == "failed"
        self.silent = self.failed or self.verdict in SILENT
        self.group = set().union(*map(group_of, self.causes))

    @property
    def gives_a_name(self):
        return bool(self.names) and not self.silent and self.verdict != "unexplained"

    @property
    def first(self):
        """The name put first; causes before the mere ranking."""
        if self.silent:
            return None
        if self.names:
            return self.names[0]
        return self.ranking[0] if self.ranking and self.verdict == "ambiguous" else None

    def top(self, count):
        ordered = self.names + [name for name in self.ranking if name not in self.names]
        return [] if self.silent else ordered[:count]

    @property
    def group_of_first(self):
        return group_of(self.causes[0]) if self.causes else set()

    @property
    def probability(self):
        if self.causes:
            return float(self.causes[0].get("probability", 0.0))
        ranking = self.raw.get("ranking") or []
        return float(ranking[0].get("probability", 0.0)) if ranking else 0.0

    def says_none_fits(self):
        return self.verdict in ("unexplained", "partly_explained")

    def small(self):
        """The effects that are stated as below the materiality floor."""
        return {effect_of(entry["effect"]) for entry in self.raw.get("below_materiality") or []}

    def named_or_small(self):
        """The effects of the named groups, and those below the materiality floor."""
        return self.small() | (set() if self.silent else self.group)

    def lists_unknown(self):
        """An unknown term below the materiality floor."""
        return any(name.startswith("unknown, ") for name in self.small())

    def energy(self, key):
        return self.raw.get("gap", {}).get("energy", {}).get(key)

    def top_cell(self, axis):
        cells = [w for w in self.raw.get("where") or [] if w.get("axis") == axis]
        return max(cells, key=lambda w: w.get("share_of_gap", 0.0))["value"] if cells else None


def wrong_name(answer, label):
    """A name is given, and none of what is named first is among the true effects (or in the group with one)."""
    return answer.gives_a_name and not (answer.group_of_first & set(truth_of(label)))


def names_spoilt_channel(answer, label):
    """A data check states a right kind, holds a column that was spoilt, and tells one run from all."""
    kinds, columns, _ = spoils()[label["spoil"]["way"]]
    return any(check["kind"] in kinds and any(column in check["channel"] for column in columns)
               and (check["run"] == "all") == label["spoil"]["all_runs"] for check in answer.raw.get("data_checks") or [])


def invents_a_cause(answer, label):
    """A name from spoilt data that is not among the true effects."""
    return bool(answer.names) and not answer.silent and answer.verdict != "data_suspect" and not (answer.group & set(truth_of(label)))


def correction_is_worse(fresh_day):
    """On a day that nobody saw; None where no correction was written or driven."""
    before, after = ((fresh_day or {}).get(key) for key in ("before_percent", "after_percent"))
    return after > before + SILENT_LOSS_percent if before is not None and after is not None else None


def parameter_errors(answer, label):
    """Of each true effect that is named: (effect, relative error of its first parameter, interval covers the truth)."""
    found = []
    for effect in label["effects"]:
        for cause in answer.causes:
            if cause["effect"] != effect["effect"] or effect["foreign"]:
                continue
            key, true = next(iter(effect["parameters"].items()))
            said = (cause.get("parameters") or {}).get(key)
            if not isinstance(said, dict) or not isinstance(said.get("value"), (int, float)) or true == 0:
                continue
            low, high = said.get("interval_95") or (None, None)
            covers = None if low is None or high is None else bool(low <= true <= high)
            found.append((effect["effect"], abs(said["value"] - true) / abs(true), covers))
    return found


def clear_top(cells, ratio=1.25):
    """The cell with the largest share, if it is clearly the largest."""
    ordered = sorted(cells.items(), key=lambda item: -item[1])
    if len(ordered) > 1 and ordered[1][1] * ratio > ordered[0][1]:
        return None
    return ordered[0][0]


def settles(first, again, truth):
    """Of a group that holds a true effect: does the second answer name a true effect of it, and that one alone?"""
    groups = [group_of(cause) for cause in first.causes if cause.get("indistinguishable_from")]
    wanted = set().union(*groups) & set(truth)
    return any(cause["effect"] in wanted and not cause.get("indistinguishable_from") for cause in again.causes)


def true_shrink(fresh_day):
    """Share of the energy gap that the correction closes on a day that nobody saw; None where that was not driven."""
    before, after = ((fresh_day or {}).get(key) for key in ("before_J", "after_J"))
    return 1 - after / before if before and after is not None else None


CELL = re.compile(r"x (-?[\d.]+) to (-?[\d.]+) m, y (-?[\d.]+) to (-?[\d.]+) m")


def patch_overlaps(cell, effect):
    """Does a floor cell of the answer (`x 1 to 2 m, y 0 to 1 m`) touch the true patch? None: no such cell."""
    found = CELL.fullmatch(cell or "")
    if not found:
        return None
    x_low, x_high, y_low, y_high = map(float, found.groups())
    p = effect["parameters"]
    return x_low < p["x_max_m"] and x_high > p["x_min_m"] and y_low < p["y_max_m"] and y_high > p["y_min_m"]
