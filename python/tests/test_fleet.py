"""Fleets: laws of the plan, on seeded fleets; judged by code that shares nothing with the model (benchmarks/fleet)."""
import dataclasses
import json
import math
import pathlib
import random
import re
import subprocess
import sys

import pytest

import joulepath as jp

pytest.importorskip("ortools", reason="ortools is not installed")
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "benchmarks" / "fleet"))
import generator  # noqa: E402
import judge  # noqa: E402

from joulepath import fleet  # noqa: E402
from joulepath.fleet._alone import sets_of  # noqa: E402
from joulepath.fleet._bound import Limits, bound  # noqa: E402
from joulepath.fleet._solve import solve  # noqa: E402
from joulepath.fleet._floor import Floor, moves_of  # noqa: E402
from joulepath.fleet._hidden import energy_factor  # noqa: E402
from joulepath.fleet._problem import NEVER, Charger, Drive, Mission, Problem, Robot, RobotType  # noqa: E402
from joulepath.fleet._relaxed import relaxed_bound  # noqa: E402
from joulepath.fleet._routes import Routing  # noqa: E402
from joulepath.fleet._search import first_schedule, improve, rearranged, search  # noqa: E402
from joulepath.fleet._simulate import most_driven, simulate  # noqa: E402
from joulepath.fleet._study import FleetStudy, _never_dearer, rows_of, sentence, varied  # noqa: E402

SMALL = {"robots": 2, "missions": 4, "chargers": 1, "speeds": 1}
GOOD = pathlib.Path(__file__).resolve().parents[2] / "tests/data/broken/good/fleet.yaml"


def least(problem):
    """The proven cost, with every rule re-checked; None: infeasible."""
    status, found = solve(problem, workers=1)
    if found is None:
        assert status == "infeasible"
        return None
    assert status == "optimal" and judge.faults(problem, found) == []
    return found.cost


@pytest.mark.parametrize("seed", range(12))
def test_brute_force_over_permutations_finds_the_same_cost(seed):
    problem = generator.small(seed, **SMALL)
    status, found = solve(problem, workers=1)
    brute = judge.least_cost(problem)
    if found is None:
        assert status == "infeasible" and brute == float("inf")
        return
    assert judge.faults(problem, found) == []
    most_visits = max(sum(step.visit is not None for step in route) for route in found.routes)
    assert found.cost == brute or (most_visits > 1 and found.cost < brute)  # brute force has one visit of each robot
    assert bound(problem) <= found.cost


@pytest.mark.parametrize("seed", range(6))
def test_brute_force_finds_no_cheaper_schedule_of_three_speeds_and_narrow_windows(seed):
    problem = generator.tight(seed, robots=2, missions=4, chargers=1)
    status, found = search(problem, workers=1)
    if found is None:
        assert status == "infeasible" and judge.least_cost(problem) == float("inf")
        return
    assert status == "optimal" and judge.faults(problem, found) == []
    brute = judge.least_cost(problem, found.cost + 1)
    most_visits = max(sum(step.visit is not None for step in route) for route in found.routes)
    assert brute == found.cost or (most_visits > 1 and found.cost < brute)  # brute force has one visit of each robot


@pytest.mark.parametrize("seed", range(6))
def test_a_known_cost_loses_no_schedule_that_is_as_cheap(seed):
    """Limits, and sets of missions that cost a robot too much, are those of dearer schedules."""
    problem = generator.tight(seed, robots=2, missions=4, chargers=1)
    _, found = search(problem, workers=1)
    assert found is not None
    limits = Limits(problem, found.cost)
    sets = sets_of(problem, found.cost)
    assert bound(problem) <= sets.bound <= found.cost
    for r, route in enumerate(found.routes):
        assert sum(1 << step.mission for step in route) in sets.costs[r]
        for step in route:
            drive = problem.missions[step.mission].drives[problem.robots[r].type][step.speed]
            assert limits.soonest_start(step.mission) <= step.start_s
            assert step.start_s + drive.duration_s <= limits.latest_end(step.mission)
            assert limits.speed(step.mission, problem.robots[r].type, step.speed)
    again = solve(problem, workers=1, start=found)
    assert again[0] == "optimal" and again[1].cost == found.cost


