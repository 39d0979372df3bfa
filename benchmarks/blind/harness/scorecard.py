"""The scorecard of a campaign: one row per measure, from labels and answers."""
import math

import judge
from statistics_of import calibration, median, smallest_found, wilson


LEAST_GAP_percent = 2  # below it the share of the gap that is closed says nothing


class Rate:
    """A proportion with its interval, the aim and what counts as failed."""

    def __init__(self, name, outcomes, aim, fails, higher_is_better=True):
        outcomes = list(outcomes)
        self.name, self.aim, self.fails, self.up = name, aim, fails, higher_is_better
        self.hits, self.total = sum(outcomes), len(outcomes)
        self.value = self.hits / self.total if self.total else float("nan")
        self.interval = wilson(self.hits, self.total)

    def state(self):
        if self.total == 0 or self.aim is None:
            return ""
        better = (lambda a, b: a >= b) if self.up else (lambda a, b: a <= b)
        return "aim" if better(self.value, self.aim) else ("ok" if better(self.value, self.fails) else "FAILS")

    def row(self):
        if self.total == 0:
            return f"| {self.name} | no case | | | | |"
        low, high = self.interval
        aim = "" if self.aim is None else f"{self.aim:g}"
        fails = "" if self.fails is None else f"{self.fails:g}"
        return f"| {self.name} | {self.value:.3f} | {low:.3f}–{high:.3f} | {self.hits}/{self.total} | {aim} / {fails} | {self.state()} |"


class Value:
    """A number (median, error) with its aim."""

    def __init__(self, name, value, count, aim, fails, higher_is_better=False):
        self.name, self.value, self.count, self.aim, self.fails, self.up = name, value, count, aim, fails, higher_is_better

    def state(self):
        if self.aim is None or math.isnan(self.value):
            return ""
        better = (lambda a, b: a >= b) if self.up else (lambda a, b: a <= b)
        return "aim" if better(self.value, self.aim) else ("ok" if better(self.value, self.fails) else "FAILS")

    def row(self):
        aim = "" if self.aim is None else f"{self.aim:g} / {self.fails:g}"
        return f"| {self.name} | {self.value:.3g} | | {self.count} | {aim} | {self.state()} |"


class Within(Value):
    """A share that shall lie in a range: too wide an interval is no better than too narrow a one."""

    def state(self):
        if math.isnan(self.value):
            return ""
        inside = lambda low, high: low <= self.value <= high
        return "aim" if inside(*self.aim) else ("ok" if inside(*self.fails) else "FAILS")

    def row(self):
        if self.count == 0:
            return f"| {self.name} | no case | | | | |"
        low, high = wilson(round(self.value * self.count), self.count)
        return f"| {self.name} | {self.value:.3g} | {low:.3f}–{high:.3f} | {self.count} | {self.aim[0]:g}–{self.aim[1]:g} / {self.fails[0]:g}–{self.fails[1]:g} | {self.state()} |"


