"""Tests of the blind benchmark's rules: the scorer's verdicts, its statistics, campaigns and sealing.

usage: python3 blind_scorer_selftest.py"""
import json
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "benchmarks" / "blind" / "harness"))

import again
import campaign
import examine
import judge
import plan
import plots
import scorecard
import seal
from statistics_of import calibration, smallest_found, wilson


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
        self.assertAlmostEqual(self.value(cases, "top-1, single detectable effect"), 1 / 3)
        self.assertAlmostEqual(self.value(cases, "wrong name"), 1 / 2)
        self.assertAlmostEqual(self.value(cases, "silent"), 1 / 3)

    def test_a_group_that_holds_the_truth_is_no_wrong_name_but_no_top_1(self):
        cases = [(label("single", "a"), said("ambiguous", "b", group=["a"]))]
        self.assertEqual(self.value(cases, "top-1, single detectable effect"), 0)
        self.assertEqual(self.value(cases, "true effect inside"), 1)
        self.assertEqual(self.value(cases, "wrong name"), 0)

    def test_any_verdict_but_silence_is_an_alarm_on_null(self):
        cases = [(label("null"), said("explained", "a")), (label("null"), said("unexplained")), (label("null"), said("no_gap")),
                 (label("null"), said("too_little_data"))]
        self.assertEqual(self.value(cases, "false alarm"), 0.5)

    def test_a_diagnosis_that_failed_is_wrong_wherever_it_stands(self):
        failed = judge.Answer(None)
        self.assertEqual(self.value([(label("null"), failed)], "false alarm"), 1)
        self.assertEqual(self.value([(label("single", "a"), failed)], "top-1, single detectable effect"), 0)
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
        answer = {**said("explained", "a").raw, "gap": {"energy": {"shrink_fraction": 0.8, "shrink_interval_95": [0.7, 0.85], "before_percent": 10}}}
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

    def test_what_the_observer_tells_apart_is_to_be_named_or_listed(self):
        day = lambda separable: {**label("single", "a"), "oracle": {"detectable": True, "separable": separable}}
        small = judge.Answer({"verdict": "no_gap", "below_materiality": [{"effect": "a"}]})
        cases = [(day(True), said("explained", "a")), (day(True), small), (day(True), said("no_gap")), (day(False), said("no_gap")),
                 (label("single", "a"), said("no_gap"))]  # the last: nobody asked the observer
        self.assertAlmostEqual(self.value(cases, "top-1 or below_materiality, single separable"), 2 / 3)
        self.assertAlmostEqual(self.value(cases, "the same by the observer"), 3 / 4)

    def test_a_pair_with_a_small_member_is_no_pair_of_material_effects(self):
        def day(small):
            changes = {"a": {"effect_percent": 5}, "b": {"effect_percent": small, "effect_pose_rms": 0.001}}
            return {**label("pair", "a", "b"), "oracle": {"detectable": True, "effect_percent": 5, "each_change": changes}}
        listed = judge.Answer({"verdict": "explained", "causes": said("explained", "a").causes, "below_materiality": [{"effect": "b"}]})
        cases = [(day(0.3), said("explained", "a")), (day(0.3), listed), (day(3), said("explained", "a", "b")), (day(3), said("explained", "a"))]
        self.assertEqual(self.value(cases, "pairs: both, each detectable"), 1 / 2)
        self.assertEqual(self.value(cases, "pairs: both named or listed"), 1 / 2)
        self.assertEqual(self.value(cases, "pairs: both, detectable and material"), 1 / 4)

    def test_a_spoilt_channel_is_named_by_its_kind_its_column_and_its_scope(self):
        day = {**label("spoilt", "a"), "spoil": {"way": "currents inverted", "all_runs": True}}
        suspect = lambda **check: judge.Answer({"verdict": "data_suspect", "data_checks": [{"kind": "inverted", "channel": "motor_current_left_A", "run": "all", **check}]})
        self.assertTrue(judge.names_spoilt_channel(suspect(), day))
        for wrong in ({"kind": "dead"}, {"channel": "motor_voltage_left_V"}, {"run": "run_01.csv"}):
            self.assertFalse(judge.names_spoilt_channel(suspect(**wrong), day))
        self.assertFalse(judge.invents_a_cause(suspect(), day))
        self.assertTrue(judge.invents_a_cause(said("explained", "b"), day))
        self.assertFalse(judge.invents_a_cause(said("explained", "a"), day))
        self.assertEqual(self.value([(label("null"), suspect()), (label("null"), said("no_gap"))], "sound day called"), 0.5)

    def test_an_explained_correction_is_quiet_when_it_is_diagnosed_again(self):
        day = lambda verdict, again: {"diagnosis": {"verdict": verdict},
                                      "fresh_day": {"again": {"verdict": again, "causes": [{"effect": "coulomb_friction"}]}}}
        results = {"x": day("explained", "no_gap"), "y": day("explained", "explained"), "z": day("partly_explained", "no_gap"),
                   "u": {"diagnosis": {"verdict": "no_gap"}, "fresh_day": None}}
        whole, every, named = scorecard.again_rates(results)
        self.assertEqual((whole.hits, whole.total, every.hits, every.total), (1, 2, 2, 3))
        self.assertEqual((named.hits, named.total), (1, 2))

    def test_a_correction_is_judged_on_a_fresh_day_and_may_lose_a_fifth_of_a_percent(self):
        day = lambda after: {"before_percent": 5.0, "after_percent": after}
        self.assertEqual([judge.correction_is_worse(d) for d in (day(1.0), day(5.1), day(5.3), None)], [False, False, True, None])
        results = {"x": {"fresh_day": day(5.3), "corrected": True}, "y": {"fresh_day": None, "corrected": False}}
        labels = {key: {**label("single", "a"), "oracle": {"detectable": True, "effect_percent": 3}} for key in results}
        self.assertEqual([(r.hits, r.total) for r in scorecard.correction_rates(labels, results)], [(1, 1), (1, 2)])

    def test_a_gap_in_the_battery_alone_has_to_be_seen_where_it_is_large(self):
        day = lambda percent: {**label("battery", "a"), "oracle": {"detectable": True, "battery_percent": percent}}
        cases = [(day(8), said("unexplained")), (day(8), said("no_gap")), (day(1), said("no_gap"))]
        self.assertEqual(self.value(cases, "odometry and battery alone: a gap"), 0.5)

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

    def test_cases_of_other_logs_are_not_asked_again(self):
        hashes = again.published()[2]
        first = min(hashes)
        again.refuse_other_logs({first: {"data_sha256": hashes[first] + "0" * 48}}, hashes)
        with self.assertRaises(SystemExit):
            again.refuse_other_logs({first: {"data_sha256": "0" * 64}}, hashes)

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
        for bin_name, least in (("null", 300), ("pair", 300), ("triple", 50), ("foreign", 200), ("removed", 200), ("spoilt", 150), ("battery", 100), ("long", 50)):
            self.assertGreaterEqual(sum(c["bin"] == bin_name for c in full), least)
        self.assertAlmostEqual(share(full[:280]), share(full), delta=0.02)
        self.assertEqual(len(plan.plan("commit", *names, plan.SHORT)), 60)

    def test_mujoco_drives_cases_of_its_own(self):
        cases = plan.campaign("mujoco", "commit")
        self.assertEqual({(c["level"], c["physics"]) for c in cases}, {(0, "blind_mujoco")})
        self.assertEqual({tuple(c["effects"]) for c in cases}, {()} | {(name,) for name in plan.MUJOCO_EFFECTS})
        with unittest.mock.patch.object(seal.workspace, "program", lambda name: name), unittest.mock.patch.object(examine.subprocess, "run") as run:
            examine.Examination(cases[0], pathlib.Path("scratch")).generate("data")
        self.assertEqual(run.call_args.args[0][0], "blind_mujoco")
        self.assertFalse({c["seed"] for c in cases} & {c["seed"] for c in plan.plan("commit", plan.MUJOCO_EFFECTS, (), plan.MUJOCO)})


if __name__ == "__main__":
    unittest.main()
