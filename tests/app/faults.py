#!/usr/bin/env python3
"""Kills, signals, full disks, second writers and closed outputs must cost nothing that was finished.

usage: faults.py PROGRAM SOURCE_DIR [TEST...]
"""
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

from with_scratch import BAD_INPUT, DONE, ENVIRONMENT, INTERRUPTED, ROBOT, SOURCE, WithScratch, content, tree

NOBODY = 65534


class Faults(WithScratch):
    def batch(self, out, *options):
        return ["batch", "m.jsonl", "--nodes", "30", "-j", "2", "-q", "--out", out, *options]

    def whole_batch(self):
        self.assertEqual(self.run_program(*self.batch("whole"))[0], DONE)
        return content(self.at("whole/results.jsonl"))

    def started_batch(self, out, lines, *options):
        """A running batch that has finished at least that many missions (or all of them)."""
        process = self.start(*self.batch(out, *options))
        journal, end = self.at(out, "results.partial.jsonl"), time.monotonic() + 120
        while process.poll() is None and time.monotonic() < end:
            if os.path.exists(journal) and content(journal).count(b'{"index"') >= lines:
                break
            time.sleep(0.002)
        return process

    def assert_resumes_to(self, out, whole):
        code, _, err = self.run_program(*self.batch(out, "--resume"))
        self.assertEqual(code, DONE, err)
        self.assertEqual(content(self.at(out, "results.jsonl")), whole)
        self.assertFalse(os.path.exists(self.at(out, "results.partial.jsonl")))

    def test_a_killed_batch_resumes_to_the_same_bytes(self):
        whole, killed = self.whole_batch(), 0
        for lines in (0, 1, 4, 9):
            out = "killed%d" % lines
            process = self.started_batch(out, lines)
            process.kill()
            process.communicate()
            if process.returncode != -signal.SIGKILL:
                continue
            killed += 1
            self.assertNotIn("results.jsonl", tree(self.at(out)) if os.path.isdir(self.at(out)) else {})
            self.assert_resumes_to(out, whole)
        self.assertGreaterEqual(killed, 2)

    def test_a_batch_killed_twice_resumes_to_the_same_bytes(self):
        whole = self.whole_batch()
        for lines, options in ((3, ()), (7, ("--resume",))):
            process = self.started_batch("out", lines, *options)
            process.kill()
            process.communicate()
        self.assert_resumes_to("out", whole)

    def test_an_interrupted_batch_says_so_and_resumes(self):
        whole = self.whole_batch()
        for name in ("SIGINT", "SIGTERM"):
            process = self.started_batch(name, 2)
            process.send_signal(getattr(signal, name))
            _, err = process.communicate()
            self.assertEqual(process.returncode, INTERRUPTED, err)
            self.assertIn(b"--resume", err)
            self.assert_resumes_to(name, whole)

    def test_resume_plans_again_what_a_changed_robot_changes(self):
        process = self.started_batch("out", 5)
        process.kill()
        process.communicate()
        robot = content(self.at("robot.yaml")).decode()
        changed = robot.replace("chassis_mass_kg: 21.2", "chassis_mass_kg: 42.4")
        self.assertNotEqual(changed, robot)
        with open(self.at("robot.yaml"), "w") as file:
            file.write(changed)
        self.assert_resumes_to("out", self.whole_batch())

    def test_resume_refuses_the_unfinished_batch_of_other_missions(self):
        process = self.started_batch("out", 4)
        process.kill()
        process.communicate()
        journal = content(self.at("out/results.partial.jsonl"))
        lines = content(self.at("m.jsonl")).decode().splitlines()
        with open(self.at("other.jsonl"), "w") as file:  # the first missions are the same
            file.write("\n".join(lines[:2] + [line.replace("1.05", "1.5") for line in lines[3:]]) + "\n")
        for options, words in ((("--resume",), ("other.jsonl", "m.jsonl", "--force")), ((), ("m.jsonl", "--resume"))):
            code, _, err = self.run_program("batch", "other.jsonl", "--nodes", "30", "-q", "--out", "out", *options)
            self.assertEqual(code, BAD_INPUT, err)
            for word in words:
                self.assertIn(word, err)
            self.assertEqual(content(self.at("out/results.partial.jsonl")), journal)
        self.assert_resumes_to("out", self.whole_batch())

    def test_resume_continues_a_list_in_which_one_mission_was_corrected(self):
        process = self.started_batch("out", 4)
        process.kill()
        process.communicate()
        missions = content(self.at("m.jsonl")).decode()
        with open(self.at("m.jsonl"), "w") as file:
            file.write(missions.replace('"m3"', '"corrected"'))
        self.assert_resumes_to("out", self.whole_batch())

    def test_a_killed_or_interrupted_plan_leaves_no_half_result(self):
        mission = os.path.join(SOURCE, "tests/data/broken/good/mission.yaml")
        for number, delay_s in ((signal.SIGKILL, 0.05), (signal.SIGTERM, 0.1), (signal.SIGINT, 0.2)):
            process = self.start("plan", mission, "--out", "plan", "-q", "--force")
            time.sleep(delay_s)
            process.send_signal(number)
            process.communicate()
            if process.returncode in (DONE, 1):
                continue
            self.assertIn(process.returncode, (-number, INTERRUPTED))
            self.assertFalse(os.path.exists(self.at("plan")) and tree(self.at("plan")))

    def full_disk(self, out, *options):
        """Every write beyond a file size fails, as on a full disk. SIGXFSZ has its default action, as in a shell."""
        codes = set()
        for size in (0, 100, 3000, 20000):
            code, _, err = self.run_program(
                *self.batch(out + str(size), *options),
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
            codes.add(code)
            if code == DONE:
                continue
            self.assertEqual(code, ENVIRONMENT, err)
            self.assertIn(out + str(size), err)
            files = tree(self.at(out + str(size)), ())
            self.assertLessEqual(set(files), {"results.partial.jsonl"}, files.keys())
            self.assert_resumes_to(out + str(size), content(self.at("whole/results.jsonl")))
        self.assertIn(ENVIRONMENT, codes)

    def test_a_full_disk_ends_a_batch_that_resumes(self):
        self.whole_batch()
        self.full_disk("full")

    def test_a_full_file_system_keeps_the_earlier_plan(self):
        small = self.at("small")
        os.mkdir(small)
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", small], capture_output=True)
        if mounted.returncode != 0:
            self.skipTest("mount is not permitted")
        self.addCleanup(subprocess.run, ["umount", small])
        os.mkdir(os.path.join(small, "plan"))
        with open(os.path.join(small, "plan/plan.json"), "w") as file:
            file.write("{}")
        path = os.path.join(SOURCE, "tests/data/broken/good/waypoints.csv")
        code, _, err = self.run_program("plan", path, "--robot", "robot.yaml", "-q", "--force", "--out",
                                        os.path.join(small, "plan"))
        self.assertEqual(code, ENVIRONMENT, err)
        self.assertEqual(tree(os.path.join(small, "plan"), ()), {"plan.json": b"{}"})

    def test_the_second_writer_of_one_output_is_refused(self):
        whole = self.whole_batch()
        first = self.started_batch("out", 1)
        first.send_signal(signal.SIGSTOP)
        for option, codes in (("--resume", {ENVIRONMENT}), ("--force", {ENVIRONMENT}), ("-q", {BAD_INPUT})):
            code, _, err = self.run_program(*self.batch("out", option))
            self.assertIn(code, codes, option + ": " + err)
        first.send_signal(signal.SIGCONT)
        self.assertEqual(first.wait(timeout=300), DONE)
        first.communicate()
        self.assertEqual(content(self.at("out/results.jsonl")), whole)

    def test_an_output_that_nobody_takes_is_an_error(self):
        with open("/dev/full", "w") as full:
            for arguments in (["--help"], ["plan", "--help"], ["--version"], ["effects"], ["schema", "robot"]):
                code, _, err = self.run_program(*arguments, stdout=full)
                self.assertEqual(code, ENVIRONMENT, arguments)
                self.assertIn("standard output", err)
        closed = {"stdout": None, "preexec_fn": lambda: os.close(1)}
        for arguments in (["effects"], ["check", "robot.yaml"]):
            code, _, err = self.run_program(*arguments, **closed)
            self.assertEqual(code, ENVIRONMENT, arguments)
        self.assertEqual(self.run_program(*self.batch("quiet"), **closed)[0], DONE)
        code, _, err = self.run_program("batch", "m.jsonl", "--nodes", "30", "--out", "told", **closed)
        self.assertEqual(code, ENVIRONMENT)
        self.assertEqual(content(self.at("told/results.jsonl")), content(self.at("quiet/results.jsonl")))

    def test_a_reader_that_leaves_early_is_no_crash(self):
        reading, writing = os.pipe()
        os.close(reading)
        code, _, err = self.run_program("schema", "robot", stdout=writing)
        os.close(writing)
        self.assertIn(code, (ENVIRONMENT, -signal.SIGPIPE), err)

    def test_results_do_not_depend_on_locale_time_zone_or_jobs(self):
        found = subprocess.run(["locale", "-a"], capture_output=True, text=True).stdout.split()
        settings = [{"LC_ALL": name, "TZ": zone, "JOBS": jobs} for name, zone, jobs in zip(
            (["C"] + [name for name in found if not name.startswith("C")] + ["C.UTF-8", "POSIX"])[:4],
            ("UTC", "Asia/Kathmandu", "America/St_Johns", ":/no/such"), ("1", "2", "3", "7"))]
        trees = []
        for setting in settings:
            out = "out" + setting["JOBS"]
            code, _, err = self.run_program("batch", "m.jsonl", "--nodes", "30", "-q", "-j", setting["JOBS"], "--out",
                                            out, env={**os.environ, **setting})
            self.assertEqual(code, DONE, err)
            trees.append(tree(self.at(out)))
        for other in trees[1:]:
            self.assertEqual(other.keys(), trees[0].keys())
            for name in other:
                self.assertTrue(other[name] == trees[0][name], name)

    def as_other_user(self):
        """Options of a process without the rights of root; no file of the scratch folder is its own."""
        return {"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.geteuid() == 0 else {}

    def test_without_a_second_thread_the_results_are_the_same(self):
        whole, one = self.whole_batch(), {
            "preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_NPROC, (1, 1)), **self.as_other_user()}
        try:
            code, _, err = self.run_program(*self.batch("one"), **one)
        except PermissionError:
            self.skipTest("the program's folder is closed to other users")
        self.assertEqual(code, DONE, err)
        self.assertEqual(content(self.at("one/results.jsonl")), whole)
        dataset = os.path.join(SOURCE, "tests/data/broken/good/dataset.yaml")
        code, _, err = self.run_program("diagnose", dataset, "-q", "--out", "diagnosis", **one)
        self.assertGreaterEqual(code, DONE, err)

    def test_too_little_memory_is_a_message_and_costs_no_other_result(self):
        whole = self.whole_batch().splitlines()
        for megabytes in (45, 46, 47, 60, 75, 100):
            limit = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))}
            if self.run_program("--version", **limit)[0] != DONE:  # no room for the libraries before main()
                continue
            code, _, err = self.run_program(*self.batch("memory%d" % megabytes), **limit)
            self.assertIn(code, (DONE, ENVIRONMENT), err)
            if code == ENVIRONMENT:
                self.assertNotEqual(err, "")
                continue
            for line, right in zip(content(self.at("memory%d/results.jsonl" % megabytes)).splitlines(), whole):
                if line != right:
                    self.assertEqual(json.loads(line)["status"], "environment_error", line)

    def test_a_robot_that_may_not_be_read_costs_its_own_mission_alone(self):
        os.mkdir(self.at("batch"))
        for k, robot in enumerate(("robot", "locked", "robot")):
            with open(self.at("batch/m%d.yaml" % k), "w") as file:
                file.write("robot: ../%s.yaml\nlegs:\n  - path: {bezier_m: [[[0,0],[1,0],[2,0],[%d,0]]]}\n" % (robot, k + 3))
        shutil.copy(ROBOT, self.at("locked.yaml"))
        os.chmod(self.at("locked.yaml"), 0)
        try:
            code, _, err = self.run_program("batch", "batch", "--nodes", "30", "-j", "2", "-q", "--out", "out", **self.as_other_user())
        except PermissionError:
            self.skipTest("the program's folder is closed to other users")
        self.assertEqual(code, 1, err)
        lines = [json.loads(line) for line in content(self.at("out/results.jsonl")).splitlines()]
        self.assertTrue(all("energy_J" in lines[k] for k in (0, 2)), lines)
        self.assertNotIn("energy_J", lines[1])
        self.assertIn("Permission denied", lines[1]["message"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
