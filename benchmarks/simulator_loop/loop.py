"""The loop of a user of MuJoCo: logs of a real robot, the user's model that drives them, a diagnosis, its patch, the patched model.

The "real" robot is another MuJoCo model: that of `export --to mjcf` with its XML changed by hand (no effect of the catalog is
called), with noise on its logs. Day A is diagnosed; day B, of other motions, judges the patched model: sum over runs of the
difference of the motors' energies, over the sum of the measured ones.
"""
import argparse
import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

import numpy as np

from joulepath.simulators.mujoco import predict, read_log

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/bin/joulepath"
ROBOTS = ("nomad_super_scout", "amr_150kg")
DAY_A, DAY_B = 8, 3
NOISE = {"motor_current": 0.02, "motor_voltage": 0.02, "wheel_speed": 0.01, "gyro": 0.002, "position": 0.002, "heading": 0.001}  # 1 sigma; A, V, rad/s, rad/s, m, rad


def scaled(text, element, attribute, factor, which=0, offset=0.0):
    """One number of an attribute of every element of that kind (or of the one that a mark names) times a factor."""
    def change(match):
        numbers = match[2].split()
        numbers[which] = repr(float(numbers[which]) * factor + offset)
        return f'{match[1]}{" ".join(numbers)}"'
    changed, count = re.subn(rf'(<{element}[^>]*?\b{attribute}=")([^"]*)"', change, text)
    assert count, (element, attribute)
    return changed


def friction(text, side, more_Nm):
    return scaled(text, f'joint name="{side}"', "frictionloss", 1, offset=more_Nm)


def both(text, more_Nm):
    return friction(friction(text, "left", more_Nm), "right", more_Nm)


def motors(text, constant, resistance):
    """Actuators with K/R and -K Kv/R."""
    text = scaled(text, "general", "gainprm", constant / resistance)
    return scaled(text, "general", "biasprm", constant**2 / resistance, which=2)


def changes(scale_Nm):
    """Hidden differences between robot and model; the first names are those of the catalog that say it."""
    return {
        "nothing": (lambda t: t, set()),
        "friction of both wheels": (lambda t: both(t, 0.5 * scale_Nm), {"coulomb_friction", "rolling_resistance"}),
        "friction of the right wheel": (lambda t: friction(t, "right", 0.6 * scale_Nm), {"dragging_wheel"}),
        "damping": (lambda t: scaled(t, "joint name", "damping", 1, offset=0.25 * scale_Nm), {"viscous_friction"}),
        "torque constant": (lambda t: motors(t, 1.08, 1), {"torque_constant_error"}),
        "winding resistance": (lambda t: motors(t, 1, 1.6), {"winding_resistance_error"}),
        "friction and torque constant": (lambda t: motors(both(t, 0.5 * scale_Nm), 1.08, 1), {"coulomb_friction", "rolling_resistance", "torque_constant_error"}),
        "right wheel and damping": (lambda t: scaled(friction(t, "right", 0.6 * scale_Nm), "joint name", "damping", 1, offset=0.25 * scale_Nm), {"dragging_wheel", "viscous_friction"}),
    }


