"""Tests of the benchmark itself: the plant's physics against closed forms, sealing, and the scorer's rules.

usage: python3 blind_selftest.py PLANT CONTROLS"""
import csv
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "benchmarks" / "blind" / "harness"))

import campaign
import examine
import judge
import plan
import plots
import scorecard
import seal
from statistics_of import calibration, smallest_found, wilson

PLANT, CONTROLS = sys.argv[1], sys.argv[2]
KT_N = 0.069 * 24.9


def generate(folder, *arguments):
    subprocess.run([PLANT, "--out", str(folder), *arguments], check=True)
    return folder


def read(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    return {key: [float(row[key]) for row in rows] for key in rows[0]}


def mean(values):
    return sum(values) / len(values)


def truth_parameter(folder, key):
    line = next(l for l in (folder / "truth.yaml").read_text().splitlines() if l.startswith("parameters"))
    return float(line.split(key + ": ")[1].split(",")[0].rstrip("}").replace("{left: ", ""))


def cruises(folder):
    """(speed, current, voltage) means of the left wheel over stretches of steady straight forward driving."""
    for path in sorted(folder.glob("run_*.csv")):
        log = read(path)
        n = len(log["time_s"])
        cut = slice(n // 2 - 60, n // 2 + 60)
        left, right = log["wheel_speed_left_rad_s"][cut], log["wheel_speed_right_rad_s"][cut]
        steady = abs(mean(left[:30]) - mean(left[-30:])) < 0.02 and abs(mean(left) - mean(right)) < 0.02
        if steady and mean(left) > 1:
            yield mean(left), mean(log["motor_current_left_A"][cut]), mean(log["motor_voltage_left_V"][cut])


def winding_constants(folder):
    """(R, K n, L) of the left wheel over all runs by instrumental variables."""
    system = [[0.0] * 4 for _ in range(3)]
    for path in sorted(folder.glob("run_*.csv")):
        log = read(path)
        i, q, v = (log[key] for key in ("motor_current_left_A", "wheel_speed_left_rad_s", "motor_voltage_left_V"))
        for k in range(5, len(i) - 5):
            near = [k - 4, k - 3, k - 2, k + 2, k + 3, k + 4]
            row = (i[k], q[k], i[k + 1] - i[k - 1], v[k])
            for a, z in enumerate((mean([i[j] for j in near]), mean([q[j] for j in near]), i[k + 3] - i[k - 3])):
                for b in range(4):
                    system[a][b] += z * row[b]
    for p in range(3):
        for k in range(3):
            if k != p:
                factor = system[k][p] / system[p][p]
                system[k] = [x - factor * y for x, y in zip(system[k], system[p])]
    return [system[k][3] / system[k][k] for k in range(3)]


class Plant(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def test_cruise_current_and_voltage_obey_the_steady_state(self):
        data = generate(self.folder / "null", "--seed", "11")
        friction, viscous = truth_parameter(data, "friction_torque_Nm"), truth_parameter(data, "viscous_friction_Nm_s_rad")
        kt_n, ohm = truth_parameter(data, "torque_constant_Nm_A") * 24.9, truth_parameter(data, "resistance_ohm")
        found = list(cruises(data))
        self.assertGreater(len(found), 5)
        for speed, current, voltage in found:
            self.assertAlmostEqual(current, (friction + viscous * speed) / kt_n, delta=0.008)
            self.assertAlmostEqual(voltage, ohm * current + kt_n * speed, delta=0.03)

    def test_rolling_resistance_adds_its_torque_and_nothing_else_changes(self):
        null = generate(self.folder / "a", "--seed", "12")
        rolling = generate(self.folder / "b", "--seed", "12", "--effect", "rolling_resistance", "--size", "0.01")
        kt_n = truth_parameter(null, "torque_constant_Nm_A") * 24.9
        lightest, heaviest = 23.98 * 9.80665 / 2 * 0.1 * 0.01 / kt_n, 34.48 * 9.80665 / 2 * 0.1 * 0.01 / kt_n
        for (q0, i0, _), (q1, i1, _) in zip(cruises(null), cruises(rolling)):
            self.assertAlmostEqual(q0, q1, delta=0.01)
            self.assertTrue(lightest - 0.006 < i1 - i0 < heaviest + 0.006, (i0, i1))

    def test_same_seed_same_bytes_other_seed_other_bytes(self):
        digest = lambda d: hashlib.sha256(b"".join(p.read_bytes() for p in sorted(d.iterdir()))).hexdigest()
        first = digest(generate(self.folder / "a", "--seed", "5", "--level", "1", "--protocol", "6"))
        self.assertEqual(first, digest(generate(self.folder / "b", "--seed", "5", "--level", "1", "--protocol", "6")))
        self.assertNotEqual(first, digest(generate(self.folder / "c", "--seed", "6", "--level", "1", "--protocol", "6")))

    def test_resistance_and_back_emf_are_not_biased_by_the_time_step(self):
        """V = R i + K q on means: instruments from neighboring samples, whose noise is not the sample's own."""
        data = generate(self.folder / "null", "--seed", "11")
        solved = winding_constants(data)
        self.assertAlmostEqual(solved[0] / truth_parameter(data, "resistance_ohm"), 1, delta=1e-3)
        self.assertAlmostEqual(solved[1] / (truth_parameter(data, "torque_constant_Nm_A") * 24.9), 1, delta=2e-4)

    def test_another_day_is_the_same_machine_on_other_runs(self):
        first = generate(self.folder / "a", "--seed", "5", "--protocol", "6", "--effect", "rolling_resistance")
        second = generate(self.folder / "b", "--seed", "5", "--protocol", "6", "--effect", "rolling_resistance", "--day", "1")
        line = lambda d, start: next(l for l in (d / "truth.yaml").read_text().splitlines() if l.lstrip().startswith(start))
        self.assertEqual(line(first, "parameters"), line(second, "parameters"))
        self.assertEqual(line(first, "- {effect"), line(second, "- {effect"))
        self.assertNotEqual((first / "run_01.csv").read_bytes(), (second / "run_01.csv").read_bytes())

    def test_a_proposed_run_is_driven_leg_by_leg(self):
        motion = {"legs": [{"profile": "trapezoid", "distance_m": 2.0, "speed_m_s": 0.4}, {"profile": "stand", "duration_s": 2},
                           {"profile": "trapezoid", "distance_m": 2.0, "speed_m_s": 0.4, "direction": "reverse"}], "payload_kg": 3.5}
        data = generate(self.folder / "a", "--seed", "5", "--protocol", "6", "--append", examine.described(motion))
        self.assertIn("run_07.csv, payload_kg: 3.5", (data / "dataset.yaml").read_text())
        x = read(data / "run_07.csv")["position_x_m"]
        self.assertAlmostEqual(max(x), 2.0, delta=0.05)
        self.assertAlmostEqual(x[-1], 0.0, delta=0.05)

    def test_the_oracle_sees_large_effects_and_no_tiny_ones(self):
        ratios = []
        for size in ("0.00005", "0.0005", "0.005"):
            label = self.folder / "label.json"
            subprocess.run([PLANT, "--effect", "rolling_resistance", "--size", size, "--seed", "3", "--protocol", "6",
                            "--label", str(label), "--oracle"], check=True)
            ratios.append(json.loads(label.read_text())["oracle"]["likelihood_ratio"])
        self.assertLess(ratios[0], 25)
        self.assertGreater(ratios[2], 25)
        self.assertAlmostEqual(ratios[2] / ratios[1], 100, delta=20)  # quadratic in the size

    def test_a_label_for_a_blind_run_stays_out_of_the_folder(self):
        data = generate(self.folder / "a", "--seed", "5", "--protocol", "6", "--label", "none", "--effect", "floor_slope")
        self.assertEqual(len(list(data.iterdir())), 8)
        for path in data.iterdir():
            self.assertNotIn("floor_slope", path.read_text())

    def test_controls_name_what_is_theirs_to_name(self):
        data = generate(self.folder / "a", "--seed", "8", "--effect", "dragging_wheel", "--size", "0.15")
        subprocess.run([CONTROLS, str(data), str(self.folder / "c.json")], check=True)
        said = json.loads((self.folder / "c.json").read_text())
        first = {name: [c["effect"] for c in answer["causes"]][:1] for name, answer in said.items()}
        self.assertEqual(first, {"always_friction": ["coulomb_friction"], "plain_refit": ["dragging_wheel"],
                                 "stlsq": ["dragging_wheel"], "black_box": []})
        self.assertGreater(said["stlsq"]["gap"]["energy"]["shrink_fraction"], 0.7)


@unittest.skipUnless(pathlib.Path(PLANT).with_name("blind_mujoco").exists(), "blind_mujoco is not built (libmujoco-dev)")
class MuJoCo(unittest.TestCase):
    def test_cruising_takes_friction_and_rolling_resistance_by_the_closed_form(self):
        with tempfile.TemporaryDirectory() as folder:
            data = pathlib.Path(folder) / "rolling"
            subprocess.run([str(pathlib.Path(PLANT).with_name("blind_mujoco")), "--effect", "rolling_resistance", "--size", "0.01", "--seed", "11",
                            "--protocol", "6", "--out", str(data)], check=True)
            friction, viscous = truth_parameter(data, "friction_torque_Nm"), truth_parameter(data, "viscous_friction_Nm_s_rad")
            mass, radius = truth_parameter(data, "chassis_mass_kg") + 2 * 1.39, truth_parameter(data, "wheel_radius_m")
            kt_n, found = truth_parameter(data, "torque_constant_Nm_A") * 24.9, list(cruises(data))
            self.assertGreater(len(found), 1)
            for speed, current, _ in found:  # payloads of 0 to 10.5 kg
                extra = kt_n * current - friction - viscous * speed
                self.assertGreater(extra, 0.01 * mass * 9.80665 / 2 * radius - 0.012)
                self.assertLess(extra, 0.01 * (mass + 10.7) * 9.80665 / 2 * radius + 0.012)

    def test_what_mujoco_has_no_form_for_is_refused(self):
        program = str(pathlib.Path(PLANT).with_name("blind_mujoco"))
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([program, "--effect", "gear_efficiency", "--out", folder, "--protocol", "6"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("no form of this effect", done.stderr)


def label(bin_name, *effects, detectable=True):
    return {"id": "x", "bin": bin_name, "level": 0, "robot": "nomad", "runs": 24,
            "effects": [{"effect": e, "foreign": bin_name == "foreign", "side": "", "parameters": {"p": 0.5}} for e in effects],
            "oracle": {"detectable": detectable, "where": {"phase": {"cruise": 0.7, "turn": 0.3}, "wheel": {"left": 0.5, "right": 0.5}}}}


def said(verdict, *names, group=(), probability=0.9):
    causes = [{"effect": n, "probability": probability, "indistinguishable_from": list(group) if k == 0 else [],
               "parameters": {"p": {"value": 0.45, "interval_95": [0.4, 0.6]}}} for k, n in enumerate(names)]
    return judge.Answer({"verdict": verdict, "causes": causes})


class Scorer(unittest.TestCase):
    def value(self, cases, start):
        return next(r for r in scorecard.rates(cases) if r.name.startswith(start)).value

    def test_right_wrong_and_silent_answers(self):
        cases = [(label("single", "a"), said("explained", "a")), (label("single", "a"), said("explained", "b")),
                 (label("single", "a"), said("no_gap")), (label("single", "a", detectable=False), said("no_gap"))]
        self.assertAlmostEqual(self.value(cases, "top-1"), 1 / 3)
        self.assertAlmostEqual(self.value(cases, "wrong name"), 1 / 2)
        self.assertAlmostEqual(self.value(cases, "silent"), 1 / 3)

    def test_a_group_that_holds_the_truth_is_no_wrong_name_but_no_top_1(self):
        cases = [(label("single", "a"), said("ambiguous", "b", group=["a"]))]
        self.assertEqual(self.value(cases, "top-1"), 0)
        self.assertEqual(self.value(cases, "true effect inside"), 1)
        self.assertEqual(self.value(cases, "wrong name"), 0)

    def test_any_verdict_but_silence_is_an_alarm_on_null(self):
        cases = [(label("null"), said("explained", "a")), (label("null"), said("unexplained")), (label("null"), said("no_gap")),
                 (label("null"), said("too_little_data"))]
        self.assertEqual(self.value(cases, "false alarm"), 0.5)

    def test_a_diagnosis_that_failed_is_wrong_wherever_it_stands(self):
        failed = judge.Answer(None)
        self.assertEqual(self.value([(label("null"), failed)], "false alarm"), 1)
        self.assertEqual(self.value([(label("single", "a"), failed)], "top-1"), 0)
        self.assertEqual(self.value([(label("foreign", "f"), failed)], "foreign effect"), 0)
        self.assertEqual(self.value([(label("null"), failed), (label("null"), said("no_gap"))], "no answer"), 0.5)

    def test_a_label_with_a_side_is_the_effect(self):
        answer = said("explained", "b", group=["a (left)"])
        self.assertEqual(answer.group, {"a", "b"})
        self.assertEqual(judge.Answer({"verdict": "explained", "ranking": [{"effect": "a (right)", "probability": 1}]}).top(1), ["a"])

    def test_the_next_run_settles_a_group_only_if_it_leaves_the_truth_alone(self):
        first = said("ambiguous", "b", group=["a"])
        self.assertTrue(judge.settles(first, said("explained", "a"), ["a"]))
        self.assertTrue(judge.settles(first, said("explained", "c", "a"), ["a", "c"]))
        self.assertFalse(judge.settles(first, said("explained", "b"), ["a"]))
        self.assertFalse(judge.settles(first, said("ambiguous", "a", group=["b"]), ["a"]))
        results = {"x": {"diagnosis": first.raw, "next_runs": {"proposed": {"diagnosis": said("explained", "a").raw}, "random": {"error": "no"}}}}
        self.assertEqual([(r.hits, r.total) for r in scorecard.next_run_rates({"x": label("single", "a")}, results)], [(1, 1), (0, 1)])

    def test_the_interval_of_the_shrink_is_held_against_a_fresh_day(self):
        self.assertAlmostEqual(judge.true_shrink({"before_J": 100, "after_J": 10}), 0.9)
        self.assertIsNone(judge.true_shrink({"before_J": None, "after_J": 10}))
        self.assertIsNone(judge.true_shrink(None))
        answer = {**said("explained", "a").raw, "gap": {"energy": {"shrink_fraction": 0.8, "shrink_interval_95": [0.7, 0.85]}}}
        results = {"x": {"diagnosis": answer, "fresh_day": {"before_J": 100, "after_J": 10}},
                   "y": {"diagnosis": answer, "fresh_day": {"before_J": 100, "after_J": 25}}}
        coverage, difference = scorecard.shrink_values({}, results)
        self.assertEqual((coverage.value, coverage.count), (0.5, 2))
        self.assertAlmostEqual(difference.value, 0.075)

    def test_a_floor_cell_is_right_where_it_touches_the_patch(self):
        patch = {"parameters": {"x_min_m": 1.8, "x_max_m": 3.0, "y_min_m": -1, "y_max_m": 1}}
        self.assertTrue(judge.patch_overlaps("x 2 to 3 m, y 0 to 1 m", patch))
        self.assertTrue(judge.patch_overlaps("x 1 to 2 m, y -1 to 0 m", patch))
        self.assertFalse(judge.patch_overlaps("x 3 to 4 m, y 0 to 1 m", patch))
        self.assertIsNone(judge.patch_overlaps(None, patch))

    def test_pairs_foreign_and_removed(self):
        cases = [(label("pair", "a", "b"), said("explained", "b", "a")), (label("pair", "a", "b"), said("explained", "a")),
                 (label("foreign", "f"), said("unexplained")), (label("foreign", "f"), said("explained", "a")),
                 (label("removed", "a"), said("partly_explained", "c"))]
        self.assertEqual(self.value(cases, "pairs: both"), 0.5)
        self.assertEqual(self.value(cases, "pairs: at least one"), 1)
        self.assertEqual(self.value(cases, "foreign effect: says none fits"), 0.5)
        self.assertEqual(self.value(cases, "true effect removed"), 1)

    def test_parameter_error_and_interval(self):
        self.assertEqual([(e, round(x, 6), c) for e, x, c in judge.parameter_errors(said("explained", "a"), label("single", "a"))], [("a", 0.1, True)])

    def test_answers_that_are_equally_sure_are_one_point_of_risk_and_coverage(self):
        cases = [(label("single", "a"), said("explained", "b", probability=0.9)), (label("single", "a"), said("explained", "a", probability=0.9)),
                 (label("single", "a"), said("explained", "a", probability=0.5)), (label("single", "a"), said("no_gap"))]
        self.assertEqual(scorecard.risk_coverage(cases), [(0.5, 0.5), (0.75, 1 / 3)])

    def test_right_is_silence_on_null_and_none_fits_on_foreign(self):
        self.assertTrue(plots.is_right("(null)", "(no_gap)"))
        self.assertIn("svg", plots.power_plot({"a": {"points": [(0.0, True, True)]}}))  # an effect that takes something away: size 0
        self.assertTrue(plots.is_right("f (foreign)", "(unexplained)"))
        self.assertFalse(plots.is_right("f (foreign)", "a"))
        self.assertFalse(plots.is_right("a", "(unexplained)"))
        self.assertEqual(scorecard.confusion([(label("foreign", "f"), said("unexplained"))]), {"f (foreign)": {"(unexplained)": 1}})

    def test_statistics(self):
        low, high = wilson(8, 10)
        self.assertAlmostEqual(low, 0.4902, places=4)
        self.assertAlmostEqual(high, 0.9433, places=4)
        ece, brier, _ = calibration([(0.8, True)] * 8 + [(0.8, False)] * 2)
        self.assertAlmostEqual(ece, 0.0)
        self.assertAlmostEqual(brier, 0.16)
        self.assertEqual(smallest_found([(4, 1), (3, 1), (2, 1), (1, 0)]), 2)


class Campaign(unittest.TestCase):
    def test_a_line_that_was_cut_is_done_again(self):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "diagnosed.jsonl"
            self.assertEqual(campaign.done_cases(log), {})
            log.write_text('{"id": "case_0001"}\n{"id": "case_00')
            self.assertEqual(list(campaign.done_cases(log)), ["case_0001"])
            self.assertEqual(log.read_text(), '{"id": "case_0001"}\n')

    def test_a_motion_that_is_none_is_not_driven(self):
        self.assertIsNone(examine.described({}))
        self.assertEqual(examine.described({"profile": "stand", "duration_s": 10}), "profile:stand,duration_s:10,payload_kg:0")


class Sealing(unittest.TestCase):
    def test_a_changed_label_breaks_its_hash(self):
        first = label("single", "a")
        self.assertEqual(seal.commitment("s", first), seal.commitment("s", json.loads(json.dumps(first))))
        self.assertNotEqual(seal.commitment("s", first), seal.commitment("s", {**first, "level": 1}))
        self.assertNotEqual(seal.commitment("s", first), seal.commitment("t", first))

    def test_the_plan_follows_from_the_commit_and_its_prefixes_keep_the_proportions(self):
        names = [f"e{k}" for k in range(29)], [f"f{k}" for k in range(10)]
        full = plan.plan("commit", *names, plan.FULL)
        self.assertEqual(full, plan.plan("commit", *names, plan.FULL))
        self.assertNotEqual(full[0]["seed"], plan.plan("other", *names, plan.FULL)[0]["seed"])
        self.assertGreaterEqual(len(full), 2000)
        self.assertEqual(len({c["seed"] for c in full}), len(full))
        share = lambda cases: sum(c["bin"] == "null" for c in cases) / len(cases)
        self.assertGreaterEqual(share(full), 0.25)
        self.assertAlmostEqual(share(full[:280]), share(full), delta=0.02)
        self.assertEqual(len(plan.plan("commit", *names, plan.SHORT)), 60)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
