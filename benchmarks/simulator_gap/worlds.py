"""A robot and the simulator of its user, as pairs of logs: the simulator lacks the effects that a case hides.

program  both are driven by `joulepath simulate`. The robot's constants may be others than the file's, the simulator's are the
         robot's own. The simulator has no noise, or noise of its own, or other wheel-speed loops and so another motion.
plant    both are driven by `blind_plant`, which shares no code with the program: the same machine with and without the
         effects. The simulator has a fiftieth of the noise.
"""
import json
import pathlib
import random
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks/null_days"))
import days  # noqa: E402

MISSIONS, REPEATS = ("test", "test_loaded", "back", "bend"), 3
# Factors on constants of the robot file, 1 sigma: a robot that nobody calibrated.
OTHER = {"resistance_ohm": 0.1, "friction_torque_Nm": 0.2, "chassis_mass_kg": 0.1, "viscous_friction_Nm_s_rad": 0.2}
PLANT_EFFECTS = ("rolling_resistance", "coulomb_friction", "viscous_friction", "dragging_wheel", "turning_scrub", "gear_efficiency",
                 "quadratic_drag", "payload_mass_error", "winding_resistance_error", "torque_constant_error", "driver_voltage_drop",
                 "current_sensor_gain")
PAIRED = ("rolling_resistance", "coulomb_friction", "turning_scrub", "winding_resistance_error", "payload_mass_error", "dragging_wheel")


def other_robot(text, draw):
    """The file with other constants; left and right alike."""
    constants, uncertainty = text.split("uncertainty:")
    for key, sigma in OTHER.items():
        factor = max(0.5, 1 + sigma * draw.gauss(0, 1))
        scaled = lambda number: f"{float(number[0]) * factor:.6g}"
        constants = re.sub(rf"\b{key}: (\{{[^}}]*\}}|[\d.]+)", lambda entry: re.sub(r"(?<![\w.])\d+\.?\d*", scaled, entry[0]), constants)
    return constants + "uncertainty:" + uncertainty


def with_predictions(folder):
    """The dataset of both logs: those of the simulator stand in `sim`, one for each run or one for each input."""
    lines, given = [], sorted((folder / "sim").glob("run_*.csv"))
    text = (folder / "dataset.yaml").read_text()
    runs = text.count("file: run_")
    for line in text.splitlines():
        found = re.search(r"file: run_(\d+)\.csv", line)
        if found:
            place = (int(found[1]) - 1) * len(given) // runs
            line = line.replace(found[0], f"{found[0]}, predicted: sim/{given[place].name}")
        lines.append(line)
    (folder / "against.yaml").write_text("\n".join(lines) + "\n")
    return folder / "against.yaml"


def program_world(program, case, folder, keep):
    draw = random.Random(json.dumps(case, sort_keys=True))
    file = days.robot_file(program, "starter", keep)
    robot = folder / "robot_of_world.yaml"
    folder.mkdir(parents=True, exist_ok=True)
    robot.write_text(other_robot(file.read_text(), draw) if case["plant"] == "other" else file.read_text())
    inputs = [days.planned(program, "starter", name, keep) for name in MISSIONS]
    effects = dict(days.effects(program))
    options = lambda names: [word for name in names for word in ("--effect", effects[name])]
    days.run(program, "simulate", *inputs, "--robot", robot, "--repeat", REPEATS, "--seed", draw.randrange(1 << 30),
             *options(case["shared"] + case["hidden"]), "--out", folder, "--quiet", "--force")
    how = {"exact": ("--ideal-sensors",), "noisy": ("--repeat", REPEATS), "other loops": ("--ideal-sensors", "--no-feed-forward", "--bandwidth-per-s", 4)}
    days.run(program, "simulate", *inputs, "--robot", robot, "--seed", draw.randrange(1 << 30), *how[case["simulator"]],
             *options(case["shared"]), "--out", folder / "sim", "--quiet", "--force")
    (folder / "robot.yaml").write_text(file.read_text())
    return with_predictions(folder)


def plant_world(plant, case, folder):
    def driven(names, where, *more):
        share = ("--share", ",".join(["0.7"] * len(names))) if names else ()
        subprocess.run([plant, "--effect", ",".join(names) or "none", *share, "--protocol", "12", "--seed", str(case["seed"]),
                        "--robot", case["plant"], "--label", "none", "--out", where, *more], check=True, capture_output=True)
    driven(case["shared"] + case["hidden"], folder)
    driven(case["shared"], folder / "sim", "--noise", "0.02")
    return with_predictions(folder)


def cases(program, seeds):
    """Nulls, single effects and pairs of both families; the first seeds have some of every kind."""
    names = [name for name, _ in days.effects(program)]
    simulators = ("exact", "noisy", "other loops")
    for seed in range(seeds):
        draw = random.Random(seed)
        for simulator in simulators:
            for plant in ("file", "other"):
                for shared in ([], [draw.choice(PAIRED)]):
                    yield {"family": "program", "kind": "null", "plant": plant, "simulator": simulator, "shared": shared, "hidden": [], "seed": seed}
        for k, name in enumerate(names):
            yield {"family": "program", "kind": "single", "plant": ("file", "other")[(k + seed) % 2], "simulator": simulators[(k + seed) % 3],
                   "shared": [draw.choice([n for n in PAIRED if n != name])] if k % 4 == 0 else [], "hidden": [name], "seed": seed}
        for k in range(12):
            yield {"family": "program", "kind": "pair", "plant": ("file", "other")[k % 2], "simulator": simulators[k % 3], "shared": [],
                   "hidden": sorted(draw.sample(PAIRED, 2)), "seed": 100 * seed + k}
        for k in range(8):
            yield {"family": "plant", "kind": "null", "plant": ("nomad", "warehouse")[k % 2], "simulator": "exact",
                   "shared": [draw.choice(PAIRED)] if k % 4 > 1 else [], "hidden": [], "seed": 1000 * seed + 500 + k}
        for k, name in enumerate(PLANT_EFFECTS):
            yield {"family": "plant", "kind": "single", "plant": ("nomad", "warehouse")[k % 2], "simulator": "exact", "shared": [],
                   "hidden": [name], "seed": 1000 * seed + k}
        for k in range(6):
            yield {"family": "plant", "kind": "pair", "plant": ("nomad", "warehouse")[k % 2], "simulator": "exact", "shared": [],
                   "hidden": sorted(draw.sample(PAIRED, 2)), "seed": 1000 * seed + 300 + k}
