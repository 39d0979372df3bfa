"""The public problem set and its judge: a closed form, each limit broken on its own, the committed answers and bounds."""
import copy
import json
import pathlib
import re
import subprocess
import sys

from with_numpy import np

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "benchmarks/problems"
sys.path.insert(0, str(FOLDER))
from check import TOLERANCE, evaluate  # noqa: E402

DATA = json.loads((FOLDER / "problems.json").read_text())
GIVEN = json.loads((FOLDER / "solutions.json").read_text())


def nomad():
    robot = copy.deepcopy(DATA["robots"]["nomad_super_scout"])
    robot["wheel_axle_inertia_kg_m2"] = 0.148 - 23.98 * 0.01 / 2  # J = 0.148 kg m2 per wheel
    return robot


def closed_form():
    """A straight line in fixed time with signed power: v = V (1 - cosh(k (t - T/2))/cosh(k T/2)); 79.5060763 J."""
    T, length, J, nu, K, ohm = 17.3694, 10.0, 0.148, 0.0017, 0.069 * 24.9, 2.74
    k = np.sqrt(nu * (nu + K * K / ohm)) / J
    t = np.linspace(0, T, 4001)
    shape = 1 - np.cosh(k * (t - T / 2)) / np.cosh(k * T / 2)
    way = t - np.sinh(k * (t - T / 2)) / (k * np.cosh(k * T / 2))
    way -= way[0]
    speed = length / way[-1] * shape
    s = length / way[-1] * way
    speed[[0, -1]], s[[0, -1]] = 0, (0, length)
    problem = {"payload_kg": 0, "standby_W": 0, "regeneration_efficiency": 1, "sharing": "wheel", "limits": {"speed_m_s": 1.0},
               "path": {"s_m": [0, length], "curvature_per_m": [0, 0]}, "end_speeds_m_s": [0, 0], "time": {"mode": "exactly", "duration_s": T}}
    return problem, {"s_m": s, "speed_m_s": speed}


def test_closed_form():
    problem, solution = closed_form()
    result = evaluate(problem, nomad(), solution)
    assert abs(result["energy_J"] / 79.5060763 - 1) < 1e-7, result
    assert abs(result["duration_s"] / 17.3694 - 1) < 1e-5, result


def test_standby_and_waiting_cost_their_time():
    problem, solution = closed_form()
    before = evaluate(problem, nomad(), solution)
    after = evaluate({**problem, "standby_W": 10}, nomad(), {**solution, "wait_s": 2.0})
    assert abs(after["energy_J"] - before["energy_J"] - 10 * (before["duration_s"] + 2)) < 1e-9


def test_broken_forms_are_refused():
    problem, solution = closed_form()
    for broken in ({"s_m": solution["s_m"] * 0.9}, {"speed_m_s": solution["speed_m_s"] + 0.1}, {"wait_s": -1.0},
                   {"speed_m_s": np.where(np.arange(4001) == 7, 0, solution["speed_m_s"])}):
        assert not evaluate(problem, nomad(), {**solution, **broken})["uses"].get("form", 0) <= 1, broken


def problem_of(identity):
    return next(p for p in DATA["problems"] if p["id"] == identity)


def test_committed_answers_hold_and_lie_above_their_bounds():
    for identity, solution in GIVEN.items():
        problem = problem_of(identity)
        result = evaluate(problem, DATA["robots"][problem["robot"]], solution)
        value = result["duration_s" if problem["time"]["mode"] == "least" else "energy_J"]
        assert max(result["uses"].values()) <= 1 + TOLERANCE, (identity, result)
        assert abs(value / problem["best"]["value"] - 1) < TOLERANCE, (identity, value)
        assert value >= problem["best"]["lower_bound"] * (1 - TOLERANCE), (identity, value)


