"""Attacks on the judge of the public problem set: answers that are not what they say must be refused or not count as better.

Design: docs/decisions/0803-judges.md
"""
import copy
import json
import pathlib
import re
import subprocess
import sys

from with_numpy import np

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "benchmarks/problems"
sys.path.insert(0, str(FOLDER))
from check import evaluate, profile, verdict  # noqa: E402

DATA = json.loads((FOLDER / "problems.json").read_text())
GIVEN = json.loads((FOLDER / "solutions.json").read_text())
PROBLEMS = {p["id"]: p for p in DATA["problems"]}
# A straight line of 12 m under a jerk limit of 0.5 m/s3: three pieces up, one of constant speed, three down.
PROBLEMS["s_curve"] = {**PROBLEMS["p001"], "id": "s_curve", "limits": {"speed_m_s": 1.0, "jerk_m_s3": 0.5}, "time": {"mode": "free"},
                       "path": {"s_m": [0, 12.0], "curvature_per_m": [0, 0]}, "best": {"value": 1e9, "lower_bound": 0.0}}
GIVEN["s_curve"] = {"time_s": [0, 1, 2, 3, 12, 13, 14, 15], "jerk_m_s3": [0.5, 0, -0.5, 0, -0.5, 0, 0.5]}
JERKY = [i for i in GIVEN if "jerk_m_s3" in PROBLEMS[i]["limits"]]
STEPS = [i for i in GIVEN if i not in JERKY]


def judged(identity, solution, **changes):
    problem = {**PROBLEMS[identity], **changes}
    return verdict(problem, evaluate(problem, DATA["robots"][problem["robot"]], solution))[1]


def test_the_s_curve_is_judged_by_its_closed_form():
    result = evaluate(PROBLEMS["s_curve"], DATA["robots"]["nomad_super_scout"], GIVEN["s_curve"])
    assert result["duration_s"] == 15 and abs(result["uses"]["speed_m_s"] - 1) < 1e-12 and result["uses"]["jerk_m_s3"] == 1, result
    assert judged("s_curve", GIVEN["s_curve"]) == "better"


def test_no_number_and_no_list_is_refused():
    for identity, solution in GIVEN.items():
        first, second = list(solution)[:2]
        n = len(solution[second]) // 2
        wrong = [{}, [], None, {first: solution[first]}, {**solution, second: solution[second][:-1]}, {**solution, second: "none"},
                 {**solution, first: [solution[first]], second: [solution[second]]}, {first: [0.0], second: [0.0]}]
        for value in (float("nan"), float("inf"), -float("inf"), 1e200, None, "x"):
            wrong += [{**solution, key: solution[key][:n] + [value] + solution[key][n + 1:]} for key in (first, second)]
        wrong += [{**solution, "wait_s": value} for value in (float("nan"), float("inf"), -1e-3, "x", None)]
        for answer in wrong:
            free = {"time": {"mode": "free"}, "standby_W": 0.0}  # where waiting costs nothing
            assert judged(identity, answer).startswith("BREAKS"), (identity, str(answer)[:80])
            assert judged(identity, answer, **free).startswith("BREAKS"), (identity, str(answer)[:80])


def test_a_shorter_way_is_refused():
    for identity in STEPS:
        s, v = GIVEN[identity]["s_m"], GIVEN[identity]["speed_m_s"]
        for answer in ({"s_m": [x * (1 - 1e-8) for x in s], "speed_m_s": v}, {"s_m": s[:-2] + s[-1:], "speed_m_s": v[:-2] + [0.1]},
                       {"s_m": [0.0, *s[2:]], "speed_m_s": v[1:]}, {"s_m": s[:-1], "speed_m_s": v[:-2] + [0.0]},
                       {"s_m": [1e-6, *s[1:]], "speed_m_s": v}, {"s_m": s[::-1], "speed_m_s": v}):
            assert judged(identity, answer) == "BREAKS form by inf", identity


