#!/usr/bin/env python3
"""Solvers that fail must end in a plan or a reason.

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

    def test_every_failure_of_nlopt_leaves_a_plan(self):
        good = os.path.join(SOURCE, "tests/data/broken/good")
        mission = {"robot": "robot.yaml", "map": os.path.join(good, "map.yaml"), "start": {"station": "a"}, "legs": [{"to": "b"}],
                   "stations": {"a": {"x_m": 0.5, "y_m": 0.5}, "b": {"x_m": 1.5, "y_m": 0.4, "heading_rad": 1}}}
        for status in (-5, -4, -2, -1):
            self.assertIn(self.plan(mission, NLOPT_FAULT=str(status))["status"], ("optimal", "feasible"))
        code, _, err = self.run_program("plan", "mission.yaml", "-q", "--force", "--out", "plan",
                                        env={**os.environ, "LD_PRELOAD": SOLVER_FAULTS, "NLOPT_FAULT": "-3"})
        self.assertEqual((code, "memory" in err), (ENVIRONMENT, True), err)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
