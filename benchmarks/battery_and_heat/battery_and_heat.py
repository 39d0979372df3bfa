"""A tug of 600 kg: missions with a full and a nearly empty battery, ten starts of motors that heat.

The temperatures are integrated once more, by explicit steps and without the program's code, along trajectory.csv and along the
currents of a MuJoCo model (`export --to mjcf`) that drives the plan. Fails where one of them is more than 2 K from plan.json.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np

from joulepath.simulators.mujoco import predict, read_log

ROOT = pathlib.Path(__file__).resolve().parents[2]
CURVE = [(0.0, 26.0), (0.1, 29.0), (0.5, 32.0), (0.9, 33.5), (1.0, 35.0)]  # 10 cells of LiFePO4, rounded: few for the motors
BATTERY_OHM = 0.25  # an aged battery with its cables
THERMAL = {"resistance_K_W": 1.3, "ambient_C": 30}
CAPACITIES_J_K = (280, 4)  # time constants of 364 s, and of 5.2 s as of small motors
COOL_C, SHARE = 155, 0.6   # a limit far away, and one at a share of the rise with that limit
STEP_S = 0.02
STARTS = 10
LINE_M = 8
LOAD_kg = 500
AGREED_K = 2


def robot_text(battery=True, thermal=None):
    """With a limit of the windings the load is part of the chassis, because the MuJoCo model carries no payload."""
    text = (ROOT / "scenarios/robots/tug_600kg.yaml").read_text()
    lines = text.splitlines()
    if battery:
        points = ", ".join(f"{{fraction: {z}, V: {v}}}" for z, v in CURVE)
        line = f"battery: {{capacity_Wh: 1200, internal_resistance_ohm: {BATTERY_OHM}, reserve_fraction: 0.05, open_circuit_voltage: [{points}]}}"
        lines = [line if old.startswith("battery:") else old for old in lines]
    if thermal is not None:
        lines = [old.replace("584.0", f"{584.0 + LOAD_kg}") if old.startswith("  chassis_mass_kg:") else old for old in lines]
        line = "  thermal: {" + ", ".join(f"{key}: {value}" for key, value in thermal.items()) + "}"
        lines.insert(next(k for k, old in enumerate(lines) if old.startswith("  max_current_A:")) + 1, line)
    return "\n".join(lines) + "\n"


def line(payload_kg, dwell_s=0, **more):
    third = LINE_M / 3
    points = [[0, 0], [third, 0], [2 * third, 0], [LINE_M, 0]]
    return {"path": {"bezier_m": [points]}, "payload_kg": payload_kg, "dwell_s": dwell_s, **more}


class Planner:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def plan(self, robot, mission):
        (self.folder / "robot.yaml").write_text(robot)
        (self.folder / "mission.yaml").write_text(json.dumps({"robot": "robot.yaml", **mission}))
        out = self.folder / "out"
        done = subprocess.run([self.program, "plan", self.folder / "mission.yaml", "--out", out, "--force", "--quiet"],
                              capture_output=True, text=True)
        if done.returncode > 1:
            raise RuntimeError(done.stderr.strip())
        return json.loads((out / "plan.json").read_text())

    def rows(self):
        return read_log(self.folder / "out/trajectory.csv")

    def driven_by_mujoco(self):
        """The log of a MuJoCo model of the robot that follows the wheel speeds of the plan."""
        robot, model = self.folder / "robot.yaml", self.folder / "model.xml"
        subprocess.run([self.program, "export", robot, "--to", "mjcf", "--out", model, "--force", "--quiet"], check=True)
        rows = self.rows()
        rising = np.concatenate([[True], np.diff(rows["time_s"]) > 0])
        return predict(model, robot, {name: rows[name][rising] for name in ("time_s", "wheel_speed_left_rad_s", "wheel_speed_right_rad_s")})


def integrated_C(rows, resistance_ohm, thermal):
    """Highest temperature of either winding: C dT/dt = R(T) i^2 - (T - ambient)/R_th."""
    ambient_C, highest_C, time_s = thermal["ambient_C"], -1e9, rows["time_s"]
    for side in ("left", "right"):
        current_A = rows[f"motor_current_{side}_A"]
        at_C = ambient_C
        for k in range(len(time_s) - 1):
            loss_W = resistance_ohm * (235 + at_C) / (235 + ambient_C) * 0.5 * (current_A[k] ** 2 + current_A[k + 1] ** 2)
            at_C += (loss_W - (at_C - ambient_C) / thermal["resistance_K_W"]) / thermal["capacity_J_K"] * (time_s[k + 1] - time_s[k])
            highest_C = max(highest_C, at_C)
    return highest_C


def relaxed(plan):
    verdict = plan["infeasibility"]
    return verdict["constraint"] + ": " + ", ".join(f"`{key}` = {value:.4g}" for key, value in verdict["relaxation"].items())


def battery_rows(planner):
    robot = robot_text()
    legs = [line(500), line(500), line(500)]
    yield "| battery at the start | fastest, s | least energy in 40 s, J | battery at the end | voltage on a leg, error at most |"
    yield "|---:|---:|---:|---:|---:|"
    for fraction in (1.0, 0.5, 0.2, 0.1, 0.07):
        start = {"start": {"x_m": 0, "y_m": 0, "heading_rad": 0, "battery_fraction": fraction}, "legs": legs}
        fastest = planner.plan(robot, {**start, "objective": {"minimize": "time"}})
        timed = planner.plan(robot, {**start, "objective": {"deadline_s": 40}})
        time = f"{fastest['duration_s']:.2f}" if "infeasibility" not in fastest else relaxed(fastest)
        if "infeasibility" in timed:
            yield f"| {fraction:.0%} | {time} | {relaxed(timed)} | | |"
            continue
        battery = timed["battery"]
        yield f"| {fraction:.0%} | {time} | {timed['energy_J']:.0f} | {battery['end_fraction']:.2%} | {battery['voltage_error_V']:.3f} V |"


def heat_row(planner, name, capacity_J_K, limit_C, mission):
    """A row, and the highest temperature (C) of the plan."""
    thermal = {**THERMAL, "capacity_J_K": capacity_J_K, "max_winding_C": limit_C}
    start = f"| {name} | {THERMAL['resistance_K_W'] * capacity_J_K:.1f} | {limit_C:.1f} |"
    plan = planner.plan(robot_text(battery=False, thermal=thermal), mission)
    if "infeasibility" in plan:
        return f"{start} | | | | | {plan['infeasibility']['message']} |", None
    winding, checked_C = plan["winding"], integrated_C(planner.rows(), 0.12, thermal)
    driven_C = integrated_C(planner.driven_by_mujoco(), 0.12, thermal)
    if max(abs(checked_C - winding["highest_C"]), abs(driven_C - winding["highest_C"])) > AGREED_K:
        raise RuntimeError(f"{name}: {winding['highest_C']} C, by steps {checked_C} C, driven by MuJoCo {driven_C} C")
    current = winding.get("planned_current_A")
    how = f"price of heat {winding['price_of_heat']:.3g}" if winding["price_of_heat"] else \
        f"at most {current['left']:.3g} A" if current else "no limit in the way"
    return (f"{start} {plan['duration_s']:.0f} | {plan['energy_J']:.0f} | {winding['highest_C']:.1f} | {checked_C:.1f} | {driven_C:.1f} | {how} |",
            winding["highest_C"])


def heat_rows(planner):
    free = {"legs": [line(0, 1) for _ in range(STARTS)]}
    yield f"| {STARTS} starts, 500 kg | time constant, s | limit, °C | s | J | hottest, °C | by steps, °C | driven by MuJoCo, °C | |"
    yield "|---|---:|---:|---:|---:|---:|---:|---:|---|"
    for capacity_J_K in CAPACITIES_J_K:
        for name, mission in (("least energy", free), ("least time", {**free, "objective": {"minimize": "time"}})):
            row, hottest_C = heat_row(planner, name, capacity_J_K, COOL_C, mission)
            yield row
            if hottest_C is not None:
                yield heat_row(planner, name, capacity_J_K, THERMAL["ambient_C"] + SHARE * (hottest_C - THERMAL["ambient_C"]), mission)[0]


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--note", required=True)
    arguments.add_argument("--program", required=True)
    arguments = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        planner = Planner(pathlib.Path(arguments.program).resolve(), pathlib.Path(folder))
        text = ["# Batteries that sag, motors that heat", "", arguments.note, "",
                f"`scenarios/robots/tug_600kg.yaml`, lines of {LINE_M} m with 500 kg.", "", "## Battery", "",
                f"Open-circuit curve {', '.join(f'{v} V at {z:.0%}' for z, v in CURVE)}, {BATTERY_OHM} ohm, 1200 Wh; three lines.", "",
                *battery_rows(planner), "", "## Heat", "",
                f"`thermal: {THERMAL}`, 500 kg on the chassis; the second limit is {SHARE:.0%} of the rise without one. Highest temperature of a winding in `plan.json`, by explicit steps along `trajectory.csv`, and along the currents of a MuJoCo model that drives the plan.", "",
                *heat_rows(planner), ""]
    (ROOT / "benchmarks/results/battery_and_heat.md").write_text("\n".join(text))
    print("\n".join(text))


if __name__ == "__main__":
    main()
