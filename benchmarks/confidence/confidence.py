"""Plans with a stated confidence, judged by machines that the planner does not know: calibrated from a simulated day, planned,
driven. Machines, days, motions and the judge are machine.py's; the program only calibrates and plans.

A mission is drawn so that a current, a voltage or the battery's reserve decides. Beside each plan stands a scenario program: the
least share of its limits with which 59 robots drawn from the calibrated file keep them.
"""

import argparse
import dataclasses
import json
import math
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

import numpy as np
import yaml

import machine as machines
import mujoco_machine

ROOT = pathlib.Path(__file__).resolve().parents[2]
CONFIDENCE = 0.95
SCENARIOS = 59  # draws that show 95 % where none of them fails: 0.95^59 < 0.05
ROUNDING = 1e-5
BINDS = ("current", "voltage", "reserve")
BY_MUJOCO = 10       # each tenth machine is MuJoCo's,
MOST_AHEAD = 0.05    # its mass up to this share of the half track before or behind the axle


def run(arguments, folder):
    """Exit code and CPU seconds of a command of the program."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(arguments, cwd=folder, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode > 1:
        raise SystemExit(f"{' '.join(map(str, arguments))}: {done.stderr}")
    return done.returncode, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


class Campaign:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def plan(self, robot, legs, objective, *more):
        (self.folder / "planned.yaml").write_text(robot)
        (self.folder / "mission.json").write_text(json.dumps({"robot": "planned.yaml", "legs": legs, "objective": objective}))
        code, cpu_s = run([self.program, "plan", "mission.json", "--out", "out", "--force", "--quiet", "--solver", "fast",
                           "--without", "baselines,path_bound", *more], self.folder)
        plan = json.loads((self.folder / "out/plan.json").read_text())
        rows = None if code else np.genfromtxt(self.folder / "out/trajectory.csv", delimiter=",", names=True)
        return plan, rows, cpu_s

    def calibrated(self, truth, base, kind, random):
        dataset = machines.write_day(self.folder, truth, base, kind, random)
        code, _ = run([self.program, "calibrate", dataset.name, "--out", "calibrated.yaml", "--force", "--quiet"], self.folder)
        if code:
            raise SystemExit(f"calibrate {kind}")
        return (self.folder / "calibrated.yaml").read_text()


def motion_of(rows):
    """Time, speed, its slope, yaw rate and its slope at the rows of a plan, and the payload."""
    time_s, w = rows["time_s"], rows["angular_speed_rad_s"]
    slope = np.zeros_like(w)
    slope[:-1] = np.diff(w) / np.maximum(np.diff(time_s), 1e-9)
    return time_s, rows["linear_speed_m_s"], rows["linear_acceleration_m_s2"], w, slope, rows["payload_kg"]


def demand(truth, rows):
    """Greatest current (A) and voltage (V) of a machine that drives the rows, and its energy (J)."""
    time_s, v, a, w, dw, payload = motion_of(rows)
    pieces = [truth.wheels(v, a, w, dw, kg) for kg in np.unique(payload)]
    current = np.select([payload == kg for kg in np.unique(payload)], [np.abs(p[0]) for p in pieces])
    voltage = np.select([payload == kg for kg in np.unique(payload)], [np.abs(p[1]) for p in pieces])
    signed = [np.select([payload == kg for kg in np.unique(payload)], [p[k] for p in pieces]) for k in (0, 1)]
    moves = np.abs(v) + np.abs(w) > 1e-9
    return (current * moves).max(), (voltage * moves).max(), truth.energy_J(time_s, signed[0] * moves, signed[1] * moves)


def with_keys(text, **keys):
    """A robot file with other numbers behind these keys; `max_current_A` is added where it is missing."""
    for key, value in keys.items():
        changed, count = re.subn(rf"\b{key}: [^,}}]+", f"{key}: {value:.9g}", text)
        text = changed if count else text.replace("max_voltage_V:", f"{key}: {value:.9g}, max_voltage_V:")
    return text


def machine_of(text, base):
    """A robot file as a machine, to draw scenarios from."""
    robot = yaml.safe_load(text)
    motor, inertia = robot["motor"], robot["inertia"]
    friction = motor["friction_torque_Nm"]
    pair = tuple(friction.values()) if isinstance(friction, dict) else (friction, friction)
    one = lambda value: value if not isinstance(value, dict) else sum(value.values()) / 2
    return robot, dataclasses.replace(
        base, chassis_kg=inertia["chassis_mass_kg"], yaw_inertia=inertia["chassis_yaw_inertia_kg_m2"],
        axle_inertia=inertia["wheel_axle_inertia_kg_m2"], ohm=one(motor["resistance_ohm"]),
        torque_constant=one(motor["torque_constant_Nm_A"]), viscous=one(motor["viscous_friction_Nm_s_rad"]), friction=pair)


FIELDS = {"chassis_mass_kg": "chassis_kg", "chassis_yaw_inertia_kg_m2": "yaw_inertia", "wheel_axle_inertia_kg_m2": "axle_inertia",
          "resistance_ohm": "ohm", "torque_constant_Nm_A": "torque_constant", "viscous_friction_Nm_s_rad": "viscous"}


def model_friction(robot, nominal, rows):
    """Relative change of the friction that changes the energy of motion along the rows by one sigma of the model's error."""
    time_s, v, _, w, _, _ = motion_of(rows)
    step = 0.01
    rougher = dataclasses.replace(nominal, friction=tuple(f * (1 + step) for f in nominal.friction))
    base = demand(nominal, rows)[2]
    motion_J = base - nominal.standby_W * (time_s[-1] - time_s[0])
    return robot["uncertainty"].get("model_energy", 0.0) * motion_J * step / (demand(rougher, rows)[2] - base)


