"""Days of the program's own simulator: robots, missions and logs, without an effect or with one.

A kind of day is a robot, its missions, how often each is driven, options of `joulepath simulate`, and a change of
the logs. Missions are planned once; a day draws its noise from its own seed.
"""
import csv
import hashlib
import json
import math
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROBOTS = ROOT / "scenarios/robots"
# Kobuki and Husky have no limits in their files. ASSUMED: of the order of what their makers allow.
ASSUMED_LIMITS = {
    "kobuki": "limits: {speed_m_s: 0.5, acceleration_m_s2: 0.4, deceleration_m_s2: 0.4, lateral_acceleration_m_s2: 0.3, "
              "yaw_rate_rad_s: 1.5, yaw_acceleration_rad_s2: 2.0, max_payload_kg: 2}\n",
    "husky_a200": "limits: {speed_m_s: 0.8, acceleration_m_s2: 0.5, deceleration_m_s2: 0.5, lateral_acceleration_m_s2: 0.4, "
                  "yaw_rate_rad_s: 0.8, yaw_acceleration_rad_s2: 1.0, max_payload_kg: 40}\n"}
SCALE_M = {"kobuki": 1.2, "husky_a200": 3.0, "amr_150kg": 3.0, "tug_600kg": 5.0}  # of a path; others 2 m
LOAD_KG = {"kobuki": 1.0, "husky_a200": 20.0, "amr_150kg": 40.0, "tug_600kg": 100.0}  # of a loaded leg; others 8.25 kg


def leg(points, scale, payload, **more):
    return {"path": {"bezier_m": [[[scale * x, scale * y] for x, y in piece] for piece in points]}, "payload_kg": payload, **more}


def line(length):
    return [[[0, 0], [length / 3, 0], [2 * length / 3, 0], [length, 0]]]


CURVE = [[[0, 0], [1, 0], [1.5, 0], [1.5, 1.5]]]
BEND = [[[0, 0], [1.5, 0], [0.5, 1], [2, 1]]]
HOOK = [[[0, 0], [1.2, 0], [1.2, 1], [0, 1]]]


def missions(robot):
    """Named missions: planned paths, empty and loaded, and prescribed motions."""
    s, load = SCALE_M.get(robot, 2.0), LOAD_KG.get(robot, 8.25)
    slow = {"minimize": "energy", "deadline_s": 60}
    stand = {"motion": {"profile": "stand", "duration_s": 1}}
    drive = lambda direction: {"motion": {"profile": "trapezoid", "acceleration_m_s2": 0.15, "speed_m_s": 0.35, "distance_m": s,
                                          "direction": direction}}
    spin = lambda sign: {"motion": {"profile": "spin", "angle_rad": sign * math.pi, "yaw_rate_rad_s": 0.7}}
    return {"corner": {"csv": "x_m,y_m,corner_radius_m\n0,0,\n3,0,0.5\n3,3,0\n6,3,\n"},  # a turn on the spot at the second corner
            "curve": {"legs": [leg(CURVE, s, 0)]},
            "line": {"legs": [leg(line(2), s, load)]},
            "short": {"legs": [leg(line(0.6), s, 0)]},
            "bend": {"legs": [leg(BEND, s, 0, dwell_s=2), leg(HOOK, s, load)]},
            "hook": {"legs": [leg(HOOK, s, load / 2)], "objective": slow},
            "test": {"legs": [stand, drive("forward"), stand, spin(1), drive("forward"), stand]},
            "test_loaded": {"legs": [{**l, "payload_kg": load} for l in (stand, drive("forward"), stand, spin(-1), drive("forward"), stand)]},
            "spins": {"legs": [l for sign in (1, -1, 1, -1) for l in (stand, spin(sign))] + [stand]},
            "back": {"legs": [stand, drive("forward"), stand, drive("reverse"), stand]},
            "long": {"legs": [l for k in range(8) for l in (stand, drive("forward"), {"motion": {"profile": "stand", "duration_s": 3}},
                                                            spin((-1) ** k), drive("forward"), stand)]}}


TESTS = ("test", "test_loaded", "back", "bend")
# name: robot, missions, repeats, options of simulate, change of the logs
KINDS = {
    "one mission, 6 runs": ("starter", ("bend",), 6, (), None),
    "two missions, 12 runs": ("starter", ("curve", "line"), 6, (), None),
    "five missions, 25 runs": ("starter", ("curve", "line", "bend", "hook", "test"), 5, (), None),
    "one mission, 50 runs": ("starter", ("corner",), 50, (), None),
    "one mission, 500 runs": ("starter", ("short",), 500, (), None),
    "turns on the spot": ("starter", ("spins",), 12, (), None),
    "recovers over a bus": ("recovering", ("bend", "back"), 6, (), None),
    "one long log": ("starter", ("long",), 1, (), None),
    "no payload stated": ("starter", ("curve", "hook"), 6, (), "no payload"),
    "coarse sensors": ("starter", ("bend", "test"), 6, (), "coarse"),
    "battery alone": ("starter", ("bend", "test"), 6, (), "battery alone"),
    "20 Hz": ("starter", ("bend", "test"), 6, ("--sample-rate-Hz", "20"), None),
    "200 Hz": ("starter", ("bend", "test"), 6, ("--sample-rate-Hz", "200"), None),
    "1 kHz": ("starter", ("curve", "test"), 3, ("--sample-rate-Hz", "1000"), None),
    **{name: (name, ("bend", "test"), 6, (), None)
       for name in ("nomad_super_scout", "amr_150kg", "tug_600kg", "kobuki", "husky_a200")}}