@pytest.mark.parametrize(("made", "seed"), [(generator.tight, seed) for seed in range(8)] + [(generator.small, seed) for seed in range(8)])
def test_a_robot_alone_costs_what_brute_force_finds(made, seed):
    """With one robot nobody queues: labels lose only the taper, and what two visits share."""
    problem = made(seed, robots=1, missions=3, chargers=1)
    problem = dataclasses.replace(problem, robots=(dataclasses.replace(problem.robots[0], level=80_000),))
    brute = judge.least_cost(problem)
    if brute == float("inf"):
        return
    found = sets_of(problem, round(brute) + 1)
    assert found.bound == brute or (found.bound < brute and sum(charger >= 0 for _, _, _, charger in found.routes[0]) > 1)
    below = sets_of(problem, found.bound - 1)
    assert below.bound >= found.bound and below.routes == () and below.least[0][-1] <= found.bound
    again = sets_of(problem, round(brute) + 1, below.least)
    assert (again.bound, again.routes) == (found.bound, found.routes)


@pytest.mark.parametrize("seed", range(12))
def test_sets_below_rising_costs_prove_what_the_constraint_program_alone_proves(seed):
    problem = generator.small(seed, robots=3, missions=4, chargers=1, speeds=1)
    status, found = search(problem, workers=1)
    assert status in ("optimal", "infeasible")
    assert (found.cost if found else None) == least(problem)


def test_a_robot_drives_ways_of_its_own_type():
    """Two types: a program that takes the lighter one's ways is too cheap, and proves a schedule that is not the cheapest."""
    problem = generator.tight(211, robots=3, missions=6, chargers=1)
    status, found = solve(problem, workers=1, limit=20.0, start=first_schedule(problem))
    assert status == "optimal" and judge.faults(problem, found) == []
    assert found.cost == 293_485  # by brute force of benchmarks/fleet/judge.py, in a minute


RELAXED = [(generator.small, seed, SMALL) for seed in range(4)] + [
    (generator.tight, seed, {"robots": 2, "missions": 4, "chargers": 1}) for seed in range(6)]


@pytest.mark.parametrize(("made", "seed", "size"), RELAXED)
def test_routes_at_prices_bound_every_schedule_at_any_number_of_rounds(made, seed, size):
    problem = made(seed, **size)
    found = solve(problem, workers=1)[1]
    if found is not None:
        assert all(relaxed_bound(problem, found.cost + more, rounds) <= found.cost for rounds in (1, 7, 40) for more in (0, 50_000))


def test_a_day_of_missions_of_a_second_has_no_bound_by_routes():
    """Steps of time are no longer than a mission with its way: a day of them would take seconds a round."""
    problem = generator.small(2, robots=3, missions=8)
    tick, nothing = (Drive(1, 1_000, 1_100),), (Drive(0, 0, 0),)
    late = tuple(dataclasses.replace(m, drives={0: tick}, ready_s=86_400, due_s=NEVER) for m in problem.missions)
    problem = dataclasses.replace(problem, missions=late, ways={key: nothing for key in problem.ways})
    assert relaxed_bound(problem, 10**9, 1000) == 0


def test_what_a_robot_lacks_is_charged_though_another_one_holds_it():
    """28,000 for the mission and the direct way; what the robot lacks for them, 47,000, is charged in 47 s of standby."""
    problem = generator.queue(2, 50_000)
    full = dataclasses.replace(problem.robots[1], level=10**6)
    problem = dataclasses.replace(problem, robots=(problem.robots[0], full), missions=problem.missions[:1])
    assert bound(problem) == 32_700 and least(problem) == 36_000


@pytest.mark.parametrize(("made", "seed", "size"), RELAXED)
def test_an_assignment_of_ways_bounds_every_schedule(made, seed, size):
    problem = made(seed, **size)
    cost = least(problem)
    assert cost is None or bound(problem) <= cost