def scenario(robot, nominal, friction_sigma, random):
    """A machine drawn from the errors that a file states, with their correlations, and the model's own as friction."""
    sigmas = {k: s for k, s in robot["uncertainty"].items() if k in FIELDS or k == "friction_torque_Nm"}
    keys = [k for k in sigmas if k != "friction_torque_Nm"]
    places = {k: [i] for i, k in enumerate(keys)}
    if "friction_torque_Nm" in sigmas:
        places["friction_torque_Nm"] = [len(keys), len(keys) + 1]
    count = sum(len(p) for p in places.values())
    matrix = np.eye(count)
    for entry in robot.get("uncertainty_correlations", []):
        for i in places.get(entry["first"], []):
            for j in places.get(entry["second"], []):
                matrix[i, j] = matrix[j, i] = entry["correlation"]
    low = np.linalg.eigvalsh(matrix).min()
    if low < 1e-6:
        matrix += (1e-6 - low) * np.eye(count)
    errors = np.linalg.cholesky(matrix) @ random.normal(size=count)
    values = {FIELDS[k]: getattr(nominal, FIELDS[k]) * (1 + sigmas[k] * errors[places[k][0]]) for k in keys}
    if "friction_torque_Nm" in sigmas:
        values["friction"] = tuple(f * (1 + sigmas["friction_torque_Nm"] * errors[i]) for f, i in
                                   zip(nominal.friction, places["friction_torque_Nm"]))
    of_model = 1 + friction_sigma * random.normal()
    values["friction"] = tuple(f * of_model for f in values.get("friction", nominal.friction))
    return dataclasses.replace(nominal, **values)


