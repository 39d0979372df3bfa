"""Section on the diagnosis against regressions, on days of the blind benchmark's generator."""

import json
import subprocess
import tempfile
from pathlib import Path as File

import numpy as np

from common import ROOT, cpu_ms, package, spread, table
from regressions import METHODS, black_box, day_of, nominal_robot, regress

EFFECTS = {
    "rolling_resistance": 0.008,
    "coulomb_friction": 0.06,
    "dragging_wheel": 0.08,
    "viscous_friction": 0.01,
    "gear_efficiency": 0.1,
    "quadratic_drag": 2.0,
    "turning_scrub": 0.4,
    "payload_mass_error": 0.3,
    "center_of_mass_offset": 0.04,
    "yaw_inertia_error": 0.4,
    "winding_resistance_error": 0.12,
    "driver_voltage_drop": 0.2,
    "torque_constant_error": 0.05,
    "current_sensor_gain": 0.06,
    "current_sensor_offset": 0.05,
}
NULLS, RUNS = 8, 12


def run(size):
    package("scipy")
    package("pysindy")
    cases = list(EFFECTS.items())[: size(len(EFFECTS), 3)] + [("none", None)] * size(NULLS, 2)
    found = {name: [] for name in ("joulepath diagnose", *METHODS, "black box (polynomial)")}
    robot = nominal_robot()
    with tempfile.TemporaryDirectory() as scratch:
        for seed, (effect, value) in enumerate(cases):
            folder = File(scratch) / f"case_{seed}"
            command = [
                ROOT / "build/release/bin/blind_plant",
                "--effect",
                effect,
                "--robot",
                "nomad",
                "--protocol",
                str(RUNS),
                "--level",
                "1",
                "--seed",
                str(4000 + seed),
                "--out",
                folder,
                "--label",
                "none",
            ]
            subprocess.run(command + (["--size", str(value)] if value else []), check=True)
            diagnosed_ms, answer = cpu_ms(lambda: diagnose(folder))
            found["joulepath diagnose"].append((effect, *answer, diagnosed_ms))
            read_ms, runs = cpu_ms(lambda: day_of(folder, robot))
            for name, fit in METHODS.items():
                ms, (cause, energy) = cpu_ms(lambda: regress(fit, runs))
                found[name].append((effect, cause, energy, ms + read_ms))
            ms, (cause, energy) = cpu_ms(lambda: black_box(runs))
            found["black box (polynomial)"].append((effect, cause, energy, ms + read_ms))
    return report(cases, found)


def diagnose(folder):
    out = folder / "out"
    subprocess.run(
        [ROOT / "build/release/bin/joulepath", "diagnose", folder / "dataset.yaml", "--out", out, "--force", "-q"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    answer = json.loads((out / "diagnosis.json").read_text())
    causes = answer.get("causes") or []
    silent = answer["verdict"] in ("no_gap", "too_little_data", "unexplained") or not causes
    energy = answer.get("gap", {}).get("energy", {})
    before, after = energy.get("before_percent"), energy.get("after_percent")
    return (None if silent else causes[0]["effect"]), (before, after if after is not None else before)


def winners(found):
    """The best method by each measure, whoever it is."""
    named = {name: answers for name, answers in found.items() if not name.startswith("black")}
    best = lambda score, of: " and ".join(n for n in of if score(of[n]) == max(map(score, of.values())))
    right = lambda answers: sum(a[0] == a[1] for a in answers if a[0] != "none")
    quiet = lambda answers: -sum(a[1] is not None for a in answers if a[0] == "none")
    closed = lambda answers: round(
        float(np.median([1 - after / before for effect, _, (before, after), _ in answers if effect != "none" and before])), 3
    )
    quick = lambda answers: -float(np.median([a[3] for a in answers]))
    return (
        f"Best by right names: {best(right, named)}; by fewest false alarms: {best(quiet, named)}; by the gap closed: "
        f"{best(closed, found)}; by CPU time: {best(quick, found)}.\n\n"
    )


def report(cases, found):
    rows = []
    for name, answers in found.items():
        real, null = [a for a in answers if a[0] != "none"], [a for a in answers if a[0] == "none"]
        closed = [100 * (1 - after / before) for _, _, (before, after), _ in real if before]
        rows.append(
            [
                name,
                "none" if name.startswith("black") else f"{sum(a[0] == a[1] for a in real)} of {len(real)}",
                "none" if name.startswith("black") else f"{sum(a[1] not in (None, a[0]) for a in real)}",
                "none" if name.startswith("black") else f"{sum(a[1] is not None for a in null)} of {len(null)}",
                spread(closed, 2),
                spread([a[3] for a in answers]),
            ]
        )
    text = (
        f"{len(cases)} days of {RUNS} runs by the blind benchmark's generator (the Nomad, level 1: correlated noise, "
        "scatter, calibration errors), one cause each, or none. "
        "The diagnosis chooses its own held-out runs. Energy gap: sum of the absolute errors of the runs' motor energy.\n\n"
    )
    text += winners(found)
    return {
        "short": f"**Diagnosis against regressions**: {winners(found).strip()}",
        "text": text
        + table(
            [
                "method",
                "first name right",
                "wrong name",
                "false alarms on days without a cause",
                "held-out energy gap closed, %",
                "CPU ms",
            ],
            rows,
        ),
        "summary": {},
    }
