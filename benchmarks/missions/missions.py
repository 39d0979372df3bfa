"""Random missions over the two Nav2 maps: what the profile and what the way save, by `joulepath plan`.

usage: missions.py PROGRAM COUNT SEED
Writes benchmarks/results/missions.md. Reads nothing but the program's own plan.json.
"""
import json
import pathlib
import platform
import random
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
MAPS = {  # map, keep-out, corners of the floor that stations are drawn from (m)
    "warehouse": ("warehouse.yaml", "warehouse_keepout.yaml", (-14.0, -24.0, 14.0, 24.0)),
    "depot": ("depot.yaml", None, (1.0, 1.0, 29.0, 14.0)),
}
PAYLOADS_KG = [0.0, 2.5, 5.7, 8.25, 10.5]


def mission(rng, name):
    map_file, keepout, (x0, y0, x1, y1) = MAPS[name]
    maps = ROOT / "scenarios" / "maps"
    stations = {f"s{k}": {"x_m": round(rng.uniform(x0, x1), 2), "y_m": round(rng.uniform(y0, y1), 2)} for k in range(4)}
    document = {"schema": "joulepath/mission/1", "robot": str(ROOT / "scenarios/robots/nomad_super_scout.yaml"),
                "map": str(maps / map_file), "clearance_m": 0.05, "stations": stations, "start": {"station": "s0"},
                "legs": [{"to": f"s{k}", "payload_kg": rng.choice(PAYLOADS_KG), "dwell_s": 5} for k in (1, 2, 3)],
                "objective": {"minimize": "energy"}}
    if keepout:
        document["keepout"] = str(maps / keepout)
    return document


def plan(program, document, folder):
    (folder / "mission.yaml").write_text(json.dumps(document))
    run = subprocess.run([program, "plan", folder / "mission.yaml", "--out", folder / "out", "--force", "--json", "--solver", "fast"],
                         capture_output=True, text=True)
    if run.returncode != 0:
        return None
    return json.loads(run.stdout), json.loads((folder / "out/timing.json").read_text())["planning_s"]


def baseline(result, name):
    found = [b for b in result["baselines"] if b["name"] == name and b["feasible"]]
    return found[0] if found else None


def stop_turn_go_percent(result):
    """Energy that stop-turn-go corners on the shortest route would cost on top, at the same price of time."""
    chosen = sum(a["energy_J"] for leg in result["legs"] for a in leg["alternatives"] if a["chosen"])
    plain = 0.0
    for leg in result["legs"]:
        named = {a["name"]: a["energy_J"] for a in leg["alternatives"]}
        plain += named.get("route_0_stop_turn_go", named.get("route_0_largest_blend", 0.0)) or 0.0
    return 100.0 * (plain - chosen) / plain if plain else 0.0


def spread(values):
    if not values:
        return "-"
    ordered = sorted(values)
    return f"{statistics.median(ordered):.2f} ({ordered[0]:.2f} to {ordered[-1]:.2f})"


def main():
    program, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    rng = random.Random(seed)
    rows, refused, draws = [], 0, 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        while len(rows) < count and draws < 20 * count:
            name = ["warehouse", "depot"][draws % 2]
            draws += 1
            answer = plan(program, mission(rng, name), folder)
            if answer is None:
                refused += 1
                continue
            result, seconds = answer
            rows.append({"map": name, "result": result, "seconds": seconds})
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    cpu = next((line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.processor())
    lines = ["# Missions: what the profile and the way save", "",
             f"Command `./dev bench missions {count} {seed}`, commit {commit}, machine {cpu}.", "",
             f"{len(rows)} random missions of three legs (payload 0 to 10.5 kg, 5 s of dwell at each stop, free time) over the two Nav2 maps, with the Nomad's"
             f" robot file (standby 10 W assumed, no regeneration). {refused} draws were refused (a station in an obstacle, no way) and replaced.",
             "Figures are median (least to most) over the missions.", "",
             "| saved against | counted with standby, % | motion alone, % | missions |", "|---|---|---|---|"]
    for name in ("trapezoid_max_acceleration", "trapezoid_best_tuned"):
        pairs = [b for b in (baseline(row["result"], name) for row in rows) if b]
        lines.append(f"| {name}, same path and time | {spread([b['saving_percent'] for b in pairs])} | {spread([b['motion_saving_percent'] for b in pairs])} | {len(pairs)} |")
    lines.append(f"| stop-turn-go corners on the first route, same price of time (legs without dwell) | {spread([stop_turn_go_percent(row['result']) for row in rows])} | - | {len(rows)} |")
    lines += ["", f"Planning took {spread([row['seconds'] for row in rows])} s a mission (fast solver, one process each, map prepared anew).", "",
              "A baseline that breaks a limit on some leg is infeasible and not counted: the missions column says how many are."]
    path = ROOT / "benchmarks/results/missions.md"
    path.write_text("\n".join(lines) + "\n")
    print(path.read_text())


main()