def case(campaign, seed):
    random = np.random.default_rng([2026, seed])
    kind, binds = random.choice(list(machines.BASES)), BINDS[seed % len(BINDS)]
    base = machines.BASES[kind]
    truth = machines.true_machine(base, random)
    by_mujoco = seed % BY_MUJOCO == BY_MUJOCO - 1
    if by_mujoco:
        truth = mujoco_machine.in_mujoco(truth, MOST_AHEAD * base.half_track * float(random.uniform(-1, 1)))
    text = campaign.calibrated(truth, base, kind, random)
    legs = machines.mission_legs(kind, random)
    robot, nominal = machine_of(text, base)
    load = max(leg["payload_kg"] for leg in legs)
    top = machines.SPEED_m_s[kind] * float(random.uniform(0.7, 1.0))
    gain = float(random.uniform(0.4, 0.8))
    low, _ = nominal.wheels(np.array([0.01]), np.array([gain]), np.array([0.0]), np.array([0.0]), load)
    _, high = nominal.wheels(np.array([top]), np.array([0.3 * gain]), np.array([0.0]), np.array([0.0]), load)
    current_A, voltage_V = float(np.abs(low).max()), float(np.abs(high).max())
    if binds == "current":
        text = with_keys(text, max_current_A=current_A, speed_m_s=top)
    if binds == "voltage":
        text = with_keys(text, max_current_A=1.5 * current_A, max_voltage_V=voltage_V)
    if binds == "reserve":
        text = with_keys(text, max_current_A=1.5 * current_A, speed_m_s=top)
    objective = {"minimize": "time"} if binds != "reserve" else {"minimize": "energy"}
    plain, plain_rows, plain_cpu = campaign.plan(text, legs, objective)
    if plain_rows is None:
        return None
    if binds == "reserve":
        text = with_keys(text, capacity_Wh=plain["energy_J"] / 3600 / 0.9 * float(random.uniform(1.0, 1.15)))
        plain, plain_rows, plain_cpu = campaign.plan(text, legs, objective)
        if plain_rows is None:
            return None
    robot, nominal = machine_of(text, base)
    of_day = dataclasses.replace(truth, friction=tuple(f * (1 + 0.01 * random.normal()) for f in truth.friction))

    def kept(rows):
        most_A, most_V, energy_J = demand(of_day, rows)
        return {"limits": most_A <= robot["motor"]["max_current_A"] * (1 + ROUNDING) and most_V <= robot["motor"]["max_voltage_V"] * (1 + ROUNDING),
                "reserve": energy_J <= 0.9 * robot["battery"]["capacity_Wh"] * 3600}

    plan, rows, cpu = campaign.plan(text, legs, objective, "--confidence", str(CONFIDENCE))
    result = {"seed": seed, "kind": kind, "binds": binds, "by_mujoco": by_mujoco, "plain_cpu_s": plain_cpu, "cpu_s": cpu, "refused": rows is None,
              "model_energy": robot["uncertainty"].get("model_energy"), "plain_kept": kept(plain_rows),
              "said_plain": plan["confidence"]["kept_without_margins"]}
    if rows is not None:
        account = plan["confidence"]
        result |= {"kept": kept(rows), "said": account["kept"], "binding": [p["name"] for p in account["promises"] if p["binds"]],
                   "cost_J": plan["energy_J"] / plain["energy_J"] - 1, "cost_s": plan["duration_s"] / plain["duration_s"] - 1}
    if binds != "reserve":
        sigma = model_friction(robot, nominal, plain_rows)
        drawn = [demand(scenario(robot, nominal, sigma, random), plain_rows) for _ in range(SCENARIOS)]
        own = demand(nominal, plain_rows)
        shares = {"max_current_A": min(1.0, own[0] / max(d[0] for d in drawn)), "max_voltage_V": min(1.0, own[1] / max(d[1] for d in drawn))}
        other, other_rows, _ = campaign.plan(with_keys(text, **{k: s * robot["motor"][k] for k, s in shares.items()}), legs, objective)
        if other_rows is not None:
            result |= {"scenario_kept": kept(other_rows)["limits"], "scenario_cost_s": other["duration_s"] / plain["duration_s"] - 1}
    return result


def interval(kept, count):
    """95 % interval of a share (Wilson)."""
    if count == 0:
        return 0.0, 1.0
    z, p = 1.959964, kept / count
    middle, half = p + z * z / (2 * count), z * math.sqrt(p * (1 - p) / count + z * z / (4 * count * count))
    return max(0.0, (middle - half) / (1 + z * z / count)), (middle + half) / (1 + z * z / count)


def share_text(values):
    low, high = interval(sum(values), len(values))
    return f"{sum(values)} of {len(values)} ({100 * low:.1f} to {100 * high:.1f} %)" if values else "-"


def median_text(values, form="{:.2f}"):
    return form.format(float(np.median(values))) if len(values) else "-"