SHORT = ("one mission, 6 runs", "two missions, 12 runs", "no payload stated", "battery alone", "turns on the spot", "kobuki")


def run(program, *arguments, check=True):
    done = subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True)
    if check and done.returncode not in (0, 1):
        raise RuntimeError(f"joulepath {' '.join(map(str, arguments))}: {done.stderr[-400:]}")
    return done


def robot_file(program, name, keep):
    """The robot file `name`, with limits; `starter` is that of `joulepath init`, `recovering` with a common bus."""
    file = keep / "robots" / f"{name}.yaml"
    if not file.exists():
        file.parent.mkdir(parents=True, exist_ok=True)
        if name in ("starter", "recovering"):
            run(program, "init", keep / name, "--quiet", "--force")
            recovers = {"starter": {}, "recovering": {"regeneration_efficiency: 0.0": "regeneration_efficiency: 0.6, sharing: bus",
                                                      "  speed_m_s: 1.0": "  jerk_m_s3: 2.0\n  speed_m_s: 1.0"}}
            text = (keep / name / "robot.yaml").read_text()
            for old, new in recovers[name].items():
                assert old in text, old
                text = text.replace(old, new)
            file.write_text(text)
        else:
            file.write_text((ROBOTS / f"{name}.yaml").read_text() + ASSUMED_LIMITS.get(name, ""))
    return file


def planned(program, robot, mission, keep):
    """What `simulate` drives: the plan's directory, or a mission of prescribed motions."""
    file = keep / "missions" / f"{robot}_{mission}.yaml"
    out = file.with_suffix("")
    if not file.exists():
        content = missions(robot)[mission]
        file.parent.mkdir(parents=True, exist_ok=True)
        used = robot_file(program, robot, keep)
        partial = file.with_name("partial_" + file.name)
        if "csv" in content:
            partial = partial.with_suffix(".csv")
            partial.write_text(content["csv"])
            run(program, "plan", partial, "--robot", used, "--out", out, "--without", "baselines", "--quiet", "--force")
        else:
            partial.write_text(json.dumps({"schema": "joulepath/mission/1", "robot": str(used), **content}))
            if any("path" in l for l in content["legs"]):
                run(program, "plan", partial, "--out", out, "--without", "baselines", "--quiet", "--force")
        partial.rename(file)
    return out if out.exists() else file


def seed_of(*words):
    return int.from_bytes(hashlib.sha256("/".join(map(str, words)).encode()).digest()[:4], "big")


def driven(program, robot, names, repeats, options, seed, folder, keep):
    """Logs of a day and their dataset file."""
    inputs = [planned(program, robot, name, keep) for name in names]
    run(program, "simulate", *inputs, "--robot", robot_file(program, robot, keep), "--repeat", repeats, "--seed", seed, *options,
        "--out", folder, "--quiet", "--force")
    return folder / "dataset.yaml"


def rewritten(file, change):
    with open(file, newline="") as stream:
        rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
    rows = [change(row) for row in rows]
    with open(file, "w", newline="") as stream:
        writer = csv.DictWriter(stream, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


def without(*words):
    return lambda row: {name: value for name, value in row.items() if not any(word in name for word in words)}


def coarse(row):
    """Currents of 20 mA, voltages of 50 mV, wheel speeds of 5 mrad/s, gyro of 2 mrad/s, positions of 5 mm."""
    steps = {"current_A": 0.02, "current_left_A": 0.02, "current_right_A": 0.02, "voltage": 0.05, "wheel_speed": 0.005, "gyro": 0.002,
             "position": 0.005, "x_m": 0.005, "y_m": 0.005}
    def rounded(name, value):
        step = next((step for word, step in steps.items() if word in name and "command" not in name), None)
        return value if step is None or not value else f"{round(float(value) / step) * step:.6g}"
    return {name: rounded(name, value) for name, value in row.items()}


CHANGES = {"no payload": without("payload"), "battery alone": without("motor_"), "coarse": coarse}


def null_day(program, kind, seed, folder, keep):
    robot, names, repeats, options, change = KINDS[kind]
    dataset = driven(program, robot, names, repeats, options, seed_of("null", kind, seed), folder, keep)
    if change:
        for file in sorted(folder.glob("run_*.csv")):
            rewritten(file, CHANGES[change])
    return dataset


def diagnosed(program, dataset, out, *more):
    """The answer, or None where there is none."""
    run(program, "diagnose", dataset, "--out", out, "--quiet", "--force", *more, check=False)
    file = pathlib.Path(out) / "diagnosis.json"
    return json.loads(file.read_text()) if file.exists() else None


def effects(program):
    """Name and `--effect` of simulate: each effect of the catalog at its typical size, a patch where the tests drive."""
    for effect in json.loads(run(program, "effects", "--json").stdout)["effects"]:
        value = {p["name"]: p["typical"] for p in effect["parameters"]}
        if effect["has_cells"]:
            value.update(x_min_m=0.5, x_max_m=1.5, y_min_m=-1, y_max_m=1)
        settings = ["side=left"] * effect["has_side"] + [f"{name}={number:g}" for name, number in value.items()]
        yield effect["name"], effect["name"] + ":" + ",".join(settings)


def effect_day(program, effect, missions_of, repeats, seed, folder, keep):
    return driven(program, "starter", missions_of, repeats, ("--effect", effect), seed_of("effect", effect, seed), folder, keep)
