"""Real logs whose cause is known from their folder's name: calibrate on the normal condition, diagnose the others.

Writes benchmarks/results/blind_real.md. The logs are found by JOULEPATH_DATA_DIR (the folder that holds
kobuki_wheelslip/ and husky_borealtc/); sources, commits and licenses stand in ../README.md."""
import csv
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
import workspace  # noqa: E402

TICK_RAD = 0.0024369169
SCENARIOS = workspace.ROOT / "scenarios"


class Base:
    """What differs between the two robots: how a raw row becomes motion and current."""

    def __init__(self, robot, folder, columns, torque_per_ampere, period_s):
        self.robot, self.folder, self.columns = robot, folder, columns
        self.torque_per_ampere, self.period_s = torque_per_ampere, period_s


KOBUKI = Base("kobuki", "kobuki_wheelslip", """
  time_s: {from: field.time_stamp, scale: 0.001, wraps_at: 65536}
  wheel_speed_left_rad_s: {from: field.left_encoder, scale: 0.0024369169, wraps_at: 65536, derivative: true}
  wheel_speed_right_rad_s: {from: field.right_encoder, scale: 0.0024369169, wraps_at: 65536, derivative: true}
  motor_current_left_A: {from: field.current0, scale: 0.01, unsigned: true}
  motor_current_right_A: {from: field.current1, scale: 0.01, unsigned: true}
  battery_voltage_V: {from: field.battery, scale: 0.1}""", 49.58 * 0.0102, 0.02)

HUSKY = Base("husky_a200", "husky_borealtc", """
  time_s: {from: time}
  wheel_speed_left_rad_s: {from: velL, scale: 7.692307692}
  wheel_speed_right_rad_s: {from: velR, scale: 7.692307692}
  motor_current_left_A: {from: curL, offset: -0.59, unsigned: true}
  motor_current_right_A: {from: curR, offset: -0.59, unsigned: true}""", 78.71 * 0.044, 0.1538)


