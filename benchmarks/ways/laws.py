#!/usr/bin/env python3
"""Laws that plans must keep, as Markdown.

usage: laws.py FOLDER PROGRAM NOTE [EVERY]
The missions of programs.py mirrored, turned and moved, with other seeds, and made easier: the cost must stay the same
or fall. Straight legs whose headings are a little off the line must cost hardly more.
EVERY: takes every so many missions of each floor.
"""
import json
import math
import pathlib
import random
import subprocess
import sys

import programs

CLOSE_PERCENT, SHARE, WORST_PERCENT = 0.1, 0.98, 0.5
SEEDS = range(2, 5)
RADIUS_m, CLEARANCE_m = 0.25, 0.05  # of the Nomad, and what is left beside it


def read_map(file):
    """The keys of a map file and the rows of its image, the first at the largest y."""
    keys = dict(line.split(": ", 1) for line in file.read_text().splitlines() if ": " in line)
    floor = programs.Floor("", file.parent / keys["image"], float(keys["resolution"]), json.loads(keys["origin"]), {})
    return keys, [floor.cells[k * floor.width:(k + 1) * floor.width] for k in range(floor.height)]


def write_map(folder, name, keys, rows, origin):
    (folder / f"{name}.pgm").write_bytes(b"P5\n%d %d\n255\n" % (len(rows[0]), len(rows)) + b"".join(rows))
    changed = {**keys, "image": f"{name}.pgm", "origin": json.dumps([*origin, 0])}
    (folder / f"{name}.yaml").write_text("".join(f"{key}: {value}\n" for key, value in changed.items()))
    return str(folder / f"{name}.yaml")


class Motions:
    """Images of a mission under motions of the plane that map cells to cells."""

    def __init__(self, folder):
        self.folder, self.maps = folder, {}

    def _map(self, mission, name, change):
        key = mission["map"], name
        if key not in self.maps:
            keys, rows = read_map(pathlib.Path(mission["map"]))
            x_m, y_m, *_ = json.loads(keys["origin"])
            size_m = [count * float(keys["resolution"]) for count in (len(rows[0]), len(rows))]
            self.maps[key] = write_map(self.folder, f"{len(self.maps)}_{name}", keys, *change(rows, (x_m, y_m), size_m))
        return self.maps[key]

    def _image(self, mission, name, change, place, turn):
        stations = {}
        for station, at in mission["stations"].items():
            x_m, y_m = place(at["x_m"], at["y_m"])
            stations[station] = {"x_m": x_m, "y_m": y_m}
            if "heading_rad" in at:
                stations[station]["heading_rad"] = turn(at["heading_rad"])
        return {**mission, "map": self._map(mission, name, change), "stations": stations}

    def mirrored(self, mission):
        return self._image(mission, "mirrored",
                           lambda rows, at, size: (rows[::-1], (at[0], -at[1] - size[1])),
                           lambda x, y: (x, -y), lambda heading: -heading)

    def turned(self, mission):
        return self._image(mission, "turned",
                           lambda rows, at, size: ([bytes(row[-1 - k] for row in rows) for k in range(len(rows[0]))],
                                                   (-at[1] - size[1], at[0])),
                           lambda x, y: (-y, x), lambda heading: heading + math.pi / 2)

    def moved(self, mission):
        return self._image(mission, "moved", lambda rows, at, size: (rows, (at[0] + 100, at[1] - 40)),
                           lambda x, y: (x + 100, y - 40), lambda heading: heading)


class Planner:
    def __init__(self, folder, program):
        self.folder, self.program = folder, program

    def plan(self, mission, seed=1):
        file, out = self.folder / "mission.json", self.folder / "out"
        file.write_text(json.dumps({"schema": "joulepath/mission/1", **mission}))
        (out / "plan.json").unlink(missing_ok=True)
        subprocess.run([self.program, "plan", file, "--out", out, "--force", "--solver", "fast", "--seed", str(seed),
                        "--without", "baselines,path_bound", "-q"], check=False, capture_output=True)
        answer = json.loads((out / "plan.json").read_text())
        return answer if answer["status"] in ("optimal", "feasible") else {"energy_J": math.inf, "duration_s": math.inf}


def easier(mission, plan):
    """(law, an easier mission, a harder one): the easier one costs no more."""
    yield "a smaller clearance", {**mission, "clearance_m": 0.02}, mission
    if mission["legs"][0].get("payload_kg"):
        half = [{**leg, "payload_kg": leg["payload_kg"] / 2} for leg in mission["legs"]]
        yield "half the payload", {**mission, "legs": half}, mission
    soon, late = ({**mission, "objective": {"minimize": "energy", "deadline_s": share * plan["duration_s"]}}
                  for share in (0.99, 1.0))
    yield "a later deadline", late, soon
    (first, second), stations = (leg["to"] for leg in mission["legs"]), mission["stations"]
    stop = stations[first]
    if "heading_rad" in stop:
        free = {name: {key: value for key, value in at.items() if name != first or key != "heading_rad"}
                for name, at in stations.items()}
        yield "a free heading", {**mission, "stations": free}, mission
    else:
        turn = math.atan2(stations[second]["y_m"] - stop["y_m"], stations[second]["x_m"] - stop["x_m"])
        named = {**stations, first: {**stop, "heading_rad": round(turn, 6)}}
        yield "a free heading", mission, {**mission, "stations": named}


