"""Tests of the field generator's physics, each against a law that it does not use itself. Needs numpy.

usage: python3 blind_field_test.py FOLDER_OF_BLIND_FIELD"""
import hashlib
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    print("numpy is missing: skipped")
    sys.exit(77)

FIELD = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(FIELD))

import causes
import days
import machines
from physics import RECORD_STEPS, STEP_s, Batch

RECORD_s = RECORD_STEPS * STEP_s


def machine(name="porter", **changes):
    """A machine that is as its file says, equal on both sides, with changed constants."""
    file = machines.nominal(name)
    file["T"] = [file["T"][0]] * 2
    return {**file, **causes.ABSENT, "file": file, **changes}


def run(*legs, load=0.0, **more):
    return dict(command=days.joined(*legs), load=load, pose=(0, 0, 0), start_s=0.0, **more)


def driven(m, *runs):
    batch = Batch([m], list(runs))
    return batch, batch.drive()


def plain_balance(m, record):
    """Motors' energy of each run that a robot file explains, J: copper by the measured currents, friction by the wheels' turns.

    A run begins and ends at rest, so that no kinetic energy is left."""
    speed, current = np.diff(record["q"], axis=0) / RECORD_s, np.diff(record["i"], axis=0) / RECORD_s
    side = lambda key: np.array(m[key])[:, None]
    power = side("R") * current**2 + side("T") * np.abs(speed) + side("nu") * speed**2
    return power.sum(axis=(0, 1)) * RECORD_s


class Physics(unittest.TestCase):
    def test_energy_is_accounted_for(self):
        batch, _ = driven(machine(loss=0.1, scrub=0.0), run(days.straight(3, 1.0, 0.5), days.spin(6, 0.8, 1.0), load=20))
        a = {key: value[0] for key, value in batch.account.items()}
        rest = a["electrical"] - a["copper"] - a["friction"] - a["tyre"] - a["gear"] - batch.kinetic_J()[0]
        self.assertLess(abs(rest), 1e-3 * a["electrical"])

    def test_a_robot_without_a_command_stands(self):
        """Exactly on the level; within the tyres' give on a slope that friction holds."""
        for grade, give in ((0.0, 0.0), (0.01, 1e-3)):
            _, record = driven(machine(grade=grade), run(days.stand(3)))
            self.assertEqual(record["i"][-1].tolist(), [[0.0], [0.0]])
            self.assertLessEqual(np.abs(record["pose"][-1] - record["pose"][0]).max(), give)

    def test_a_mirrored_command_gives_a_mirrored_run(self):
        left, right = run(days.arc(3, 1.2, 0.8, 0.5)), run(days.arc(-3, 1.2, 0.8, 0.5))
        _, record = driven(machine(), left, right)
        np.testing.assert_allclose(record["q"][:, 0, 0], record["q"][:, 1, 1], atol=1e-4)
        np.testing.assert_allclose(record["pose"][:, 1, 0], -record["pose"][:, 1, 1], atol=1e-4)
        np.testing.assert_allclose(record["E"][-1, 0, 0], record["E"][-1, 1, 1], rtol=1e-3)

    def test_a_null_is_what_a_robot_file_can_state(self):
        """Backlash, tyres, current loop and encoder cost less than 0.5 % of the energy, on every kind of day."""
        for name in machines.ROBOTS:
            m, rng = machine(name), np.random.default_rng(4)
            runs = [run for kind in days.KINDS for run in days.day(f"{kind}:3", m["file"], rng)]
            _, record = driven(m, *runs)
            both = record["E"][-1].sum(axis=0), plain_balance(m, record)
            measured, stated = (energy.reshape(len(days.KINDS), 3).sum(axis=1) for energy in both)
            for kind, unmodelled in zip(days.KINDS, measured / stated - 1):
                print(f"{name} {kind}: {100 * unmodelled:+.2f} % unmodelled")
                with self.subTest(robot=name, day=kind):
                    self.assertLess(abs(unmodelled), 0.005)

    def test_rolling_resistance_costs_its_force_times_the_distance(self):
        """And copper loss in proportion; shafts lose what the law says, at two sizes."""
        line = run(days.straight(6, 0.8, 0.4))
        lost = []
        for coefficient in (0.0, 0.004, 0.008):
            batch, _ = driven(machine(roll=coefficient), line)
            lost.append(batch.account["friction"][0])
        weight = machines.mass(machine()) * machines.GRAVITY_m_s2
        self.assertAlmostEqual((lost[1] - lost[0]) / (0.004 * weight * 6), 1, delta=0.01)
        self.assertAlmostEqual((lost[2] - lost[0]) / (lost[1] - lost[0]), 2, delta=0.01)

    def test_winding_resistance_costs_copper_alone(self):
        base, more = (driven(machine(R=[r, r]), run(days.straight(6, 0.8, 0.4)))[0] for r in (1.2, 1.8))
        self.assertAlmostEqual(more.account["copper"][0] / base.account["copper"][0], 1.5, delta=0.005)
        self.assertAlmostEqual(more.account["friction"][0] / base.account["friction"][0], 1, delta=1e-3)

    def test_the_payload_is_carried_and_turned(self):
        """Kinetic energy of a loaded robot, at its cruise."""
        batch = Batch([machine()], [run(days.straight(20, 1.0, 0.5), load=30.0)])
        for k in range(6000):
            if k % 4 == 0:
                batch.slow(k // 4)
            batch.step()
        m = machine()
        rotating = m["I_a"] * (1 / m["r"][0]) ** 2 * 2
        self.assertAlmostEqual(batch.kinetic_J()[0], 0.5 * (machines.mass(m, 30.0) + rotating), delta=0.4)


class Files(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def generated(self, name, *arguments):
        subprocess.run([sys.executable, "-B", str(FIELD / "blind_field"), "--out", str(self.folder / name), "--protocol", "shuttle:2",
                        *arguments], check=True)
        return {path.name: path.read_bytes() for path in (self.folder / name).iterdir()}

    def test_same_seed_same_bytes_other_seed_other_bytes(self):
        digest = lambda files: hashlib.sha256(b"".join(files[name] for name in sorted(files))).hexdigest()
        day = lambda name, seed: digest(self.generated(name, "--seed", seed, "--level", "1"))
        first, again, other = day("a", "5"), day("b", "5"), day("c", "6")
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)

    def test_a_cause_is_in_the_label_alone(self):
        null = self.generated("null", "--seed", "5")
        case = self.generated("case", "--seed", "5", "--effect", "rolling_resistance", "--size", "0.01")
        self.assertIn(b"effect: rolling_resistance, coefficient: 0.01", case["truth.yaml"])
        self.assertEqual(null["robot.yaml"], case["robot.yaml"])
        self.assertEqual(null["dataset.yaml"], case["dataset.yaml"])
        self.assertNotEqual(null["run_01.csv"], case["run_01.csv"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