def test_a_way_by_a_charger_that_is_cheaper_than_the_direct_one_is_within_the_bound():
    """The quick way from the charger costs less with standby than the cheapest one: no schedule takes it, and no bound knows it."""
    way = {("start", "shelf"): (Drive(100, 50_000, 50_000),), ("start", "dock"): (Drive(1, 10, 10),),
           ("dock", "shelf"): (Drive(100, 1_000, 1_000), Drive(10, 2_000, 2_000))}
    places = ("start", "dock", "shelf")
    ways = {(0, a, b): way.get((a, b), (Drive(0, 0, 0),) if a == b else (Drive(100, 50_000, 50_000),)) for a in places for b in places}
    problem = Problem((RobotType(1_000_000, 100_000, 100),), (Robot("r", 0, "start", 130_000),), (Charger("dock", 1, 1_100, 1_100),),
                      (Mission("m", "shelf", "shelf", {0: (Drive(10, 1_000, 1_000),)}, (0,), 0, 25, 1),), ways)
    routing = Routing(problem)
    driven = routing.drive(routing.inserted())
    assert driven is not None and judge.faults(problem, driven) == [] and bound(problem) <= driven.cost
    assert least(problem) <= driven.cost


def test_a_type_without_missions_stands_where_no_way_leads():
    problem = generator.small(3, robots=3, missions=5, chargers=0)
    idle = Robot("idle", 1, "nowhere", 10**6)
    problem = dataclasses.replace(problem, types=(*problem.types, problem.types[0]), robots=(*problem.robots, idle))
    found = first_schedule(problem)
    assert found is not None and judge.faults(problem, found) == [] and found.routes[-1] == ()


def test_numbers_that_do_not_fit_are_refused():
    problem = generator.small(0, **SMALL)
    routing, missions = Routing(problem), range(len(problem.missions))
    other = [[] for _ in problem.robots[1:]]
    for orders in ([], [[*missions][1:], *other], [[*missions, 0], *other], [[*missions, 99], *other]):
        with pytest.raises(ValueError, match="order"):
            routing.drive(orders)
    slow = dataclasses.replace(problem.chargers[0], taper=problem.types[0].standby)
    nobody = dataclasses.replace(problem.missions[0], robots=())
    for changes in ({"missions": ()}, {"chargers": (slow,)}, {"missions": (nobody,)}, {"busy": ((7, 0, 1),)}):
        with pytest.raises(ValueError, match="RoutingProblem"):
            Routing(dataclasses.replace(problem, **changes))


def test_the_same_seed_rearranges_a_large_fleet_alike():
    problem = generator.large(2, robots=6, missions=40)
    start = first_schedule(problem)
    first, second = (rearranged(problem, start, 5, 2_000, lambda: False) for _ in range(2))
    assert first == second and first.cost < start.cost and judge.faults(problem, first) == []


def test_routes_at_prices_bound_waiting_and_use_that_the_assignment_leaves_out():
    """One robot, one mission that is ready late: the bound is the cost, but for rounding to steps of time."""
    problem = dataclasses.replace(generator.queue(1, 0), chargers=())
    mission = dataclasses.replace(problem.missions[0], ready_s=1000, due_s=1100, late_price=1000)
    late = dataclasses.replace(problem, missions=(mission,), robots=(dataclasses.replace(problem.robots[0], use_price=7_000, level=10**6),))
    cost = least(late)
    assert bound(late) <= cost - 90_000  # standby of the wait
    assert cost - 1_100 <= relaxed_bound(late, cost, 60) <= cost


@pytest.mark.parametrize(("robots", "need"), [(1, 20_000), (2, 30_000), (3, 50_000)])
def test_equal_robots_at_one_charger_are_the_closed_form_of_a_queue(robots, need):
    assert least(generator.queue(robots, need)) == generator.queue_cost(robots, need)