def rates(cases):
    """`cases` is a list of (label, Answer). The measures of the scorecard that are proportions of answers."""
    of = lambda *names: [(l, a) for l, a in cases if l["bin"] in names]
    seen = lambda entries: [(l, a) for l, a in entries if judge.detectable(l)]
    none_fits = lambda l, a: a.says_none_fits()
    none_or_small = lambda l, a: none_fits(l, a) or a.lists_unknown()
    large = lambda entries: [(l, a) for l, a in entries if judge.material(l)]
    singles, pairs, triples = seen(of("single")), seen(of("pair")), seen(of("triple"))
    many, few = ([(l, a) for l, a in large(singles) if (l["runs"] > 6) == more] for more in (True, False))
    known = of("single", "pair", "triple", "long")
    named = [(l, a) for l, a in known if a.gives_a_name]
    battery = of("battery")
    first = lambda l, a: a.first in judge.truth_of(l)
    exact = lambda l, a: set(a.names) == set(judge.truth_of(l)) and not a.silent
    every = lambda l, a: set(judge.truth_of(l)) <= a.group and not a.silent
    told = lambda l, a: first(l, a) or bool(set(judge.truth_of(l)) & a.small())
    weighed = [(l, a) for l, a in singles if judge.separable(l) is not None]
    each_large = [(l, a) for l, a in pairs if judge.each_material(l)]
    any_of = lambda l, a: bool(set(judge.truth_of(l)) & a.group) and not a.silent
    rate = lambda name, hit, entries, aim=None, fails=None, up=True: Rate(name, (hit(l, a) for l, a in entries), aim, fails, up)
    return [
        rate("top-1, single detectable and material, 24 and 12 runs", first, many, 0.98, 0.96),
        rate("top-1, single detectable and material, 6 runs", first, few, 0.92, 0.88),
        rate("exactly the true set, single material, 24 and 12 runs", exact, many, 0.96, 0.92),
        rate("exactly the true set, single material, 6 runs", exact, few, 0.90, 0.85),
        rate("top-1, single detectable effect", first, singles),
        rate("top-1 or below_materiality, single separable effect", told, [(l, a) for l, a in weighed if judge.separable(l)], 0.95, 0.90),
        rate("top-1 or below_materiality, single detectable effect", told, singles),
        rate("the same by the observer: single detectable effect is separable", lambda l, a: judge.separable(l), weighed),
        rate("top-3, single detectable effect", lambda l, a: judge.truth_of(l)[0] in a.top(3), singles),
        rate("true effect inside the named group", any_of, singles),
        rate("exactly the true set, single detectable", exact, singles),
        rate("inside the named group, detectable and material", any_of, large(singles)),
        rate("single material called unexplained or no_gap", lambda l, a: a.verdict in ("unexplained", "no_gap"), large(singles), 0.02, 0.05, False),
        rate("silent on a detectable single effect", lambda l, a: a.silent, singles, None, None, False),
        rate("wrong name, when a name is given", lambda l, a: judge.wrong_name(a, l), named, 0.01, 0.025, False),
        rate("a name too many, when a name is given", lambda l, a: bool(set(a.names) - set(judge.truth_of(l))), named, None, None, False),
        rate("false alarm on null sets (a failure counts as one)", lambda l, a: a.failed or not a.silent, of("null"), 0.01, 0.025, False),
        rate("pairs: both", every, pairs),
        rate("pairs: both, detectable and material", every, large(pairs), 0.88, 0.78),
        rate("pairs: both, each detectable and material by itself", every, each_large, 0.88, 0.78),
        rate("pairs: a third name beside both, each detectable and material by itself", lambda l, a: every(l, a) and bool(set(a.names) - set(judge.truth_of(l))), each_large, 0.02, 0.05, False),
        rate("pairs: both named or listed below_materiality", lambda l, a: set(judge.truth_of(l)) <= a.named_or_small(), pairs),
        rate("pairs: at least one", any_of, pairs, 0.98, 0.95),
        rate("triples: all three", every, triples),
        rate("triples: at least one", any_of, triples),
        rate("foreign effect: says none fits (unexplained or partly)", none_fits, seen(of("foreign")), 0.93, 0.88),
        rate("foreign effect: says none fits, or lists an unknown below the materiality floor", none_or_small, seen(of("foreign"))),
        rate("foreign effect, detectable and material: says none fits", none_fits, large(of("foreign")), 0.95, 0.88),
        rate("foreign effect, detectable and material: a name beside it", lambda l, a: bool(a.names) and not a.silent, large(of("foreign")), 0.10, 0.25, False),
        rate("foreign effect: says unexplained, names nothing", lambda l, a: a.verdict == "unexplained", seen(of("foreign"))),
        rate("true effect removed: says none fits", none_fits, seen(of("removed")), 0.90, 0.85),
        rate("true effect removed: says none fits, or lists an unknown below the materiality floor", none_or_small, seen(of("removed"))),
        rate("true effect removed, detectable and material: says none fits", none_fits, large(of("removed")), 0.96, 0.90),
        rate("true effect removed, separable from what remains: says none fits", none_fits,
             [(l, a) for l, a in seen(of("removed")) if judge.separable(l)]),
        rate("sound day called data_suspect", lambda l, a: a.verdict == "data_suspect",
             [(l, a) for l, a in cases if l["bin"] not in ("spoilt", "removed")], 0.005, 0.015, False),
        rate("spoilt channel is named", lambda l, a: judge.names_spoilt_channel(a, l), of("spoilt"), 0.95, 0.9),
        rate("spoilt channel: a cause is invented", lambda l, a: judge.invents_a_cause(a, l), of("spoilt"), 0.0, 0.02, False),
        rate("odometry and battery alone: a gap of at least 5 % is seen", lambda l, a: not a.silent, [e for e in battery if judge.shows_in_battery(e[0])], 0.95, 0.9),
        rate("odometry and battery alone: wrong name", lambda l, a: judge.wrong_name(a, l), battery, 0.01, 0.03, False),
        rate("one long log: true effect inside the named group, material", any_of, large(of("long"))),
        rate("no answer at all", lambda l, a: a.failed, cases, 0.0, 0.0, False),
    ]