def page(results, note):
    def row(name, chosen, promise):
        planned = [r for r in chosen if not r["refused"]]
        binding = [r for r in planned if r["binding"]]
        return (f"| {name} | {len(chosen)} | {sum(r['refused'] for r in chosen)} | {share_text([r['kept'][promise] for r in binding])} | "
                f"{share_text([r['kept'][promise] for r in planned if not r['binding']])} | {share_text([r['plain_kept'][promise] for r in chosen])} | "
                f"{100 * float(np.median([r['cost_s'] for r in binding])) if binding else 0:.1f} % |")
    lines = ["# Plans with a stated confidence", "", note, "",
             f"Asked: {CONFIDENCE}. Each machine is drawn anew, calibrated from its own simulated day of 24 runs and driven once along the plan.",
             "Its friction depends on the speed (0 to 6 % more at standstill) and differs by 1 % from run to run: the planner's model has neither.",
             f"The dynamics of each tenth one are MuJoCo's, with the chassis' mass up to {100 * MOST_AHEAD:.0f} % of the half track before or behind the axle, which its",
             "file does not say.",
             "", "| decides | missions | refused | kept, a margin binds | kept, none binds | kept without margins | longer, median |", "|---|---:|---:|---|---|---|---:|"]
    for binds, promise in (("current", "limits"), ("voltage", "limits"), ("reserve", "reserve")):
        lines.append(row(binds, [r for r in results if r["binds"] == binds], promise))
    limited = [r for r in results if r["binds"] != "reserve"]
    lines.append(row("**current or voltage**", limited, "limits"))
    for kind in machines.BASES:
        lines.append(row(f"the same, {kind}", [r for r in limited if r["kind"] == kind], "limits"))
    for name, chosen, promise in (("current or voltage", limited, "limits"), ("reserve", [r for r in results if r["binds"] == "reserve"], "reserve")):
        lines.append(row(f"{name}, by MuJoCo", [r for r in chosen if r["by_mujoco"]], promise))
    own = lambda r: r["kept"]["reserve" if r["binds"] == "reserve" else "limits"]
    bound = [r for r in results if not r["refused"] and r["binding"]]
    lines += ["", f"All three together, a margin binds: kept {share_text([own(r) for r in bound])}. A plan of least energy can save nothing more for its",
              "reserve: it keeps it more often than asked, or is refused."]
    both = [r for r in limited if not r["refused"] and "scenario_kept" in r]
    def greatest(refused):
        return f"{max((r['cpu_s'] / r['plain_cpu_s'] for r in results if r['refused'] == refused), default=math.nan):.2f}"

    lines += ["", "| beside each other, missions that both plan | kept | longer than without margins, median |", "|---|---|---:|",
              f"| margins of the joint quantile | {share_text([r['kept']['limits'] for r in both])} | {100 * float(np.median([r['cost_s'] for r in both])):.2f} % |",
              f"| scenario program, {SCENARIOS} draws | {share_text([r['scenario_kept'] for r in both])} | {100 * float(np.median([r['scenario_cost_s'] for r in both])):.2f} % |",
              "", f"CPU time of a plan with confidence, relative to the plain one: median {median_text([r['cpu_s'] / r['plain_cpu_s'] for r in results])}, "
              f"greatest {greatest(False)} of missions that are planned, {greatest(True)} of refused ones (median of the plain ones {median_text([r['plain_cpu_s'] for r in results])} s).",
              f"`model_energy` of the calibrated files: median {median_text([r['model_energy'] for r in results if r['model_energy']], '{:.4f}')}.", ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/joulepath"))
    parser.add_argument("--machines", type=int, default=200)
    parser.add_argument("--rows", type=pathlib.Path, default=ROOT / "build/confidence.jsonl", help="answers so far: a further call goes on")
    parser.add_argument("--note", default="")
    parser.add_argument("--out", type=pathlib.Path)
    options = parser.parse_args()
    done = [json.loads(line) for line in options.rows.read_text().splitlines()] if options.rows.exists() else []
    known = {r["seed"] for r in done}
    for base in machines.BASES.values():
        mujoco_machine.check_against(base)
    with tempfile.TemporaryDirectory() as folder, options.rows.open("a") as rows:
        campaign = Campaign(pathlib.Path(options.program).resolve(), pathlib.Path(folder))
        for seed in range(options.machines):
            if seed in known:
                continue
            result = case(campaign, seed) or {"seed": seed, "skipped": True}
            rows.write(json.dumps(result, default=lambda x: x.item()) + "\n")
            rows.flush()
            done.append(result)
    text = page([r for r in done if "skipped" not in r and r["seed"] < options.machines], options.note)
    if options.out:
        options.out.write_text(text)
    sys.stdout.write(text)


if __name__ == "__main__":
    main()