@pytest.mark.parametrize("seed", [1, 3, 15])
def test_names_and_orders_of_robots_and_missions_do_not_matter(seed):
    problem, chance = generator.small(seed, **SMALL), random.Random(seed)
    robots, missions = list(range(len(problem.robots))), list(range(len(problem.missions)))
    chance.shuffle(robots)
    chance.shuffle(missions)
    place = {r: k for k, r in enumerate(robots)}
    other = dataclasses.replace(
        problem, robots=tuple(dataclasses.replace(problem.robots[r], name=f"x{k}") for k, r in enumerate(robots)),
        missions=tuple(dataclasses.replace(problem.missions[m], name=f"y{k}", robots=tuple(sorted(place[r] for r in problem.missions[m].robots)))
                       for k, m in enumerate(missions)))
    assert least(other) == least(problem)


@pytest.mark.parametrize("seed", [1, 6])
def test_a_shift_of_all_times_costs_nothing(seed):
    problem, later = generator.small(seed, **SMALL), 1000
    shifted = dataclasses.replace(
        problem, robots=tuple(dataclasses.replace(r, from_s=r.from_s + later, to_s=min(NEVER, r.to_s + later)) for r in problem.robots),
        missions=tuple(dataclasses.replace(m, ready_s=max(m.ready_s, 0) + later, due_s=m.due_s + later) for m in problem.missions))
    assert least(shifted) == least(problem)


@pytest.mark.parametrize("seed", [1, 9, 15, 19])
def test_a_charger_more_and_more_time_are_never_dearer(seed):
    problem = generator.small(seed, **SMALL)
    cost = least(problem)
    first = problem.missions[0].first
    more = dataclasses.replace(problem, chargers=(*problem.chargers, Charger(first, 1, 2500, 1000, 0.8)))
    later = dataclasses.replace(problem, missions=tuple(dataclasses.replace(m, due_s=m.due_s + 100) for m in problem.missions))
    double = dataclasses.replace(problem, chargers=tuple(dataclasses.replace(c, count=2) for c in problem.chargers))
    for helped in (more, later, double):
        assert least(helped) <= (cost if cost is not None else float("inf"))


def test_the_same_seed_gives_the_same_schedule():
    problem = generator.small(3, robots=2, missions=5)
    first, second = (search(problem, seed=7, workers=2, limit=5.0) for _ in range(2))
    assert first == second


@pytest.mark.parametrize("seed", range(20, 26))
def test_schedules_without_a_solver_keep_every_rule(seed):
    problem = generator.small(seed)
    routing = Routing(problem)
    for found in (routing.dispatch(), routing.drive(routing.inserted())):
        if found is not None:
            assert judge.faults(problem, found) == []
            assert bound(problem) <= found.cost


def test_neighborhoods_never_make_a_schedule_dearer_or_break_a_rule():
    problem = generator.small(31, robots=4, missions=12)
    start = first_schedule(problem)
    found = improve(problem, start, seed=1, workers=1, limit=4.0, tell=lambda _: None, stop=lambda: False)
    assert found.cost <= start.cost and judge.faults(problem, found) == []
    assert improve(problem, start, seed=1, workers=1, limit=4.0, tell=lambda _: None, stop=lambda: True) == start


def test_the_judge_sees_broken_rules():
    problem = next(p for p in (generator.small(seed, **SMALL) for seed in range(40)) if solve(p, workers=1)[1]
                   and any(step.visit for route in solve(p, workers=1)[1].routes for step in route))
    found = solve(problem, workers=1)[1]
    r, n, step = next((r, n, s) for r, route in enumerate(found.routes) for n, s in enumerate(route) if s.visit)

    def broken(changed):
        route = found.routes[r][:n] + (changed,) + found.routes[r][n + 1:]
        return judge.faults(problem, dataclasses.replace(found, routes=found.routes[:r] + (route,) + found.routes[r + 1:]))

    assert broken(dataclasses.replace(step, start_s=step.visit.to_s - 1))
    assert broken(dataclasses.replace(step, visit=dataclasses.replace(step.visit, target=step.visit.target + 10**6)))
    assert broken(dataclasses.replace(step, visit=dataclasses.replace(step.visit, to_s=step.visit.from_s)))


