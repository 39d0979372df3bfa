"""What is asked about one case: its diagnosis, the controls, one more run where a group is left, and a fresh day
for the shrink. The data are generated from the case's seed without a label and removed afterwards; the diagnosis
sees a folder named after the case's number and nothing else."""
import hashlib
import json
import pathlib
import random
import shutil
import subprocess
import tempfile
import time

import seal
import workspace
from spoils import read_rows, shows, spoils, write_rows

KEEP = ("gap", "where", "verdict", "causes", "ranking", "leftover", "next_experiment", "ceiling", "control", "data_checks",
        "below_materiality", "unknowns")
LIMIT_s = 180  # of one program: what takes longer has failed
ANSWERED = (0, 1)  # exit codes of a diagnosis that gave an answer
FITTED_RUNS = 4  # of a fresh day: the others judge alone
BATTERY_CHANNELS = ("time_s", "wheel_speed_left_rad_s", "wheel_speed_right_rad_s", "position_x_m", "position_y_m", "heading_rad",
                    "battery_voltage_V", "battery_current_A")  # odometry and battery: the commonest log


def run_quietly(command, folder):
    """(exit code, stderr, seconds) with an empty environment; a program that does not end has exit code 124."""
    start = time.monotonic()
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(folder), "TMPDIR": str(folder)}
    try:
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=LIMIT_s)
        return done.returncode, done.stderr, time.monotonic() - start
    except subprocess.TimeoutExpired:
        return 124, f"not done after {LIMIT_s} s", time.monotonic() - start


def hash_of(folder):
    total = hashlib.sha256()
    for path in sorted(folder.iterdir()):
        total.update(path.name.encode() + b"\0" + path.read_bytes())
    return total.hexdigest()


CHANGED = ("removed", "spoilt", "battery", "long")  # bins without further looks: their catalog, channels or runs are changed


class Examination:
    """One case in a scratch folder of its own."""

    def __init__(self, case, scratch):
        self.case, self.scratch = case, scratch

    def generate(self, tag, more=()):
        data = self.scratch / tag / self.case["id"]
        subprocess.run(seal.plant_command(self.case, seal.physics_of(self.case)) + ["--out", str(data), "--label", "none", *more], check=True,
                       capture_output=True, timeout=LIMIT_s)
        return data

    def prepared(self, data):
        """The day as the case's bin logs it: a channel spoilt, or odometry and battery alone."""
        runs = sorted(data.glob("run_*.csv"))
        if "spoil" in self.case:
            way = self.case["spoil"]["way"]
            _, _, spoil = spoils()[way]
            chosen = runs
            if not self.case["spoil"]["all_runs"]:
                chosen = [random.Random(self.case["seed"]).choice([run for run in runs if shows(way, read_rows(run))])]
            for run in chosen:
                rows = read_rows(run)
                spoil(rows)
                write_rows(run, rows)
        if self.case["bin"] == "battery":
            for run in runs:
                write_rows(run, [{name: row[name] for name in BATTERY_CHANNELS} for row in read_rows(run)])
        return data

    def diagnose(self, dataset, out):
        """The answer's parts that are scored, or what went wrong."""
        command = [workspace.program("joulepath"), "diagnose", str(dataset), "--out", str(out)]
        if self.case["bin"] == "removed":
            command += ["--without", self.case["effects"][0]]
        code, errors, seconds = run_quietly(command, self.scratch)
        result = {"exit_code": code, "seconds": seconds}
        try:
            if code not in ANSWERED:
                raise ValueError(errors)
            full = json.loads((out / "diagnosis.json").read_text())
            result["diagnosis"] = {key: full[key] for key in KEEP if key in full}
        except (OSError, ValueError) as error:
            result["error"] = str(error)[-500:]
        return result

    def next_runs(self, answer):
        """Where a group is left: drive the proposed run, and a random one as control, and ask again."""
        causes = answer.get("causes") or []
        if not any(cause.get("indistinguishable_from") for cause in causes):
            return None
        motion = (answer.get("next_experiment") or {}).get("motion") or {}
        chosen = random.Random(self.case["seed"]).choice(RANDOM_MOTIONS)
        found = {}
        for name, description in (("proposed", described(motion)), ("random", described(chosen))):
            if description:
                data = self.generate(name, ["--append", description])
                found[name] = {"motion": description, **self.diagnose(data / "dataset.yaml", self.scratch / name / "out")}
        return found

    def fresh_day(self, out):
        """The energy gap on a day of 24 runs that nobody saw, with the robot file as it was and as corrected; and
        what a diagnosis of that day says of the corrected file."""
        robot = out / "robot_corrected.yaml"
        if not robot.exists() or (out / "dataset_corrected.yaml").exists():
            return None
        data = self.generate("fresh", ["--day", "1", "--protocol", "24"])
        day = (data / "dataset.yaml").read_text()
        parts = day.split("start_time_s")
        text = "start_time_s".join(parts[:FITTED_RUNS + 1]) + "".join("use: validation, start_time_s" + part for part in parts[FITTED_RUNS + 1:])
        found = {}
        for name, file in (("before", "robot.yaml"), ("after", robot)):
            dataset = data / f"{name}.yaml"
            dataset.write_text(text.replace("robot: robot.yaml", f"robot: {file}"))
            gap = self.diagnose(dataset, self.scratch / "fresh" / name).get("diagnosis", {}).get("gap", {}).get("energy", {})
            found |= {f"{name}_J": gap.get("before_J"), f"{name}_percent": gap.get("before_percent")}
        dataset = data / "again.yaml"
        dataset.write_text(day.replace("robot: robot.yaml", f"robot: {robot}"))
        again = self.diagnose(dataset, self.scratch / "fresh" / "again").get("diagnosis", {})
        return found | {"again": {key: again.get(key) for key in ("verdict", "causes", "unknowns")}}

    def controls(self, data):
        answer = self.scratch / "controls.json"
        code, _, _ = run_quietly([workspace.program("blind_controls"), str(data), str(answer)], self.scratch)
        return json.loads(answer.read_text()) if code == 0 else None