def test_a_node_beside_a_knot_by_rounding_is_judged_as_on_it():
    for identity in STEPS:
        problem, solution = PROBLEMS[identity], GIVEN[identity]
        robot, s = DATA["robots"][problem["robot"]], np.array(solution["s_m"])
        near = np.isclose(s[:, None], problem["path"]["s_m"][1:-1], rtol=1e-12, atol=0).any(1)
        uses = evaluate(problem, robot, solution)["uses"]
        for ulps in (-4, -1, 1, 4):
            beside = evaluate(problem, robot, {**solution, "s_m": np.where(near, s + ulps * np.spacing(s), s).tolist()})["uses"]
            for key in uses:
                assert abs(beside[key] - uses[key]) <= 1e-6, (identity, ulps, key, uses[key], beside[key])


def test_anothers_answer_is_refused():
    for identity in GIVEN:
        for other in GIVEN:
            if other != identity:
                assert judged(identity, GIVEN[other]).startswith("BREAKS"), (identity, other)


def test_another_duration_is_refused():
    for identity in STEPS:
        for factor in (1 - 2e-6, 1 + 2e-6, 0.9, 1.1):
            duration_s = evaluate(PROBLEMS[identity], DATA["robots"][PROBLEMS[identity]["robot"]], GIVEN[identity])["duration_s"]
            asked = {"mode": "exactly", "duration_s": factor * duration_s}
            assert judged(identity, GIVEN[identity], time=asked).startswith("BREAKS duration_s"), (identity, factor)
        asked = {"mode": "at_most", "duration_s": duration_s * (1 - 2e-6)}
        assert judged(identity, GIVEN[identity], time=asked).startswith("BREAKS duration_s"), identity


def test_a_peak_between_two_nodes_is_seen():
    """A path of one stretch, a profile of one segment: |k| v^2 = K x B (1 - x/(2 share)) has its peak at x = share."""
    like = {**PROBLEMS["p002"], "time": {"mode": "free"}}
    robot, bend, square = DATA["robots"][like["robot"]], 0.8, 0.9
    for share in (0.53, 0.61234, 0.75, 0.7503, 0.97):
        path, ends = [0.0, bend], [square**0.5, (square * (1 - 0.5 / share)) ** 0.5]
        for turned in (False, True):
            problem = {**like, "path": {"s_m": [0, 10.0], "curvature_per_m": path[::-1] if turned else path},
                       "end_speeds_m_s": ends[::-1] if turned else ends}
            peak = bend * square * share / 2
            for excess, refused in ((1.2e-6, True), (8e-7, False)):
                problem["limits"] = {"lateral_acceleration_m_s2": peak / (1 + excess)}
                result = evaluate(problem, robot, {"s_m": [0, 10.0], "speed_m_s": problem["end_speeds_m_s"]})
                assert verdict(problem, result)[1].startswith("BREAKS lateral") == refused, (share, excess, result["uses"])


def divided(solution, parts):
    """The same motion told by more nodes."""
    s = np.unique(np.concatenate([solution["s_m"], np.linspace(0, solution["s_m"][-1], parts)[1:-1]]))
    s = s[np.concatenate([[True], np.diff(s) > 1e-7])]
    s[-1] = solution["s_m"][-1]
    v = np.sqrt(np.interp(s, solution["s_m"], np.square(solution["speed_m_s"])))
    return {**solution, "s_m": s.tolist(), "speed_m_s": v.tolist()}