def correction_rates(labels, results):
    """Corrections on a day that nobody saw, and how many explainable cases got one."""
    worse = [judge.correction_is_worse(result.get("fresh_day")) for result in results.values()]
    explainable = [result for case_id, result in results.items() if labels[case_id]["bin"] in ("single", "pair") and judge.material(labels[case_id])]
    return [Rate("correction is worse than the nominal file on a fresh day", (w for w in worse if w is not None), 0.005, 0.02, False),
            Rate("material single or pair that got a correction", (bool(result.get("corrected")) for result in explainable), 0.9, 0.8)]


def interval_values(cases):
    """Coverage of the 95 % intervals of the parameters, by level of noise."""
    rows = []
    for level, kind in ((0, "white"), (1, "rough")):
        covered = [c for l, a in cases if l["level"] == level and l["bin"] in ("single", "pair") and judge.detectable(l)
                   for _, _, c in judge.parameter_errors(a, l) if c is not None]
        share = sum(covered) / len(covered) if covered else float("nan")
        rows.append(Within(f"95 % interval of a parameter covers the truth, {kind} noise", share, len(covered), (0.93, 0.97), (0.90, 0.98)))
    return rows


def place_rates(cases):
    """Does `where` put the gap where the plant knows that it is? Only where the truth's largest cell is clear."""
    rows, outcomes = [], {"phase": [], "wheel": [], "floor": []}
    for label, answer in cases:
        if label["bin"] != "single" or not judge.detectable(label) or answer.silent:
            continue
        effect = label["effects"][0]
        phase = judge.clear_top(label["oracle"]["where"]["phase"])
        if phase and answer.top_cell("phase"):
            outcomes["phase"].append(answer.top_cell("phase") == phase)
        wheel = judge.clear_top(label["oracle"]["where"]["wheel"])
        if wheel and effect["effect"] in judge.SIDED and answer.top_cell("wheel"):
            outcomes["wheel"].append(answer.top_cell("wheel") == wheel)
        if effect["effect"] == "floor_patch":
            hit = judge.patch_overlaps(answer.top_cell("floor"), effect)
            if hit is not None:
                outcomes["floor"].append(hit)
    for axis, hits in outcomes.items():
        rows.append(Rate(f"right {'cell' if axis == 'floor' else axis}", hits, 0.95, 0.85))
    return rows


def next_run_rates(labels, results):
    """Groups that hold a true effect: does one more run leave that effect alone? The proposed run, and a random one."""
    outcomes = {"proposed": [], "random": []}
    for case_id, result in results.items():
        first = judge.Answer(result.get("diagnosis"))
        truth = judge.truth_of(labels[case_id])
        grouped = [c for c in first.causes if c.get("indistinguishable_from") and judge.group_of(c) & set(truth)]
        if not result.get("next_runs") or not grouped:
            continue
        for name in outcomes:
            again = judge.Answer((result["next_runs"].get(name) or {}).get("diagnosis"))
            outcomes[name].append(judge.settles(first, again, truth))
    return [Rate("the proposed next run settles the group", outcomes["proposed"], 0.8, 0.6),
            Rate("a random next run settles the group (control)", outcomes["random"], None, None)]


def again_rates(results):
    """A correction applied, and the corrected file diagnosed on another day."""
    told = [(result["diagnosis"]["verdict"], result["fresh_day"]["again"]) for result in results.values()
            if (result.get("fresh_day") or {}).get("again") and result.get("diagnosis")]
    quiet = lambda entries: [judge.Answer(again).verdict == "no_gap" for _, again in entries]
    whole = [(verdict, again) for verdict, again in told if verdict == "explained"]
    return [Rate("explained, corrected, diagnosed again on another day: no_gap", quiet(whole), 0.99, 0.96),
            Rate("any verdict, corrected, diagnosed again: no_gap", quiet(told), None, None),
            Rate("explained, corrected, diagnosed again: a name", [judge.Answer(again).gives_a_name for _, again in whole],
                 None, None)]


def shrink_values(labels, results):
    """The shrink that was said (fraction and interval) against that on a day that nobody saw."""
    covered, errors = [], []
    for case_id, result in results.items():
        answer = judge.Answer(result.get("diagnosis"))
        true = judge.true_shrink(result.get("fresh_day"))
        interval = answer.energy("shrink_interval_95")
        if true is None or not interval or not answer.gives_a_name or answer.energy("before_percent") < LEAST_GAP_percent:
            continue
        covered.append(interval[0] <= true <= interval[1])
        errors.append(abs(answer.energy("shrink_fraction") - true))
    share = sum(covered) / len(covered) if covered else float("nan")
    return [Within("interval of the shrink covers that of a fresh day", share, len(covered), (0.93, 0.97), (0.85, 1.0)),
            Value("shrink said against that of a fresh day, median difference", median(errors), len(errors), None, None)]