def test_executions_breach_the_reserve_no_more_than_the_bound_says():
    problem = generator.queue(3, 50_000)
    found = solve(problem, workers=1)[1]
    assert found is not None
    seen = simulate(problem, found, 1000, seed=1)
    assert seen.breaches <= 0.08 * seen.days
    assert seen.breaches_binding == seen.breaches
    hidden = simulate(problem, found, 200, seed=1, factor={0: 2.0, 1: 2.0, 2: 2.0})
    assert hidden.breaches >= seen.breaches


def test_a_fleet_file_is_planned_and_saved(tmp_path):
    found = fleet.plan(GOOD, cache=False, workers=1)
    assert found.status == "optimal" and found.bound_J == found.cost_J
    assert judge.faults(found.problem, found.schedule) == []
    found.save(tmp_path / "out")
    content = json.loads((tmp_path / "out/fleet.json").read_text())
    assert content["missions"][0]["name"] == "parts" and content["missions"][0]["late_s"] == 0
    page = (tmp_path / "out/report.html").read_text()
    assert "Traffic" in page and re.search(r"<title>Fleet .* · \d{4}-\d\d-\d\d · joulepath \d.*</title>", page)
    planned = json.loads((tmp_path / "out/missions/parts/plan.json").read_text())
    assert planned["status"] in ("optimal", "feasible")  # driven; the fast solver leaves a gap at a front's edge
    with pytest.raises(jp.ConfigError, match="exists"):
        found.save(tmp_path / "out")
    for robot in content["robots"]:  # the battery goes on where it ended
        before = robot["timeline"][0]["from_s"] if robot["timeline"] else 0
        for item in robot["timeline"]:
            assert item["from_s"] == before and item["battery_fraction_lower_95"] <= item["battery_fraction"]
            before = item["to_s"]


def test_one_robot_without_a_charger_drives_the_order_of_visits(tmp_path, scenarios):
    """Missions of one stop without windows are the stops of a mission with visit:, whose order the core proves."""
    stations = {"dock": (2.0, -23.5, 0.0), "shelf_3": (-6.9, -11.0, 1.5708), "shelf_7": (12.45, -16.25, 1.5708), "shelf_9": (8.5, 2.0, 3.1416)}
    common = {"map": str(scenarios / "maps/warehouse.yaml"), "clearance_m": 0.05,
              "stations": {name: {"x_m": x, "y_m": y, "heading_rad": w} for name, (x, y, w) in stations.items()}}
    robot, stops = str(scenarios / "robots/nomad_super_scout.yaml"), ["shelf_9", "shelf_3", "shelf_7"]
    (tmp_path / "fleet.json").write_text(json.dumps({
        **common, "robots": [{"name": "one", "robot": robot, "start": "dock"}],
        "missions": [{"name": stop, "stops": [{"station": stop}]} for stop in stops]}))
    found = fleet.plan(tmp_path / "fleet.json", workers=1)
    order = [found.problem.missions[step.mission].name for step in found.schedule.routes[0]]
    mission = {**common, "robot": robot, "start": {"station": "dock"}, "visit": [{"go": stop} for stop in stops]}
    today = jp.plan(mission, solver="fast", baselines=False)
    assert order == [leg.to for leg in today.legs]