def test_the_energy_is_that_of_the_motion_not_of_its_nodes():
    """Braking energy is kept or lost at once: a quadrature that is blind to the change of sign would pay for few nodes."""
    for identity in STEPS:
        problem, robot = PROBLEMS[identity], DATA["robots"][PROBLEMS[identity]["robot"]]
        coarse = {**GIVEN[identity], "s_m": [*GIVEN[identity]["s_m"][::9][:-1], GIVEN[identity]["s_m"][-1]],
                  "speed_m_s": [*GIVEN[identity]["speed_m_s"][::9][:-1], GIVEN[identity]["speed_m_s"][-1]]}
        fine = divided(coarse, 5000)
        one, other = evaluate(problem, robot, coarse)["energy_J"], evaluate(problem, robot, fine)["energy_J"]
        assert abs(one / other - 1) < 1e-6 / 3, (identity, one / other - 1)


def test_tolerances_are_not_to_be_spent():
    """All limits, the duration and the end together, used to 1e-6: it is valid, and never better."""
    for identity in GIVEN:
        solution = copy.deepcopy(GIVEN[identity])
        if identity in STEPS:
            solution["speed_m_s"] = [v * (1 + 0.3e-6) for v in solution["speed_m_s"]]
        words = [judged(identity, solution)]
        problem = copy.deepcopy(PROBLEMS[identity])
        problem["best"] = {"value": 1e9, "lower_bound": 0.0}  # anything is below this best
        result = evaluate(problem, DATA["robots"][problem["robot"]], solution)
        most = max(result["uses"].values())
        words.append(verdict(problem, result)[1])
        if 1 + 1e-9 < most <= 1 + 1e-6:  # what this answer uses
            assert words == ["valid", "valid"], (identity, most, words)
    problem = {**PROBLEMS["p001"], "best": {"value": 1e9, "lower_bound": 0.0}}
    strict = {"energy_J": 1.0, "duration_s": 1.0, "uses": {"speed_m_s": 1 + 1e-10}}
    assert verdict(problem, strict)[1] == "better"
    assert verdict(problem, {**strict, "uses": {"speed_m_s": 1 + 1e-8}})[1] == "valid"


def test_a_step_of_speed_in_no_distance_is_refused():
    s, v = GIVEN["p001"]["s_m"], GIVEN["p001"]["speed_m_s"]
    k = len(s) // 2
    for gap_m in (1e-9, 1e-12, np.spacing(s[k])):
        answer = {"s_m": s[:k + 1] + [s[k] + gap_m] + s[k + 1:], "speed_m_s": v[:k + 1] + [v[k] * (1 + 1e-4)] + v[k + 1:]}
        assert judged("p001", answer).startswith("BREAKS"), gap_m


def test_a_leap_in_no_time_is_refused():
    """So fast that its time rounds to nothing: a judge that goes by instants must not pass over it."""
    s, v = GIVEN["p001"]["s_m"], GIVEN["p001"]["speed_m_s"]
    k = len(s) // 2
    for speed_m_s in (1e3, 1e9, 1e13, 1e15, 1e17, 1e200):
        answer = {"s_m": s[:3] + s[k:], "speed_m_s": v[:2] + [speed_m_s, speed_m_s] + v[k + 1:]}
        assert judged("p001", answer).startswith("BREAKS"), speed_m_s


def test_standing_still_is_told_as_waiting_only():
    problem, solution = PROBLEMS["p001"], GIVEN["p001"]
    k = len(solution["s_m"]) // 2
    for low in (0.0, -0.1):
        answer = {**solution, "speed_m_s": solution["speed_m_s"][:k] + [low] + solution["speed_m_s"][k + 1:]}
        assert judged("p001", answer) == "BREAKS form by inf"
    moving = {**solution, "speed_m_s": solution["speed_m_s"][:-1] + [0.1], "wait_s": 1.0}
    assert judged("p001", moving, end_speeds_m_s=[0, 0.1]) == "BREAKS form by inf"  # nobody waits at 0.1 m/s
    assert problem["end_speeds_m_s"] == [0, 0]