def values(cases, seconds):
    """The measures that are no proportions."""
    with_gap = [(l, a) for l, a in cases if l["bin"] == "single" and judge.detectable(l) and not a.silent
                and (a.energy("before_percent") or 0) > 2 and a.energy("shrink_fraction") is not None]
    shrink = [a.energy("shrink_fraction") for l, a in with_gap]
    of_ceiling = [a.energy("shrink_fraction") / a.raw["ceiling"]["shrink_fraction"] for l, a in with_gap
                  if (a.raw.get("ceiling") or {}).get("shrink_fraction", 0) > 0.05]
    detectable = [(l, a) for l, a in cases if judge.detectable(l) and l["bin"] in ("single", "pair")]
    errors = [e for l, a in detectable for e in judge.parameter_errors(a, l)]
    groups = [len(a.group_of_first) for l, a in detectable if a.names]
    told = [(a.probability, a.first in judge.truth_of(l)) for l, a in cases if a.gives_a_name]
    ece, brier, _ = calibration(told)
    mean = sum(groups) / len(groups) if groups else float("nan")
    result = [
        Value("held-out energy gap closed, median fraction of the gap (gap > 2 %)", median(shrink), len(shrink), 0.85, 0.6, True),
        Value("the same, of the ceiling", median(of_ceiling), len(of_ceiling), 0.95, 0.6, True),
        Value("median error of the effect's first parameter", median([e for _, e, _ in errors]), len(errors), 0.05, 0.15),
        Value("mean size of the named group", mean, len(groups), 1.5, 3.0),
        Value("expected calibration error of the probabilities", ece, len(told), 0.03, 0.08),
        Value("Brier score of the probabilities", brier, len(told), None, None),
        Value("run time of a diagnosis, median (s)", median(seconds), len(seconds), 2.0, 10.0),
    ]
    if seconds:
        result.append(Value("run time of a diagnosis, slowest (s)", max(seconds), len(seconds), None, None))
    return result


def power(cases):
    """Per effect: sizes with found or not, the smallest size found in 90 %, the smallest size the oracle detects."""
    table = {}
    for label, answer in cases:
        if label["bin"] != "single":
            continue
        effect = label["effects"][0]
        name, size = effect["effect"], abs(next(iter(effect["parameters"].values())))
        entry = table.setdefault(name, {"points": [], "parameter": next(iter(effect["parameters"]))})
        found = name in answer.group and not answer.silent
        entry["points"].append((size, found, judge.detectable(label)))
    for name, entry in table.items():
        inverse = name == "wheel_slip"  # a softer tyre is the larger effect
        scaled = [(1 / s if inverse else s, f) for s, f, _ in entry["points"]]
        best = smallest_found(scaled)
        entry["smallest_found"] = None if best is None else (1 / best if inverse else best)
        seen = [s for s, _, d in entry["points"] if d]
        entry["smallest_detectable"] = (max(seen) if inverse else min(seen)) if seen else None
        entry["found"] = sum(f for _, f, d in entry["points"] if d)
        entry["detectable"] = sum(d for _, _, d in entry["points"])
    return table


def confusion(cases):
    """Of detectable single effects: {true: {first name or verdict: count}}."""
    table = {}
    for label, answer in cases:
        if label["bin"] == "single" and not judge.detectable(label):
            continue
        if label["bin"] not in ("single", "null", "foreign"):
            continue
        true = label["effects"][0]["effect"] + (" (foreign)" if label["bin"] == "foreign" else "") if label["effects"] else "(null)"
        said = answer.first if answer.gives_a_name else f"({answer.verdict})"
        row = table.setdefault(true, {})
        row[said] = row.get(said, 0) + 1
    return table


def risk_coverage(cases):
    """Cases with a name, surest first: (share of the cases answered, share of wrong names among them)."""
    told = sorted(((a.probability, judge.wrong_name(a, l)) for l, a in cases
                   if l["bin"] in ("single", "pair", "null", "foreign") and a.gives_a_name), reverse=True)
    curve, wrong = [], 0
    for k, (probability, is_wrong) in enumerate(told, 1):
        wrong += is_wrong
        if k == len(told) or told[k][0] < probability:  # answers that are equally sure come together
            curve.append((k / max(1, len(cases)), wrong / k))
    return curve
