"""Robots as MJCF of `export --to mjcf`, driven in MuJoCo against `simulate`; drafts of `init --from` against other readers."""

import argparse
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import textwrap

import numpy as np
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/bin/joulepath"
sys.path.insert(0, str(ROOT / "benchmarks/peers"))
sys.path.insert(0, str(ROOT / "benchmarks/models"))
from mujoco_peer import PERIOD_S, SETTLE_S, drawn_W, execute, wheels_alone  # noqa: E402
from stated import reached, stated  # noqa: E402

ROBOTS = ["nomad_super_scout", "kobuki", "husky_a200", "amr_150kg", "tug_600kg"]
RESERVE = 1.3  # of the time of least energy: a wheel controller keeps voltage for its corrections
WAY = "x_m,y_m,corner_radius_m\n0,0,\n4,0,1\n4,4,0\n7,4,\n"  # straight, an arc, a turn in place


def joulepath(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    return done.stdout


def sides(value):
    return [value["left"], value["right"]] if isinstance(value, dict) else [value, value]


def flat(file):
    """A robot file as benchmarks/peers/mujoco_peer.py takes it."""
    robot = yaml.safe_load(file.read_text())
    return {**robot["geometry"], **robot["inertia"], "motor": {k: sides(v) for k, v in robot["motor"].items()}, "power": robot.get("power", {})}


def driven(name, folder):
    """Motion energies of one plan: of `simulate` and of the exported model in MuJoCo, whose wheels follow the plan's speeds."""
    file = ROOT / f"scenarios/robots/{name}.yaml"
    way, plan, run, model = folder / "way.csv", folder / name, folder / f"{name}_run", folder / f"{name}.xml"
    way.write_text(WAY)
    joulepath("plan", way, "--robot", file, "--out", plan, "--quiet")
    longer_s = RESERVE * json.loads((plan / "plan.json").read_text())["duration_s"]
    joulepath("plan", way, "--robot", file, "--time", longer_s, "--out", plan, "--quiet", "--force")
    simulated = json.loads(joulepath("simulate", plan, "--robot", file, "--ideal-sensors", "--out", run, "--json"))
    simulated_J = simulated["runs"][0]["executed"]["motion_energy_J"]
    joulepath("export", file, "--to", "mjcf", "--out", model, "--quiet")
    rows = list(csv.DictReader((plan / "trajectory.csv").open()))
    column = lambda key: np.array([float(row[key]) for row in rows])
    robot, times = flat(file), column("time_s")
    r, l = robot["wheel_radius_m"], robot["half_track_m"]
    at = np.arange(math.ceil((times[-1] + SETTLE_S) / PERIOD_S)) * PERIOD_S + PERIOD_S
    left, right = (np.interp(at, times, column(f"wheel_speed_{side}_rad_s"), right=0) for side in ("left", "right"))
    speeds = np.stack([r * (left + right) / 2, r * (right - left) / (2 * l)], 1)
    most_V = min(robot["motor"].get("max_voltage_V", [math.inf]))
    watts, _ = execute(robot, 0.0, most_V, (0, 0, 0), len(at), wheels_alone(None, speeds), text=model.read_text())
    power = robot["power"]
    drawn = drawn_W(watts, power.get("regeneration_efficiency", 0.0), power.get("sharing", "wheel"))
    return simulated_J, float(drawn.sum() * PERIOD_S)


KEYS = ["chassis_mass_kg", "chassis_yaw_inertia_kg_m2", "center_of_mass_offset_m", "half_track_m", "wheel_radius_m", "wheel_mass_kg", "wheel_axle_inertia_kg_m2"]
RELATIVE, ABSOLUTE = 1e-4, 1e-9  # of two readings that agree
ROUND = 1 / math.cos(math.pi / 16)  # a circle lies inside a regular polygon of 16 corners


def shapes_of(model, data):
    """Geoms that collide, as `reach` takes them, with their bodies."""
    import mujoco

    kinds = {int(getattr(mujoco.mjtGeom, f"mjGEOM_{kind.upper()}")): kind for kind in ("box", "sphere", "cylinder", "capsule")}
    for g in range(model.ngeom):
        body, size, at = model.geom_bodyid[g], model.geom_size[g], np.eye(4)
        if body == 0 or not (model.geom_contype[g] or model.geom_conaffinity[g]):
            continue
        at[:3, :3], at[:3, 3] = data.geom_xmat[g].reshape(3, 3), data.geom_xpos[g]
        yield body, (kinds.get(int(model.geom_type[g])), at, {"size": 2 * size, "radius": size[:1], "length": 2 * size[1:2]})


def compiled(file, wheels):
    """Values of an MJCF file by MuJoCo's own compiler, with parallel axes by numpy."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos0
    for i in range(model.njnt):  # all hinges and slides at zero, as in a robot file's draft
        if model.jnt_type[i] in (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE):
            data.qpos[model.jnt_qposadr[i]] = 0
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    joints = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) for name in wheels]
    bodies = [model.jnt_bodyid[j] for j in joints]
    inertia = lambda b: (turn := data.ximat[b].reshape(3, 3)) @ np.diag(model.body_inertia[b]) @ turn.T
    rest = [b for b in range(1, model.nbody) if b not in bodies and model.body_mass[b] > 0]
    mass, places = model.body_mass[rest], data.xipos[rest]
    center = (mass[:, None] * places).sum(0) / mass.sum()
    yaw = sum(inertia(b)[2, 2] + m * ((place - center)[:2] ** 2).sum() for b, m, place in zip(rest, mass, places))
    axes, ends = data.xaxis[joints], data.xanchor[joints].copy()
    shapes = list(shapes_of(model, data))
    rounds = [next((s for at, s in shapes if at == b and s[0] not in ("box", None)), None) for b in bodies]
    for i, shape in enumerate(rounds):
        if shape:
            ends[i] += axes[i] * (axes[i] @ (shape[1][:3, 3] - ends[i]))
    left = (ends[0] - ends[1]) / np.linalg.norm(ends[0] - ends[1])
    values = {"chassis_mass_kg": mass.sum(), "chassis_yaw_inertia_kg_m2": yaw, "half_track_m": np.linalg.norm(ends[0] - ends[1]) / 2,
              "center_of_mass_offset_m": (center - ends.mean(0)) @ np.cross(left, [0, 0, 1]), "wheel_mass_kg": model.body_mass[bodies].mean(),
              "wheel_axle_inertia_kg_m2": np.mean([a @ inertia(b) @ a + model.dof_armature[model.jnt_dofadr[j]] for a, b, j in zip(axes, bodies, joints)])}
    if all(rounds):
        values["wheel_radius_m"] = np.mean([shape[2]["radius"][0] for shape in rounds])
    return values | reached([shape for _, shape in shapes], left, ends.mean(0))


def flattened(robot):
    one = lambda v: sum(map(float, v.values())) / 2 if isinstance(v, dict) else float(v)
    return {key: one(value) for key, value in {**robot.get("geometry", {}), **robot.get("inertia", {})}.items()}


def drafted(file, wheels, folder):
    """Values of `init --from`, without `--wheels` where the program finds the drive wheels, and whether it does."""
    command = ["init", folder / "draft", "--from", file, "--force", "--quiet"]
    try:
        joulepath(*command)
        named = "found"
    except RuntimeError:
        joulepath(*command, "--wheels", ",".join(wheels))
        named = "named"
    robot = yaml.safe_load((folder / "draft/robot.yaml").read_text())
    return flattened(robot), robot.get("footprint", {}).get("polygon_m"), named


def agreed(ours, theirs):
    return abs(ours - theirs) <= RELATIVE * abs(theirs) + ABSOLUTE


def cell(ours, theirs):
    if ours is None or theirs is None:
        return "not stated" if ours is theirs else f"**{ours} for {theirs}**"
    return f"{theirs:.5g}" if agreed(ours, theirs) else f"**{ours:.6g} for {theirs:.6g}**"


def outline(polygon, sides):
    """Length and width; the polygon holds the shapes exactly where they are boxes, and at most 2 % outside round ones."""
    if polygon is None or sides is None:
        return "not stated" if polygon is sides else "**one of two**"
    x, y = np.array(polygon).T
    ours = [x.max(), -x.min(), y.max(), -y.min()]
    size = max(sides[0] + sides[1], sides[2] + sides[3])
    fits = all(-RELATIVE * size <= a - b <= (ROUND - 1 + RELATIVE) * size for a, b in zip(ours, sides))
    text = f"{sides[0] + sides[1]:.4g} x {sides[2] + sides[3]:.4g}"
    return text if fits else f"**{ours[0] + ours[1]:.4g} x {ours[2] + ours[3]:.4g} for {text}**"


def row(item, folder):
    name, _, wheels = item.partition("@")
    file, wheels = pathlib.Path(name), wheels.split(",")
    ours, polygon, named = drafted(file, wheels, folder)
    theirs = compiled(file, wheels) if file.suffix in (".xml", ".mjcf") else stated(file, wheels)
    cells = [cell(ours.get(k), theirs.get(k)) for k in KEYS] + [outline(polygon, theirs.get("sides"))]
    label = "/".join(file.parts[-2:]) if file.stem.startswith("model") else file.name
    return f"| {label} | {named} | " + " | ".join(cells) + " |", any("**" in c for c in cells)


def read(about, items, folder):
    rows = [row(item, folder) for item in items]
    wrong = sum(differs for _, differs in rows)
    return ["", "## Read", "",
            "Values of `init --from` beside those of another reader: MuJoCo's compiler for MJCF, `benchmarks/models/stated.py` for",
            "URDF and SDF. A value stands once where both agree within 1e-4, else in bold as `ours for theirs`. *not stated*: neither",
            "gives a value (wheels without a round collision shape; a footprint of meshes). Wheels are *found* without `--wheels`, or *named*",
            "by it; then other wheels count as parts of the chassis. The footprint of round shapes may lie up to 2 % outside of them.", "",
            textwrap.fill(f"{len(rows)} models, {wrong} of them with a difference. {about}", 110), "",
            "| model | wheels | chassis, kg | yaw inertia, kg m2 | center of mass, m | half track, m | wheel radius, m | wheel, kg | axle inertia, kg m2 | footprint, m |",
            "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|", *(text for text, _ in rows)]


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--note", default="")
    options.add_argument("--about", default="", help="where the models come from")
    options.add_argument("models", nargs="*")
    options = options.parse_args()
    lines = ["# Models of simulators", "", options.note, "", "## Driven", "",
             "One plan (4 m, an arc of 1 m, 3 m, a turn in place, 3 m) in 1.3 times the time of least energy. Its wheel speeds are",
             "followed in MuJoCo by the model of `export --to mjcf`, and by `simulate`: energy of the motors without standby.", "",
             "| robot | `simulate`, J | MuJoCo, J | difference |", "|---|---:|---:|---:|"]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name in ROBOTS:
            simulated_J, mujoco_J = driven(name, folder)
            lines.append(f"| {name} | {simulated_J:.4g} | {mujoco_J:.4g} | {100 * (mujoco_J / simulated_J - 1):+.2f} % |")
        if options.models:
            lines += read(options.about, options.models, folder)
    text = "\n".join(lines) + "\n"
    (ROOT / "benchmarks/results/models.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