def test_a_jerk_limit_asks_for_jerk():
    for identity in JERKY:
        problem, solution = PROBLEMS[identity], GIVEN[identity]
        t, j = solution["time_s"], solution["jerk_m_s3"]
        nodes = profile(problem, solution)
        as_speeds = {"s_m": np.append(nodes[1][:-1], problem["path"]["s_m"][-1]).tolist(), "speed_m_s": [0, *nodes[2][1:-1], 0]}
        assert judged(identity, as_speeds).startswith("BREAKS jerk"), identity  # acceleration has steps
        assert judged(identity, {"time_s": t, "jerk_m_s3": [x * 1.01 for x in j]}).startswith("BREAKS"), identity
        faster = {"time_s": [x / 1.001 for x in t], "jerk_m_s3": [x * 1.001**3 for x in j]}  # the same way, a little sooner
        assert judged(identity, faster).startswith("BREAKS"), identity
        assert judged(identity, {"time_s": t[:-1], "jerk_m_s3": j[:-1]}) == "BREAKS form by inf", identity
        assert judged(identity, {"time_s": t, "jerk_m_s3": [-x for x in j]}) == "BREAKS form by inf", identity


def test_a_stop_of_the_brakes_at_the_goal_is_a_step():
    """The S-curve without its last piece: at rest in the goal, but with a deceleration of 0.5 m/s2 that ends at once."""
    cruise = (12 - 1.5 - (1 - 0.5 / 6) - 0.75 * 1.5 / 2) + 3
    answer = {"time_s": [0, 1, 2, 3, cruise, cruise + 1, cruise + 2.5], "jerk_m_s3": [0.5, 0, -0.5, 0, -0.5, 0]}
    assert judged("s_curve", answer) == "BREAKS form by inf"
    assert judged("s_curve", {**answer, "time_s": answer["time_s"] + [cruise + 2.5 + 1e-6],
                              "jerk_m_s3": answer["jerk_m_s3"] + [0.5e6]}).startswith("BREAKS jerk")


def test_a_way_back_between_two_nodes_is_refused():
    """There and back and there again: it ends where it should, at rest, and its nodes stand still."""
    first, back = (0.5, -0.5, -0.5, 0.5), (-0.25, 0.25, 0.25, -0.25)
    jerk, time_s = [*first, *back, *first], list(range(13))
    problem = {**PROBLEMS["p001"], "time": {"mode": "free"}, "limits": {"jerk_m_s3": 1.0}, "kind": "straight"}
    problem["path"] = {"s_m": [0, 1.0 - 0.5 + 1.0], "curvature_per_m": [0, 0]}
    result = evaluate(problem, DATA["robots"][problem["robot"]], {"time_s": time_s, "jerk_m_s3": jerk})
    assert result["uses"].get("form") == np.inf, result


def test_no_small_change_of_a_best_answer_counts_as_better():
    random = np.random.default_rng(7)
    for identity in STEPS:
        s, v = np.array(GIVEN[identity]["s_m"]), np.array(GIVEN[identity]["speed_m_s"])
        for size in (1e-7, 1e-6, 1e-5, 1e-4):
            wave = 1 + size * np.interp(s, np.linspace(0, s[-1], 7), random.uniform(-1, 1, 7))
            words = judged(identity, {**GIVEN[identity], "speed_m_s": (v * wave).tolist()})
            assert words == "valid" or words.startswith("BREAKS"), (identity, size, words)


def test_a_file_that_answers_nothing_is_an_error():
    folder = pathlib.Path(sys.argv[1])
    for text in ("{}", '{"p999": {"s_m": [0, 1], "speed_m_s": [0, 0]}}', '{"p001": null}'):
        (folder / "attack.json").write_text(text)
        run = subprocess.run([sys.executable, "-B", FOLDER / "check.py", folder / "attack.json"], capture_output=True, text=True)
        assert run.returncode == 1 and "Traceback" not in run.stderr, (text, run)


if __name__ == "__main__":
    for name, test in list(globals().items()):
        if re.match("test_", name):
            test()
            print("ok", name)