def rows_of(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def kobuki_motion(rows):
    """[(speed, |current|)] per side over steps of 0.2 s; counters wrap at 65536."""
    step, out = 10, ([], [])
    wrap = lambda d: (d + 32768) % 65536 - 32768
    for k in range(0, len(rows) - step, step):
        dt = ((int(rows[k + step]["field.time_stamp"]) - int(rows[k]["field.time_stamp"])) % 65536) / 1000
        if not 0.1 < dt < 0.4:
            continue
        for side, (encoder, current) in enumerate((("left", "0"), ("right", "1"))):
            ticks = wrap(int(rows[k + step][f"field.{encoder}_encoder"]) - int(rows[k][f"field.{encoder}_encoder"]))
            amps = sum(int(r[f"field.current{current}"]) for r in rows[k:k + step]) * 0.01 / step
            out[side].append((ticks * TICK_RAD / dt, amps))
    return out


def husky_motion(rows):
    """Straight driving alone: a skid steer's turns are scrub."""
    out = ([], [])
    for r in rows:
        left, right = float(r["velL"]), float(r["velR"])
        if abs(left - right) > 0.05:
            continue
        out[0].append((left / 0.13, max(0.0, float(r["curL"]) - 0.59)))
        out[1].append((right / 0.13, max(0.0, float(r["curR"]) - 0.59)))
    return out


def fit_line(points):
    """|current| = b1 + b2 |speed| by least squares over moving samples; b1, b2 >= 0."""
    moving = [(abs(q), i) for q, i in points if abs(q) > 0.5]
    n = len(moving)
    mq, mi = sum(q for q, _ in moving) / n, sum(i for _, i in moving) / n
    b2 = sum((q - mq) * (i - mi) for q, i in moving) / max(1e-12, sum((q - mq) ** 2 for q, _ in moving))
    b2 = max(b2, 0.0)
    b1 = mi - b2 * mq
    if b1 < 0:
        b1, b2 = 0.0, sum(q * i for q, i in moving) / sum(q * q for q, _ in moving)
    return b1, b2, n


def calibrated_robot(base, motions, path):
    """The robot file with friction and viscous friction from the normal condition, 10 % uncertain."""
    left, right = fit_line(motions[0]), fit_line(motions[1])
    torque = [max(1e-4, b1 * base.torque_per_ampere) for b1, _, _ in (left, right)]
    viscous = max(1e-6, 0.5 * (left[1] + right[1]) * base.torque_per_ampere)
    text = (SCENARIOS / "robots" / f"{base.robot}.yaml").read_text()
    text = re.sub(r"viscous_friction_Nm_s_rad: [0-9.e-]+", f"viscous_friction_Nm_s_rad: {viscous:.6g}", text)
    text = re.sub(r"friction_torque_Nm: [0-9.e-]+", f"friction_torque_Nm: {{left: {torque[0]:.6g}, right: {torque[1]:.6g}}}", text)
    text += ("uncertainty: {friction_torque_Nm: 0.1, viscous_friction_Nm_s_rad: 0.1, resistance_ohm: 0.05, torque_constant_Nm_A: 0.05, "
             "chassis_mass_kg: 0.05, chassis_yaw_inertia_kg_m2: 0.3, wheel_axle_inertia_kg_m2: 0.3, wheel_radius_m: 0.01, half_track_m: 0.05}\n")
    path.write_text(text)
    return torque, viscous


def pieces_of(rows, seconds, period_s, moves):
    """Cut a log into stretches of about `seconds`; stretches at rest throughout are dropped."""
    size = max(20, int(seconds / period_s))
    cut = [rows[k:k + size] for k in range(0, len(rows), size)]
    return [piece for piece in cut if len(piece) >= size // 2 and moves(piece)]


def write_set(folder, base, robot, logs):
    """A dataset of many short runs from raw rows."""
    folder.mkdir(parents=True)
    lines = ["schema: joulepath/dataset/1", f"robot: {robot}", "columns:" + base.columns, "runs:"]
    for k, rows in enumerate(logs):
        name = f"run_{k + 1:02d}.csv"
        with open(folder / name, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)
        lines.append(f"  - {{file: {name}, payload_kg: 0}}")
    (folder / "dataset.yaml").write_text("\n".join(lines) + "\n")
    return folder / "dataset.yaml"


def diagnose(dataset, out):
    command = [workspace.program("joulepath"), "diagnose", str(dataset), "--out", str(out)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900)
    answer = out / "diagnosis.json"
    if done.returncode not in (0, 1) or not answer.exists():
        return {"verdict": f"failed ({done.returncode})", "error": (done.stderr or done.stdout)[-300:]}
    return json.loads(answer.read_text())


def say(d):
    """One table cell of each: verdict, causes with values, energy before and after, where."""
    causes = []
    for cause in d.get("causes", []):
        values = ", ".join(f"{key} {value['value']:.3g}" if isinstance(value.get("value"), (int, float)) else f"{key} {value.get('value')}"
                           for key, value in (cause.get("parameters") or {}).items() if isinstance(value, dict))
        group = cause.get("indistinguishable_from") or []
        causes.append(f"{cause['effect']} ({values}; p {cause.get('probability', 0):.2f})" + (f" or {', '.join(group)}" if group else ""))
    energy = d.get("gap", {}).get("energy", {})
    number = lambda key: "–" if energy.get(key) is None else f"{energy[key]:.1f}"
    wheels = ", ".join(f"{w['value']} {w['share_of_gap']:.2f}" for w in d.get("where", []) if w.get("axis") == "wheel")
    phases = sorted((w for w in d.get("where", []) if w.get("axis") == "phase"), key=lambda w: -w["share_of_gap"])[:2]
    place = wheels + ("; " if wheels else "") + ", ".join(f"{w['value']} {w['share_of_gap']:.2f}" for w in phases)
    return (f"{d.get('verdict', '?')} | {'; '.join(causes) or d.get('error', '–').replace(chr(10), ' ')} | {number('before_percent')} → {number('after_percent')} "
            f"(bias {number('bias_before_percent')}) | {place or '–'}")


def checksum(folder):
    total = hashlib.sha256()
    for path in sorted(folder.rglob("*.csv")):
        total.update(path.read_bytes())
    return total.hexdigest()[:16]


TITLE = "| set | known cause | verdict | named | energy gap % before → after, held out | where (wheel; phase) |\n|---|---|---|---|---|---|"


def kobuki(data, scratch):
    folder = data / KOBUKI.folder
    load = lambda name: rows_of(folder / name / "mobile_base_sensors_core.csv")
    moves = lambda piece: any(int(r["field.current0"]) + int(r["field.current1"]) > 0 for r in piece[10:])
    normal = pieces_of(load("nonfaulty"), 6, KOBUKI.period_s, moves)
    motions = ([], [])
    for piece in normal[::2]:
        for side in (0, 1):
            motions[side].extend(kobuki_motion(piece)[side])
    robot = scratch / "kobuki.yaml"
    torque, viscous = calibrated_robot(KOBUKI, motions, robot)
    sets = [("nonfaulty, the other half", "none", normal[1::2])]
    for name, cause in (("left_faulty", "fault of the left wheel (slip)"), ("right_faulty", "fault of the right wheel (slip)"),
                        ("both_faulty", "fault of both wheels (slip)"), ("faulty", "unnamed; the right current is ten times normal")):
        sets.append((name, cause, pieces_of(load(name), 6, KOBUKI.period_s, moves)))
    lines = [f"Data checksum {checksum(folder)}. Calibrated on every other 6 s of `nonfaulty`: friction {torque[0]:.4g}, {torque[1]:.4g} N m, viscous {viscous:.3g} N m s/rad.", "", TITLE]
    for name, cause, logs in sets:
        place = scratch / ("kobuki_" + name.split(",")[0])
        lines.append(f"| {name} ({len(logs)} runs) | {cause} | {say(diagnose(write_set(place, KOBUKI, robot, logs), place / 'out'))} |")
    return lines


def husky(data, scratch):
    folder = data / HUSKY.folder
    load = lambda name: [rows_of(p) for p in sorted((folder / name).glob("pro_*.csv"))]
    moves = lambda piece: any(abs(float(r["velL"])) + abs(float(r["velR"])) > 0.1 for r in piece)
    cut = lambda name: [piece for log in load(name) for piece in pieces_of(log, 25, HUSKY.period_s, moves)][:40]
    asphalt = cut("ASPHALT")
    motions = ([], [])
    for piece in asphalt[::2]:
        for side in (0, 1):
            motions[side].extend(husky_motion(piece)[side])
    robot = scratch / "husky.yaml"
    torque, viscous = calibrated_robot(HUSKY, motions, robot)
    sets = [("ASPHALT, the other half", "none (turns scrub)", asphalt[1::2]), ("FLOORING", "hard floor, with spins: scrub", cut("FLOORING")),
            ("ICE", "slippery: little scrub", cut("ICE")), ("SANDY_LOAM", "soft ground and scrub", cut("SANDY_LOAM")),
            ("SNOW", "deep: rolling resistance", cut("SNOW"))]
    lines = [f"Data checksum {checksum(folder)}. Calibrated on straight driving in every other 25 s of ASPHALT: friction {torque[0]:.3g}, {torque[1]:.3g} N m, viscous {viscous:.3g} N m s/rad. No voltage, no pose, unsigned current, 6.5 Hz.", "", TITLE]
    for name, cause, logs in sets:
        place = scratch / ("husky_" + name.split(",")[0])
        lines.append(f"| {name} ({len(logs)} runs) | {cause} | {say(diagnose(write_set(place, HUSKY, robot, logs), place / 'out'))} |")
    return lines


def paper(scratch):
    lines = ["Energy only: no log, the protocol's braking assumed (see `scenarios/paper`).", "", TITLE]
    for name in ("straight_measured", "bezier_measured"):
        result = diagnose(SCENARIOS / "paper" / f"{name}.yaml", scratch / f"paper_{name}")
        lines.append(f"| {name} | open | {say(result)} |")
    return lines


def main():
    data = pathlib.Path(os.environ.get("JOULEPATH_DATA_DIR", workspace.ROOT.parent / "shared" / "data" / "real"))
    with tempfile.TemporaryDirectory(prefix="blind_real_") as folder:
        scratch = pathlib.Path(folder)
        lines = ["# Real logs: the rehearsal that counts most", "",
                 f"Command `benchmarks/blind/real/run`; commit `{workspace.head()}`. The cause is what the folder's name says; the calibration sees the normal condition alone.", ""]
        if (data / KOBUKI.folder).exists():
            lines += ["## Kobuki (two wheels)", ""] + kobuki(data, scratch) + [""]
            lines += ["## Husky A200 (skid steer)", ""] + husky(data, scratch) + [""]
        else:
            lines += [f"No logs in {data}: set JOULEPATH_DATA_DIR.", ""]
        lines += ["## Tables 4 and 6 of the source paper", ""] + paper(scratch) + [""]
    out = workspace.RESULTS / "blind_real.md"
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text("\n".join(lines))
    print(out.read_text())
    return 0


if __name__ == "__main__":
    sys.exit(main())
