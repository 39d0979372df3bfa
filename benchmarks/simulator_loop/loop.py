"""The loop of a user of MuJoCo: logs of a real robot, the user's model that drives them, a diagnosis, its patch, the patched model.

The "real" robot is another MuJoCo model: that of `export --to mjcf` with its XML changed by hand (no effect of the catalog is
called), with noise on its logs. Where its motors have other constants, so has the robot file that turns its torques into
currents: its logs are those of a robot that has them. Day A is diagnosed; day B, of other motions, judges the patched model: sum over runs of the
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

from joulepath import Robot
from joulepath.simulators.mujoco import predict

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/bin/joulepath"
ROBOTS = ("nomad_super_scout", "amr_150kg")
DAY_A, DAY_B = 8, 3
SHORT = ("nothing", "friction of the right wheel", "winding resistance", "friction and torque constant")
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


FRICTION = {"coulomb_friction", "rolling_resistance"}  # one constant torque per wheel: the same physics in runs of one payload
DRAG, DAMPING, CONSTANT, RESISTANCE = {"dragging_wheel (right)"}, {"viscous_friction"}, {"torque_constant_error"}, {"winding_resistance_error"}
KT, OHM = 1.08, 1.6  # factors of torque and voltage constant, and of the winding resistance


def changes(scale_Nm):
    """Hidden differences between robot and model: change of the XML, factors of the motors' constants and of their resistance,
    and per hidden difference the names of the catalog that say it."""
    drag = lambda t: friction(t, "right", 0.6 * scale_Nm)
    damping = lambda t: scaled(t, "joint name", "damping", 1, offset=0.25 * scale_Nm)
    return {
        "nothing": (lambda t: t, (1, 1), []),
        "friction of both wheels": (lambda t: both(t, 0.5 * scale_Nm), (1, 1), [FRICTION]),
        "friction of the right wheel": (drag, (1, 1), [DRAG]),
        "damping": (damping, (1, 1), [DAMPING]),
        "torque constant": (lambda t: t, (KT, 1), [CONSTANT]),
        "winding resistance": (lambda t: t, (1, OHM), [RESISTANCE]),
        "friction and torque constant": (lambda t: both(t, 0.5 * scale_Nm), (KT, 1), [FRICTION, CONSTANT]),
        "right wheel and damping": (lambda t: damping(drag(t)), (1, 1), [DRAG, DAMPING]),
    }


def with_motors(robot, constant, resistance):
    """The robot with Kt and Kv (one constant in SI units) and R times these factors."""
    times = lambda value, factor: {side: one * factor for side, one in value.items()} if hasattr(value, "items") else value * factor
    factors = {"torque_constant_Nm_A": constant, "voltage_constant_V_s_rad": constant, "resistance_ohm": resistance}
    return robot.replace(motor={name: times(robot.motor[name], factor) for name, factor in factors.items()})


def told(cause):
    """The name of a cause, with its side where it has one: "dragging_wheel (right)"."""
    side = cause["parameters"].get("side")
    return f"{cause['effect']} ({side['value']})" if side else cause["effect"]


def judged(names, hidden):
    """Names beyond the hidden differences, of which each takes one name, and hidden differences without a name."""
    beyond = list(names)
    for said in hidden:
        mine = next((name for name in beyond if name in said), None)
        if mine:
            beyond.remove(mine)
    return len(beyond), len(hidden) - (len(names) - len(beyond))


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


def case(robot, change, constants, seed, folder):
    draw = np.random.default_rng(seed)
    file = ROOT / f"scenarios/robots/{robot}.yaml"
    model, real_model = folder / "own.xml", folder / "real.xml"
    joulepath("export", file, "--to", "mjcf", "--out", model, "--quiet")
    real_model.write_text(change(motors(model.read_text(), *constants)))
    real_robot = with_motors(Robot.load(file), *constants)
    drives = list(motions(draw, DAY_A + DAY_B))
    real = [measured(predict(real_model, real_robot, drive), draw) for drive in drives]
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
    return {"verdict": answer["verdict"], "names": [told(cause) for cause in answer["causes"]],
            "before": gap_percent(real[DAY_A:], simulated[DAY_A:]), "after": gap_percent(real[DAY_A:], again),
            "not_in_model": [one["effect"] for one in patch["not_in_model"]], "same": patched.read_text() == model.read_text()}


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--seeds", type=int, default=2)
    options.add_argument("--short", action="store_true", help="one robot, one seed, some changes; writes no result")
    options.add_argument("--note", default="")
    options = options.parse_args()
    rows, closed, widened, verdicts = [], [], [], []
    for robot in ROBOTS[:1] if options.short else ROBOTS:
        scale_Nm = {"nomad_super_scout": 0.2, "amr_150kg": 1.0}[robot]
        for name, (change, constants, hidden) in changes(scale_Nm).items():
            if options.short and name not in SHORT:
                continue
            for seed in range(1 if options.short else options.seeds):
                with tempfile.TemporaryDirectory() as scratch:
                    found = case(robot, change, constants, seed, pathlib.Path(scratch))
                more, less = judged(found["names"], hidden)
                verdicts.append((more, less, len(hidden)))
                if hidden:
                    closed.append(1 - found["after"] / found["before"])
                widened.append(found["after"] - found["before"])
                rows.append(f"| {robot} | {name} | {seed} | {found['verdict']} | {', '.join(found['names']) or '-'} | {more or '-'} | {less or '-'} | {found['before']:.2f} | {found['after']:.2f} | {'unchanged' if found['same'] else 'patched'} |")
                print(rows[-1], flush=True)
    beyond, missing, differences = (sum(column) for column in zip(*verdicts))
    right = sum(not row[0] and not row[1] for row in verdicts)
    text = "\n".join([
        "# A user's MuJoCo model, patched", "", options.note, "",
        "Robot and model are MuJoCo models that differ in what the row names, by hand in the XML; the robot's logs have noise,",
        f"and its motors the changed constants. Day A ({DAY_A} runs) is diagnosed with `--simulator-model`. Day B ({DAY_B} runs of",
        "other motions) is driven by the model before and after its patch: difference of the motors' energies, in percent of the",
        "measured ones.", "",
        f"- Share of the gap that the patch closes: median {statistics.median(closed):.3f}, least {min(closed):.3f} ({len(closed)} cases).",
        f"- Greatest widening of a gap, in points: {max(widened):+.2f}.",
        f"- Cases with exactly the hidden names: {right} of {len(rows)}. Names beyond them: {beyond}, in {sum(row[0] > 0 for row in verdicts)} cases. Hidden",
        f"  differences without a name: {missing} of {differences}.",
        "- A difference takes one name, with its side. Coulomb friction and rolling resistance count as one: in runs of one payload",
        "  both are a constant torque of each wheel. All other names differ.", "",
        "| robot | hidden change | seed | verdict | names | beyond | missing | gap before, % | after, % | model |",
        "|---|---|---:|---|---|---:|---:|---:|---:|---|", *rows, ""])
    print(text)
    if not options.short:
        (ROOT / "benchmarks/results" / "simulator_loop.md").write_text(text)
    return 1 if options.short and (beyond or missing or max(widened) > 0.2 or min(closed) < 0.6) else 0


if __name__ == "__main__":
    sys.exit(main())
