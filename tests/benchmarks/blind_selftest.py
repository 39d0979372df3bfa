"""Tests of the blind benchmark's data: the plant's physics against closed forms, its oracle and its controls.

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

import examine

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

    def observed(self, *arguments):
        label = self.folder / "label.json"
        subprocess.run([PLANT, "--seed", "3", "--label", str(label), "--observer", *arguments], check=True)
        return json.loads(label.read_text())["oracle"]

    def test_the_observer_does_not_separate_an_effect_from_its_twin(self):
        """At one payload rolling resistance is Coulomb friction; at several it is not."""
        rolling = ("--effect", "rolling_resistance", "--size", "0.002", "--protocol", "12")
        twin, clear = self.observed(*rolling, "--one-log"), self.observed(*rolling)
        self.assertTrue(twin["detectable"])
        self.assertFalse(twin["separable"])
        self.assertLess(twin["single_separation"], 0.05 * twin["likelihood_ratio"])
        self.assertTrue(clear["separable"])

    def test_the_observer_separates_a_clear_effect(self):
        clear = self.observed("--effect", "supply_sag", "--size", "0.3", "--protocol", "6")
        self.assertTrue(clear["separable"])
        self.assertGreater(clear["separation"], 1000)

    def test_more_noise_separates_no_better_and_nothing_beats_detection(self):
        before, ratios = float("inf"), []
        for noise in ("0.5", "1", "2", "4"):
            oracle = self.observed("--effect", "dragging_wheel", "--size", "0.06", "--level", "1", "--protocol", "12", "--noise", noise)
            if "separation" not in oracle:
                self.assertFalse(oracle["detectable"])
                continue
            self.assertLessEqual(oracle["separation"], 1.001 * before)
            self.assertLessEqual(oracle["separation"], oracle["likelihood_ratio"])
            self.assertLessEqual(oracle["separation"], oracle["single_separation"])
            before = oracle["separation"]
            ratios.append(before)
        self.assertGreater(len(ratios), 1)
        self.assertLess(ratios[-1], ratios[0])

    def test_a_member_of_a_pair_changes_what_it_would_change_alone(self):
        pair = self.observed("--effect", "standby_power_error,wheel_radius_mismatch", "--size", "2,0.02", "--protocol", "6")["each_change"]
        alone = self.observed("--effect", "wheel_radius_mismatch", "--size", "0.02", "--protocol", "6")
        self.assertAlmostEqual(pair["wheel_radius_mismatch"]["effect_pose_rms"] / alone["effect_pose_rms"], 1, delta=1e-3)
        self.assertLess(pair["standby_power_error"]["effect_pose_rms"], 1e-6)
        self.assertGreater(pair["standby_power_error"]["battery_percent"], 1)

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

    def test_every_robot_and_day_of_the_campaign_is_driven(self):
        program = str(pathlib.Path(PLANT).with_name("blind_mujoco"))
        with tempfile.TemporaryDirectory() as folder:
            for robot, more in (("tug", ["--day", "1"]), ("warehouse", ["--append", "profile:spin,angle_rad:4,payload_kg:0"]), ("small", [])):
                data = pathlib.Path(folder) / robot
                subprocess.run([program, "--effect", "none", "--robot", robot, "--protocol", "2", "--out", str(data), "--label", "none", *more], check=True)
                self.assertEqual(len(list(data.glob("run_*.csv"))), 3 if "--append" in more else 2)

    def test_what_mujoco_has_no_form_for_is_refused(self):
        program = str(pathlib.Path(PLANT).with_name("blind_mujoco"))
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([program, "--effect", "gear_efficiency", "--out", folder, "--protocol", "6"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("no form of this effect", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], verbosity=2)