def test_an_infeasible_fleet_names_the_mission_and_what_helps(tmp_path):
    text = GOOD.read_text().replace("map: map.yaml", f"map: {GOOD.parent / 'map.yaml'}").replace("robot: robot.yaml", f"robot: {GOOD.parent / 'robot.yaml'}")
    short = text.replace("start: shelf, from_s: 60, to_s: 7200", "start: shelf, from_s: 60, to_s: 62").replace("battery_fraction: 1.0", "to_s: 31")
    (tmp_path / "fleet.yaml").write_text(short)
    found = fleet.plan(tmp_path / "fleet.yaml", cache=False, workers=1)
    assert found.status == "infeasible" and found.json["reason"]["mission"] == "parts"
    later = next(h for h in found.help if h["help"] == "shift")
    for end_s in (31, 62):  # the help moves the ends of all shifts
        short = short.replace(f"to_s: {end_s}", f"to_s: {end_s + round(later['later_s'])}")
    (tmp_path / "helped.yaml").write_text(short)
    assert fleet.plan(tmp_path / "helped.yaml", cache=False, workers=1).status == "optimal"


@pytest.mark.parametrize(("name", "place"), [
    ("nobody_reaches_it", "12:37: missions[0].stops[0].station"), ("too_heavy", "12:56: missions[0].stops[0].payload_kg"),
    ("charger_in_a_rack", "10:22: chargers[0].station"), ("window_ends_first", "12:98: missions[0].due_s"),
    ("below_reserve", "8:73: robots[0].battery_fraction"), ("same_name", "9:12: robots[1].name"), ("no_margin", "7:22: robots[0].robot")])
def test_bad_input_is_one_line_with_file_line_and_key_and_leaves_nothing(tmp_path, name, place):
    broken = GOOD.parent.parent / f"fleet/{name}.yaml"
    run = subprocess.run([sys.executable, "-m", "joulepath", "fleet", str(broken), "--out", str(tmp_path / "out")], capture_output=True, text=True)
    assert run.returncode == 2 and not (tmp_path / "out").exists()
    assert f"{name}.yaml:{place}: found " in run.stderr and run.stderr.count("\n") == 1


@pytest.fixture(scope="module")
def planned():
    return fleet.plan(GOOD, cache=False, workers=1)


def test_an_order_is_what_the_program_exports(planned, tmp_path):
    planned.save(tmp_path / "out")
    order = json.loads((tmp_path / "out/missions/parts/order.json").read_text())
    assert order["orderId"] == "parts" and order["serialNumber"] in ("a", "b")
    assert [node["nodeId"] for node in order["nodes"]][::len(order["nodes"]) - 1] == ["shelf", "dock"]
    assert all(edge["maximumSpeed"] > 0 for edge in order["edges"])
    driven = jp.plan(tmp_path / "out/missions/parts/order.json", robot=GOOD.parent / "robot.yaml", solver="fast", baselines=False)
    first = json.loads((tmp_path / "out/missions/parts/plan.json").read_text())
    assert sum(leg.distance_m for leg in driven.legs) == pytest.approx(sum(leg["distance_m"] for leg in first["legs"]), rel=1e-3)


def test_the_playback_moves_robots_between_their_places(planned):
    moves = moves_of(planned._source, planned.json)
    floor, stations = Floor(planned._source.map_picture), planned._source.content["floor"]["stations"]
    places = {name: floor.at(place["x_m"], place["y_m"]) for name, place in stations.items()}
    for robot, line in zip(moves["robots"], planned.json["robots"]):
        assert [(begin, end) for begin, end, _ in robot["moves"]] == sorted((begin, end) for begin, end, _ in robot["moves"])
        at, last_s = robot["start"], line["timeline"][-1]["to_s"] if line["timeline"] else 0
        for begin, end, track in robot["moves"]:
            assert 0 <= begin < end <= last_s
            assert moves["tracks"][track][0][1:] == pytest.approx(at, abs=0.2)
            at = moves["tracks"][track][-1][1:]
            assert min(math.dist(at, place) for place in places.values()) < 0.2


def test_a_picture_has_the_cells_of_the_map(planned):
    width, height, _, _, runs = planned._source.map_picture
    assert sum(count for _, count in runs) == width * height
    assert Floor(planned._source.map_picture).png().startswith("data:image/png;base64,")


