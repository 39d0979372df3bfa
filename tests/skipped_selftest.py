"""The summary of skipped tests: each is counted once, with the reason that it printed."""
import unittest

from skipped import UNSTATED, reason, summary

GTEST = """[ RUN      ] A.Skips
/a/b.cpp:3: Skipped
{}
[  SKIPPED ] A.Skips (0 ms)
[----------] 1 test from A (0 ms total)
"""


def case(name, status, output):
    return f'<testcase name="{name}" status="{status}">{status}<system-out>{output}</system-out></testcase>'.replace(
        ">notrun<", '><skipped message="SKIP_RETURN_CODE=77"/><').replace(">run<", "><")


class Skipped(unittest.TestCase):
    def test_the_reason_is_what_the_test_printed(self):
        self.assertEqual(reason(GTEST.format("no plant here\n")), "no plant here")
        self.assertEqual(reason(GTEST.format("")), UNSTATED)
        self.assertEqual(reason("starting\nskipped: jq is not installed\n"), "jq is not installed")
        self.assertEqual(reason(""), UNSTATED)

    def test_equal_reasons_are_counted_together_and_passed_tests_are_not(self):
        lines = list(summary("<testsuite>" + case("A.Skips", "notrun", GTEST.format("no plant")) + case("A.Runs", "run", "") +
                             case("B.Skips", "notrun", GTEST.format("no plant")) + case("c", "notrun", "skipped: no jq") + "</testsuite>"))
        self.assertEqual(lines, ["3 of 4 tests were skipped", "     2 no plant: A.Skips, ...", "     1 no jq: c"])

    def test_cases_that_unittest_skipped_are_told(self):
        output = "test_full (faults.Disk) ... skipped 'mount is not permitted'\ntest_ok (faults.Disk) ... ok\n\nOK (skipped=1)\n"
        lines = list(summary("<testsuite>" + case("app.faults", "run", output) + "</testsuite>"))
        self.assertEqual(lines, ["0 of 1 tests were skipped, and 1 inside of others",
                                 "     1 mount is not permitted: a case of app.faults"])

    def test_a_run_without_skipped_tests_says_so(self):
        self.assertEqual(list(summary("<testsuite>" + case("A.Runs", "run", "") + "</testsuite>")), ["0 of 1 tests were skipped"])


if __name__ == "__main__":
    unittest.main()
