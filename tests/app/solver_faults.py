#!/usr/bin/env python3
"""Solvers and allocations that fail must end in a plan or a reason.

usage: SOLVER_FAULTS=LIBRARY solver_faults.py PROGRAM SOURCE_DIR [TEST...]
"""
import json
import os
import sys
import unittest

from with_scratch import ENVIRONMENT, SOURCE, WithScratch, content

SOLVER_FAULTS = os.environ["SOLVER_FAULTS"]


class SolverFaults(WithScratch):
    """Solvers that return every failure they know (a preloaded library answers for them)."""

    def plan(self, mission, **environment):
        with open(self.at("mission.yaml"), "w") as file:
            json.dump(mission, file)
        code, _, err = self.run_program("plan", "mission.yaml", "--without", "baselines", "--nodes", "30", "-q", "--force", "--out",
                                        "plan", env={**os.environ, "LD_PRELOAD": SOLVER_FAULTS, **environment})
        self.assertIn(code, (0, 1), "%s: %s" % (environment, err))
        plan = json.loads(content(self.at("plan/plan.json")))
        if code == 1:
            self.assertTrue(plan.get("message") or plan["infeasibility"]["message"], plan)
            self.assertNotEqual(err, "")
        return plan

    def test_every_failure_of_ipopt_ends_in_a_plan_or_a_reason(self):
        robot = content(self.at("robot.yaml")).decode()
        with open(self.at("jerky.yaml"), "w") as file:
            file.write(robot.replace("limits:\n", "limits:\n  jerk_m_s3: 2\n"))
        curve = {"path": {"bezier_m": [[[0, 0], [1, 0], [1, 1], [2, 1]]]}}
        for status in (-199, -102, -101, -100, -13, -12, -11, -10, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5, 6):
            for robot in ("robot.yaml", "jerky.yaml") if status in (-1, 0, 2) else ("robot.yaml",):
                self.plan({"robot": robot, "legs": [curve]}, IPOPT_FAULT=str(status))

    def test_every_failure_of_nlopt_leaves_a_calibration(self):
        dataset = os.path.join(SOURCE, "tests/data/practice/p01_null/dataset.yaml")
        for status in (-5, -4, -3, -2, -1):
            code, _, err = self.run_program("calibrate", dataset, "-q", "--force", "--out", self.at("calibrated.yaml"),
                                            env={**os.environ, "LD_PRELOAD": SOLVER_FAULTS, "NLOPT_FAULT": str(status)})
            self.assertEqual(code, 0, "status %d: %s" % (status, err))
            code, _, err = self.run_program("check", self.at("calibrated.yaml"))
            self.assertEqual(code, 0, "status %d: %s" % (status, err))

    def write_hall(self):
        """A hall of 4 m x 3 m; a wall with a door of 1 m stands between the stations."""
        width, height = 80, 60
        rows = bytearray(b"\xfe" * (width * height))
        for y in range(height):
            for x in range(width):
                border = x in (0, width - 1) or y in (0, height - 1)
                if border or (38 <= x < 42 and not 2 <= y < 22):
                    rows[y * width + x] = 0
        with open(self.at("hall.pgm"), "wb") as file:
            file.write(b"P5 %d %d 255\n" % (width, height) + rows)
        with open(self.at("hall.yaml"), "w") as file:
            file.write("image: hall.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n")
        return {"robot": "robot.yaml", "map": "hall.yaml", "start": {"station": "a"}, "legs": [{"to": "b"}],
                "stations": {"a": {"x_m": 0.8, "y_m": 0.8}, "b": {"x_m": 3.2, "y_m": 0.8}}}

    def test_a_search_of_ompl_without_a_solution_leaves_the_ways_of_the_lattice(self):
        mission = self.write_hall()
        self.assertIn(self.plan(mission)["status"], ("optimal", "feasible"))
        for status in (0, 1, 4, 5, 6, 7):  # unknown, no start, out of time, approximate, exact, crash
            code, _, err = self.run_program("plan", "mission.yaml", "--without", "baselines", "--nodes", "30", "-q", "--force", "--out",
                                            "plan", env={**os.environ, "LD_PRELOAD": SOLVER_FAULTS, "OMPL_FAULT": str(status)})
            self.assertEqual((code, "OMPL found nothing" in err), (0, True), "status %d: %s" % (status, err))

    def batch(self, **environment):
        """Exit code, lines of results by name, and the standard error."""
        code, _, err = self.run_program("batch", "mixed.jsonl", "-j", "1", "-q", "--force", "--no-cache", "--nodes", "20", "--out", "results",
                                        env={**os.environ, "LD_PRELOAD": SOLVER_FAULTS, **environment})
        file = self.at("results/results.jsonl")
        lines = content(file).decode().splitlines() if code in (0, 1) else []
        return code, {line["name"]: line for line in map(json.loads, lines)}, err

    def write_mixed(self):
        curve = {"path": {"bezier_m": [[[0, 0], [1, 0], [1, 1], [2, 1]]]}}
        missions = {"before": {"robot": "robot.yaml", "legs": [curve]}, "hall": self.write_hall(), "after": {"robot": "robot.yaml", "legs": [curve, curve]}}
        with open(self.at("mixed.jsonl"), "w") as file:
            for name, mission in missions.items():
                file.write(json.dumps({"name": name, **mission}) + "\n")

    def test_one_failed_allocation_changes_one_line_or_ends_with_a_message(self):
        self.write_mixed()
        code, good, err = self.batch(ALLOCATION_COUNT="1")
        count = int(err.split("allocations: ")[1].split()[0])
        self.assertEqual(code, 0, err)
        self.assertGreater(count, 1000)
        in_missions = 0
        for fault in [10 ** k for k in range(2, 5)] + [count * part // 12 for part in range(1, 12)]:
            code, lines, err = self.batch(ALLOCATION_FAULT=str(fault))
            self.assertIn(code, (0, 1, ENVIRONMENT), "allocation %d of %d: %s" % (fault, count, err))
            if code == ENVIRONMENT:
                self.assertIn("not enough memory", err)
                continue
            failed = [name for name in good if lines[name]["status"] == "environment_error"]
            self.assertLessEqual(len(failed), 1, lines)
            self.assertEqual(code, len(failed), err)
            in_missions += len(failed)
            for name in good:
                if name not in failed:
                    self.assertEqual(lines[name], good[name])
                else:
                    self.assertEqual(lines[name]["message"], "not enough memory")
        self.assertGreater(in_missions, 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