def test_more_friction_takes_more_energy_and_the_rule_keeps_the_reserve(planned):
    assert 1.0 < energy_factor(planned._source, planned.schedule, most_driven(planned.schedule)) < 1.1
    problem = generator.queue(3, 50_000)
    found = solve(problem, workers=1)[1]
    hidden = simulate(problem, found, 400, seed=2, factor={r: 1.2 for r in range(3)})
    ruled = simulate(problem, found, 400, seed=2, factor={r: 1.2 for r in range(3)}, charge_now=True)
    assert ruled.breaches < hidden.breaches and ruled.late_s >= hidden.late_s
    assert planned.simulate(20, seed=3) == planned.simulate(20, seed=3)
    assert planned.json["executions"][0]["runs"] == 20


def test_the_answer_counts_what_each_robot_does(planned):
    from joulepath.fleet._program import _answer

    first, *robots = _answer(planned)
    assert first.startswith(f"{planned.status}: {planned.cost_J:.1f} J")
    counts = [re.match(r"(\w+): (?:(\d+) missions?, (\d+) charges?, until (\d+) s|stays)$", line).groups() for line in robots]
    assert sum(int(missions or 0) for _, missions, _, _ in counts) == len(planned.json["missions"])
    assert sum(int(charges or 0) for _, _, charges, _ in counts) == sum(len(charger["visits"]) for charger in planned.json["chargers"])
    assert max(int(until or 0) for *_, until in counts) == max(item["to_s"] for robot in planned.json["robots"] for item in robot["timeline"])


def test_a_late_mission_says_how_its_robot_spent_the_time(tmp_path):
    text = GOOD.read_text().replace("map: map.yaml", f"map: {GOOD.parent / 'map.yaml'}").replace("robot: robot.yaml", f"robot: {GOOD.parent / 'robot.yaml'}")
    (tmp_path / "fleet.yaml").write_text(text.replace("ready_s: 30, due_s: 600", "ready_s: 30, due_s: 31"))
    mission = fleet.plan(tmp_path / "fleet.yaml", workers=1).json["missions"][0]
    assert mission["late_s"] == mission["to_s"] - 31
    assert mission["why"] == f"it takes {mission['to_s'] - mission['from_s']} s, and its window has 1 s"


def test_a_schedule_that_is_not_proven_states_its_own_cost():
    problem = generator.small(0)
    start = first_schedule(problem)
    _, found = solve(problem, workers=1, limit=0.5, start=start)
    assert found is None or (judge.faults(problem, found) == [] and found.bound <= found.cost)


def studied(problem, places=(0, 1, 2), scales=(1.0,), client=None):
    return list(rows_of(problem, places, scales, client, seed=1, workers=1, limit=20.0))


@pytest.mark.parametrize("seed", [1, 5, 9])
def test_more_charging_places_are_never_dearer_in_a_study(seed):
    """Two of them keep a gap: what fewer places cost is still the most."""
    problem = generator.small(seed)
    rows = list(rows_of(problem, (2, 1, 3), (1.0,), None, seed=1, workers=1, limit=1.0))
    assert [row["charging_places"] for row in rows] == [1, 2, 3]
    costs = [row["cost_J"] if row["cost_J"] is not None else float("inf") for row in rows]
    assert costs == sorted(costs, reverse=True)
    assert all(row["bound_J"] <= row["cost_J"] for row in rows if row["cost_J"] is not None)


def test_a_study_says_what_it_tried_for_each_battery():
    def row(places, scale, cost_J):
        return {"charging_places": places, "battery_scale": scale, "cost_J": cost_J}

    rows = (row(0, 1.0, None), row(1, 1.0, 110.0), row(2, 1.0, 100.0), row(3, 1.0, 99.5), row(1, 0.5, 200.0), row(1, 0.1, None))
    assert sentence(FleetStudy("night", rows)) == (
        "Battery x 1: 2 places at each charger are enough, 100 J; up to 3 save 0.5 %. "
        "Battery x 0.5: 1 place at each charger is enough, 200 J; more were not tried. Battery x 0.1: no schedule was found.")