def straight_legs(folder):
    """Pairs of a straight leg on an open floor with headings a little off its line, and the same leg in line."""
    keys = {"mode": "trinary", "resolution": "0.1", "negate": "0", "occupied_thresh": "0.65", "free_thresh": "0.25"}
    floor = write_map(folder, "open", keys, [b"\xfe" * 400] * 400, (-20.0, -20.0))

    def leg(robot, length_m, start_rad, goal_rad):
        heading = {} if goal_rad is None else {"heading_rad": goal_rad}
        return {"robot": str(programs.SCENARIOS / f"robots/{robot}.yaml"), "map": floor,
                "start": {"x_m": 0.0, "y_m": 0.0, "heading_rad": start_rad},
                "stations": {"goal": {"x_m": length_m, "y_m": 0.0, **heading}},
                "legs": [{"to": "goal"}], "objective": {"minimize": "energy"}}

    for robot in ("nomad_super_scout", "amr_150kg"):
        for length_m in (2.0, 5.0, 12.0):
            for off_rad in (0.001, 0.01, 0.035):
                yield leg(robot, length_m, off_rad, None), leg(robot, length_m, 0.0, None)
                for sense in (1, -1):
                    yield leg(robot, length_m, off_rad, sense * off_rad), leg(robot, length_m, 0.0, 0.0)


def distance_m(floor, x_m, y_m, within_m=1.0):
    """From a place to the nearest cell that is not free, at most within_m."""
    side_m, least_m = floor.resolution_m, within_m
    top_m = floor.origin[1] + floor.height * side_m
    columns, rows = (range(int((a - within_m) / side_m) - 1, int((a + within_m) / side_m) + 2)
                     for a in (x_m - floor.origin[0], top_m - y_m))
    for row in rows:
        for column in columns:
            inside = 0 <= column < floor.width and 0 <= row < floor.height
            if not inside or floor.cells[row * floor.width + column] <= 250:
                left_m, low_m = floor.origin[0] + column * side_m, top_m - (row + 1) * side_m
                least_m = min(least_m, math.hypot(max(left_m - x_m, 0, x_m - left_m - side_m),
                                                  max(low_m - y_m, 0, y_m - low_m - side_m)))
    return least_m


def wrapped(angle_rad):
    return math.remainder(angle_rad, 2 * math.pi)


def pose_beside_wall(floor, draw, need_m):
    """A pose whose nearest obstacle lies need_m away: about ahead, or about beside."""
    while True:
        x_m, y_m = floor.place(draw)
        bearing_rad, out_m, in_m = draw.uniform(-math.pi, math.pi), 0.0, 0.0
        while in_m < 6 and distance_m(floor, x_m + in_m * math.cos(bearing_rad), y_m + in_m * math.sin(bearing_rad)) > need_m:
            out_m, in_m = in_m, in_m + 0.05
        if in_m >= 6 or in_m == 0:
            continue
        for _ in range(40):
            middle_m = 0.5 * (out_m + in_m)
            near = distance_m(floor, x_m + middle_m * math.cos(bearing_rad), y_m + middle_m * math.sin(bearing_rad)) > need_m
            out_m, in_m = (middle_m, in_m) if near else (out_m, middle_m)
        return {"x_m": x_m + out_m * math.cos(bearing_rad), "y_m": y_m + out_m * math.sin(bearing_rad),
                "heading_rad": wrapped(bearing_rad + draw.choice((0, math.pi / 2, -math.pi / 2)) + draw.uniform(-0.3, 0.3))}


def beside_walls(folder):
    """(mission, the same with a turn to some heading before it drives or after): ends hardly farther from a wall than the
    clearance."""
    draw = random.Random(733)
    floors = {floor.name: floor for floor in (programs.hall(folder, draw), programs.warehouse())}
    for floor in floors.values():
        for spare_m in (0.0001, 0.003, 0.02) * 3:
            while True:
                start, goal = (pose_beside_wall(floor, draw, RADIUS_m + CLEARANCE_m + spare_m) for _ in range(2))
                if 2 <= math.hypot(goal["x_m"] - start["x_m"], goal["y_m"] - start["y_m"]) <= 12:
                    break
            mission = {"robot": str(programs.SCENARIOS / "robots/nomad_super_scout.yaml"), **floor.keys,
                       "clearance_m": CLEARANCE_m, "start": start, "objective": {"minimize": "energy"}}
            turned = [{**mission, "stations": {"turned": {**at, "heading_rad": wrapped(at["heading_rad"] + turn)}, "goal": goal},
                       "legs": [{"to": "turned"}, {"to": "goal"}]}
                      for at in (start, goal) for turn in (math.pi / 2, math.pi, -math.pi / 2)]
            yield {**mission, "stations": {"goal": goal}, "legs": [{"to": "goal"}]}, turned