def test_each_limit_is_seen():
    """A limit of 0.99 of what an answer uses is broken, and by that name."""
    seen = set()
    for identity, solution in GIVEN.items():
        problem = problem_of(identity)
        uses = evaluate(problem, DATA["robots"][problem["robot"]], solution)["uses"]
        for key in problem["limits"]:
            if uses[key] < 1e-6:
                continue
            tighter = copy.deepcopy(problem)
            tighter["limits"][key] *= 0.99 * uses[key]
            after = evaluate(tighter, DATA["robots"][problem["robot"]], solution)["uses"]
            assert after[key] > 1 + TOLERANCE, (identity, key)
            seen.add(key)
    assert seen == set().union(*(p["limits"] for p in DATA["problems"])), seen


def test_the_set_is_as_described():
    assert [p["id"] for p in DATA["problems"]] == [f"p{i:03}" for i in range(1, 241)]
    for i, p in enumerate(DATA["problems"]):
        assert (p["kind"] == "turn", "jerk_m_s3" in p["limits"]) == (200 <= i < 220, i >= 220), p["id"]
        if p["kind"] == "turn":
            assert p["path"]["curvature_per_m"] in ([1, 1], [-1, -1]) and p["path"]["s_m"][0] == 0, p["id"]
    schema = json.loads((FOLDER / "schema.json").read_text())["$defs"]["problem"]
    for p in DATA["problems"]:
        assert set(p) == set(schema["required"]) == set(schema["properties"]), p["id"]
        assert set(p["limits"]) <= set(schema["properties"]["limits"]["properties"]), p["id"]
        assert p["time"]["mode"] in schema["properties"]["time"]["properties"]["mode"]["enum"]
        assert p["kind"] in schema["properties"]["kind"]["enum"] and p["robot"] in DATA["robots"]
        assert p["best"]["lower_bound"] <= p["best"]["value"] * (1 + 1e-9), p["id"]
        assert np.all(np.diff(p["path"]["s_m"]) > 0) and len(p["path"]["s_m"]) == len(p["path"]["curvature_per_m"])


def test_the_judge_run_alone_refuses_what_breaks_a_limit():
    folder, identity = pathlib.Path(sys.argv[2]), next(iter(GIVEN))
    assert subprocess.run([sys.executable, FOLDER / "check.py"], stdout=subprocess.DEVNULL).returncode == 0
    for factor, word in ((1.05, "BREAKS"), (1.0, "valid")):
        solution = {**GIVEN[identity], "speed_m_s": [factor * v for v in GIVEN[identity]["speed_m_s"]]}
        (folder / "given.json").write_text(json.dumps({identity: solution}))
        run = subprocess.run([sys.executable, FOLDER / "check.py", folder / "given.json"], capture_output=True, text=True)
        assert word in run.stdout and run.returncode == (word == "BREAKS"), run.stdout


def test_poses_are_fifty_on_two_maps():
    rows = [line.split(",") for line in (FOLDER / "poses.csv").read_text().splitlines()[1:]]
    assert sorted({row[0] for row in rows}) == ["depot", "warehouse"] and len(rows) == 50
    assert all(0 < float(row[7]) < 2000 and np.isfinite([float(x) for x in row[1:6]]).all() for row in rows)


def test_the_program_reads_its_own_set(program):
    """The solver's fresh answers keep every limit and repeat the committed values, in turns and under a jerk limit, too."""
    subset = {**DATA, "problems": [problem_of(i) for i in (*list(GIVEN)[:3], "p201", "p221")]}
    folder = pathlib.Path(sys.argv[2])
    (folder / "subset.json").write_text(json.dumps(subset))
    subprocess.run([program, "solve", folder / "subset.json", folder / "answers.json"], check=True)
    answers = json.loads((folder / "answers.json").read_text())
    for p in subset["problems"]:
        result = evaluate(p, DATA["robots"][p["robot"]], answers[p["id"]])
        value = result["duration_s" if p["time"]["mode"] == "least" else "energy_J"]
        assert max(result["uses"].values()) <= 1 + TOLERANCE and abs(value / p["best"]["value"] - 1) < 1e-4, (p["id"], value)


if __name__ == "__main__":
    for name, test in list(globals().items()):
        if re.match("test_", name):
            test(*sys.argv[1:2] if "program" in name else ())
            print("ok", name)