def described(motion):
    """A proposed motion (with `legs`, or one leg itself) as the plant's --append wants it; None where there is none."""
    legs = motion.get("legs") or ([motion] if "profile" in motion else [])
    parts = []
    for leg in legs:
        plain = {key: value for key, value in leg.items() if isinstance(value, (int, float, str)) and key != "why"}
        plain.setdefault("payload_kg", motion.get("payload_kg", 0))
        parts.append(",".join(f"{key}:{value}" for key, value in plain.items()))
    return "+".join(parts) or None


RANDOM_MOTIONS = ({"profile": "trapezoid", "speed_m_s": 0.4, "distance_m": 4}, {"profile": "spin", "angle_rad": 4.0},
                  {"profile": "arc", "radius_m": 1.0, "angle_rad": 3.0, "speed_m_s": 0.3}, {"profile": "stand", "duration_s": 10},
                  {"profile": "trapezoid", "speed_m_s": 0.3, "distance_m": 3, "direction": "reverse"})


def examine(case, with_controls=True):
    """Everything that the scorer needs of a case, in one dictionary; what goes wrong is part of it."""
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="blind_"))
    result = {"id": case["id"]}
    try:
        examination = Examination(case, scratch)
        data, out = examination.prepared(examination.generate("data")), scratch / "data" / "out"
        result["data_sha256"] = hash_of(data)
        result.update(examination.diagnose(data / "dataset.yaml", out))
        answer = result.get("diagnosis") or {}
        result["corrected"] = any((out / name).exists() for name in ("robot_corrected.yaml", "dataset_corrected.yaml"))
        if case["bin"] not in CHANGED:
            result["next_runs"] = examination.next_runs(answer)
            result["fresh_day"] = examination.fresh_day(out)
        if with_controls and case["bin"] not in CHANGED:
            result["controls"] = examination.controls(data)
    except (OSError, ValueError, subprocess.SubprocessError) as error:
        result.setdefault("error", f"{type(error).__name__}: {error}"[-500:])
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    return result