def even_robot(folder):
    """The Nomad with the same motor on both sides: what is mirrored costs the same."""
    text = (programs.SCENARIOS / "robots/nomad_super_scout.yaml").read_text()
    lines = ["  friction_torque_Nm: 0.36" if line.startswith("  friction_torque_Nm: {left") else line
             for line in text.splitlines()]
    (folder / "even.yaml").write_text("\n".join(lines) + "\n")
    return str(folder / "even.yaml")


def row(law, values):
    """Of the result's table; a value is None where nothing judges the case."""
    judged = [value for value in values if value is not None]
    if not judged:
        return f"| {law} | 0 | {len(values)} | - | - | - | **no** |"
    share = sum(value <= CLOSE_PERCENT for value in judged) / len(judged)
    kept = share >= SHARE and max(judged) <= WORST_PERCENT
    return (f"| {law} | {len(judged)} | {len(values) - len(judged)} | {100 * share:.0f} % | "
            f"{programs.quantile(judged, 0.5):.3f} % | {max(judged):.2f} % | {'yes' if kept else '**no**'} |")


def main():
    folder, program, note = pathlib.Path(sys.argv[1]).resolve(), *sys.argv[2:4]
    every = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    folder.mkdir(parents=True, exist_ok=True)
    motions, planner, robot, changes = Motions(folder), Planner(folder, program), even_robot(folder), {}

    def note_change(law, cost_J, least_J, both_ways=False):
        values = changes.setdefault(law, [])
        if not math.isfinite(least_J):
            values.append(None)
            print(law, "no plan to compare with", file=sys.stderr, flush=True)
            return
        percent = 100 * (cost_J / least_J - 1)
        values.append(abs(percent) if both_ways else max(0.0, percent))
        print(law, f"{least_J:.2f} {cost_J:.2f} J {percent:+.2f} %", file=sys.stderr, flush=True)

    for k, (_, _, _, mission) in list(enumerate(programs.missions(folder, legs=2, seed=541)))[::every]:
        mission = {**mission, "robot": robot}
        plan = planner.plan(mission)
        if not math.isfinite(plan["energy_J"]):
            raise SystemExit(f"mission {k}: no plan to compare with")
        print(f"mission {k}", file=sys.stderr)
        for law in ("mirrored", "turned", "moved"):
            note_change(law, planner.plan(getattr(motions, law)(mission))["energy_J"], plan["energy_J"], True)
        for seed in SEEDS:
            note_change("another seed", planner.plan(mission, seed)["energy_J"], plan["energy_J"], True)
        for law, easy, hard in easier(mission, plan):
            costs = [plan if asked is mission else planner.plan(asked) for asked in (easy, hard)]
            note_change(law, costs[0]["energy_J"], costs[1]["energy_J"])
    in_line_J = {}
    for off, line in straight_legs(folder):
        key = json.dumps(line)
        if key not in in_line_J:
            in_line_J[key] = planner.plan(line)["energy_J"]
        note_change("headings off the line", planner.plan(off)["energy_J"], in_line_J[key])
    for free, turned in beside_walls(folder):
        least_J = min(planner.plan(mission)["energy_J"] for mission in turned)
        note_change("a turn first or last, beside walls", planner.plan(free)["energy_J"], least_J)
    print(f"# Laws of plans\n\n{note}\n")
    print("The first four rows count how far the same problem ends from itself, the others by how much an easier problem "
          "is dearer than a harder one: missions of `benchmarks/ways/programs.py`, the Nomad with two motors alike. The "
          "last row but one counts by how much a straight leg of 2, 5 or 12 m on an open floor is dearer where its headings "
          "are 0.001 to 0.035 rad off the line: the shipped Nomad and `amr_150kg`. The last row: a leg whose ends lie 0.1 to "
          "20 mm farther from a wall than the clearance, by how much it is dearer than the same leg with a turn by a quarter "
          "or half of a turn, before it or after it, that the plan was free to make. \"Not judged\": cases "
          "of which no harder problem has a plan.\n")
    print(f"| law | plans | not judged | within {CLOSE_PERCENT} % | median | worst | "
          f"at least {100 * SHARE:.0f} % within {CLOSE_PERCENT} % and worst {WORST_PERCENT} % |")
    print("|---|---|---|---|---|---|---|")
    for law, values in changes.items():
        print(row(law, values))


if __name__ == "__main__":
    main()