def joulepath(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{arguments}: {done.stderr.strip()}")
    return done.stdout


def motions(draw, count):
    """Speeds as a driver gives them: straight legs, bends and turns in place, both directions."""
    for _ in range(count):
        v, w = [0.0], [0.0]
        for _ in range(draw.integers(4, 7)):
            kind = draw.choice(["straight", "bend", "turn"])
            speed = 0.0 if kind == "turn" else draw.choice([1, 1, 1, -0.6]) * draw.uniform(0.3, 0.9)
            rate = 0.0 if kind == "straight" else draw.choice([-1, 1]) * draw.uniform(0.3, 1.0)
            ramp, hold = int(50 * draw.uniform(1.5, 3)), int(50 * draw.uniform(2, 5))
            shape = np.concatenate([np.linspace(0, 1, ramp), np.ones(hold), np.linspace(1, 0, ramp), np.zeros(25)])
            v, w = [*v, *(speed * shape)], [*w, *(rate * shape)]
        time_s = 0.02 * np.arange(len(v))
        yield {"time_s": time_s, "command_linear_speed_m_s": np.array(v), "command_angular_speed_rad_s": np.array(w)}


def measured(columns, draw):
    sigma = lambda name: next((value for key, value in NOISE.items() if name.startswith(key)), 0.0)
    return {name: column + draw.normal(0, sigma(name), len(column)) if sigma(name) else column for name, column in columns.items()}


def save(file, columns):
    file.write_text(",".join(columns) + "\n" + "\n".join(",".join(map(repr, row)) for row in zip(*(c.tolist() for c in columns.values()))) + "\n")


def energy_J(log):
    power = sum(log[f"motor_voltage_{side}_V"] * log[f"motor_current_{side}_A"] for side in ("left", "right"))
    return float(np.trapezoid(power, log["time_s"]))


def gap_percent(real, simulated):
    return 100 * sum(abs(energy_J(s) - energy_J(r)) for r, s in zip(real, simulated)) / sum(abs(energy_J(r)) for r in real)


def case(robot, change, seed, folder):
    draw = np.random.default_rng(seed)
    file = ROOT / f"scenarios/robots/{robot}.yaml"
    model, real_model = folder / "own.xml", folder / "real.xml"
    joulepath("export", file, "--to", "mjcf", "--out", model, "--quiet")
    real_model.write_text(change(model.read_text()))
    drives = list(motions(draw, DAY_A + DAY_B))
    real = [measured(predict(real_model, file, drive), draw) for drive in drives]
    commanded = [{**log, **{k: v for k, v in drive.items() if k.startswith("command")}} for log, drive in zip(real, drives)]
    simulated = [predict(model, file, log) for log in commanded]
    lines = [f"robot: {file}", "runs:"]
    for k in range(DAY_A):
        save(folder / f"real_{k}.csv", commanded[k])
        save(folder / f"sim_{k}.csv", simulated[k])
        lines.append(f"  - {{file: real_{k}.csv, predicted: sim_{k}.csv, payload_kg: 0}}")
    (folder / "day.yaml").write_text("\n".join(lines) + "\n")
    joulepath("diagnose", folder / "day.yaml", "--out", folder / "out", "--simulator-model", model, "--quiet")
    answer = json.loads((folder / "out/diagnosis.json").read_text())
    patch = json.loads((folder / "out/simulator_patch.json").read_text())
    patched = folder / "out" / patch["patched"]
    again = [predict(patched, file, log) for log in commanded[DAY_A:]]
    return {"verdict": answer["verdict"], "names": [cause["effect"] for cause in answer["causes"]],
            "before": gap_percent(real[DAY_A:], simulated[DAY_A:]), "after": gap_percent(real[DAY_A:], again),
            "not_in_model": [one["effect"] for one in patch["not_in_model"]], "same": patched.read_text() == model.read_text()}


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--seeds", type=int, default=2)
    options.add_argument("--short", action="store_true", help="one robot, one seed, three changes; writes no result")
    options.add_argument("--note", default="")
    options = options.parse_args()
    rows, closed, widened = [], [], []
    wrong = 0
    for robot in ROBOTS[:1] if options.short else ROBOTS:
        scale_Nm = {"nomad_super_scout": 0.2, "amr_150kg": 1.0}[robot]
        for name, (change, said) in list(changes(scale_Nm).items())[: 3 if options.short else None]:
            for seed in range(1 if options.short else options.seeds):
                with tempfile.TemporaryDirectory() as scratch:
                    found = case(robot, change, seed, pathlib.Path(scratch))
                wrong += bool(set(found["names"]) - said)
                if said:
                    closed.append(1 - found["after"] / found["before"])
                widened.append(found["after"] - found["before"])
                told = ", ".join(found["names"]) or "-"
                rows.append(f"| {robot} | {name} | {seed} | {found['verdict']} | {told} | {found['before']:.2f} | {found['after']:.2f} | {'unchanged' if found['same'] else 'patched'} |")
                print(rows[-1], flush=True)
    text = "\n".join([
        "# A user's MuJoCo model, patched", "", options.note, "",
        "Robot and model are MuJoCo models that differ in what the row names, by hand in the XML; the robot's logs have noise. Day A",
        f"({DAY_A} runs) is diagnosed with `--simulator-model`. Day B ({DAY_B} runs of other motions) is driven by the model before and after its",
        "patch: difference of the motors' energies, in percent of the measured ones.", "",
        f"- Share of the gap that the patch closes: median {statistics.median(closed):.3f}, least {min(closed):.3f} ({len(closed)} cases).",
        f"- Greatest widening of a gap, in points: {max(widened):+.2f}.",
        f"- Cases with a name that the change does not have: {wrong} of {len(rows)}.", "",
        "| robot | hidden change | seed | verdict | names | gap before, % | after, % | model |", "|---|---|---:|---|---|---:|---:|---|", *rows, ""])
    print(text)
    if not options.short:
        (ROOT / "benchmarks/results" / "simulator_loop.md").write_text(text)
    return 1 if options.short and (wrong or max(widened) > 0.2 or min(closed) < 0.6) else 0


if __name__ == "__main__":
    sys.exit(main())