def test_a_bound_for_fewer_places_is_none_for_more():
    known = {"charging_places": 1, "battery_scale": 1.0, "status": "optimal", "cost_J": 100.0, "bound_J": 100.0}
    unknown = {"charging_places": 2, "battery_scale": 1.0, "status": "unknown", "cost_J": None, "bound_J": 80.0}
    dearer = {"charging_places": 3, "battery_scale": 1.0, "status": "feasible", "cost_J": 120.0, "bound_J": 100.0}
    rows = list(_never_dearer([known, unknown, dearer]))
    assert [(row["charging_places"], row["status"], row["cost_J"], row["bound_J"]) for row in rows] == [
        (1, "optimal", 100.0, 100.0), (2, "feasible", 100.0, 80.0), (3, "optimal", 100.0, 100.0)]


def test_a_study_states_what_each_fleet_costs_alone():
    problem = generator.small(7, **SMALL)
    for row in studied(problem, scales=(1.0, 3.0)):
        cost = least(varied(problem, row["charging_places"], row["battery_scale"]))
        assert row["cost_J"] == (None if cost is None else cost / 10)


def test_a_queue_of_three_shrinks_with_each_place():
    """Three robots that lack the same at one charger: with three places nobody waits, and the closed form of one robot holds."""
    problem = generator.queue(3, 50_000)
    rows = studied(problem, places=(0, 1, 2, 3))
    assert rows[0]["status"] == "infeasible" and rows[0]["cost_J"] is None
    assert rows[1]["cost_J"] == generator.queue_cost(3, 50_000) / 10 > rows[2]["cost_J"] > rows[3]["cost_J"]
    assert rows[3]["cost_J"] == 3 * generator.queue_cost(1, 50_000) / 10
    assert [row["visits"] for row in rows[1:]] == [3, 3, 3] and rows[3]["charged_s"] < rows[1]["charged_s"]


def test_a_study_on_a_cluster_has_the_same_rows():
    distributed = pytest.importorskip("distributed")
    problem = generator.small(7, **SMALL)
    with distributed.Client(n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None) as client:
        assert studied(problem, scales=(1.0, 2.0), client=client) == studied(problem, scales=(1.0, 2.0))


def test_a_study_is_saved_with_its_chart(tmp_path):
    found = fleet.study(GOOD, places=(1, 2), battery_scales=(1.0, 2.0), cache=False, workers=1, limit=5.0)
    found.save(tmp_path / "study")
    rows = json.loads((tmp_path / "study/study.json").read_text())["rows"]
    assert [(row["charging_places"], row["battery_scale"]) for row in rows] == [(1, 1.0), (2, 1.0), (1, 2.0), (2, 2.0)]
    page = (tmp_path / "study/report.html").read_text()
    assert page.count("<circle") == 4 and page.count("<polyline") == 2 and "is enough" in page
    assert len((tmp_path / "study/study.csv").read_text().splitlines()) == 5
    with pytest.raises(jp.ConfigError, match="a file that exists"):
        found.save(tmp_path / "study")


@pytest.mark.parametrize(("words", "says"), [(["--places", "1,x"], "places: found"), (["--places", "2", "--simulate", "3"], "simulate: found 3"),
                                             (["--places", "2", "--out", "."], "a file that exists")])
def test_the_command_refuses_a_study_before_it_plans(tmp_path, monkeypatch, capsys, words, says):
    from joulepath.fleet._program import main

    (tmp_path / "study.json").write_text("{}")
    monkeypatch.chdir(tmp_path)
    assert main([str(GOOD), *words]) == 2
    assert says in capsys.readouterr().err and (tmp_path / "study.json").read_text() == "{}"


@pytest.mark.parametrize("bad", [{"places": ()}, {"places": (1, 1)}, {"places": (-1,)}, {"places": (1.5,)}, {"places": "x"},
                                 {"battery_scales": (0.0,)}, {"client": 3}])
def test_a_study_refuses(bad):
    with pytest.raises(jp.ConfigError, match=next(iter(bad))):
        fleet.study(GOOD, cache=False, **bad)
