"""The best drives that the programs of joint_program.py find from many first drives, coarse to fine."""

import itertools
import math

from joint_guesses import guesses
from joint_program import Program, TimedProgram, drive_energy, remeshed, timed, timed_energy

ARC_PARTS, ARC_WIDTH = (
    36,
    0.1,
)  # of the coarse program over arc length; width of the sign of friction, of the speed
PARTS, WIDTH_M_S = 60, 0.03  # of the program over time for each basin
FINE_PARTS, FINE_WIDTH_M_S, FINE_BARRIER = 120, 0.003, 1e-3
SAME = 1e-4  # closer energies are one basin
WITHIN = 1.02  # of the best: basins above it are not refined
STOP_HEADINGS = 4  # of first drives of two legs


def as_end(goal, heading_rad):
    """The goal with the whole turns of a first drive."""
    return goal[0], goal[1], goal[2] + 2 * math.pi * round((heading_rad - goal[2]) / (2 * math.pi))


class Search:
    """The programs of one robot and the searches over first drives; counts solves and failures."""

    def __init__(self, robot, sharpest, legs=1):
        self.robot, self.sharpest, self.legs = robot, sharpest, legs
        self.arc = Program(robot, ARC_PARTS) if legs == 1 else None
        self.coarse, self.fine = TimedProgram(robot, PARTS, legs), TimedProgram(robot, FINE_PARTS, legs)
        self.arc_solves = self.arc_failed = self.solves = self.failed = 0

    def over_arc_length(self, first, poses):
        """A drive of the coarse program over arc length, or nothing."""
        (found,), _, good = self.arc.solve(
            [remeshed(first, ARC_PARTS, self.robot.half_track_m)], poses, ARC_WIDTH, tolerance=1e-5
        )
        self.arc_solves, self.arc_failed = self.arc_solves + 1, self.arc_failed + (not good)
        return found if good else None

    def over_time(self, drives, poses, fine=False, sharpest=None):
        """(energy in J, drives, poses) of the program over time, or nothing; `sharpest`: a bound of u."""
        program = self.fine if fine else self.coarse
        firsts = [drive.on(program.parts) for drive in drives]
        settings = (FINE_WIDTH_M_S, FINE_BARRIER) if fine else (WIDTH_M_S, 0.1)
        found, _, good = program.solve(
            firsts, poses, settings[0], sharpest or self.sharpest, first_barrier=settings[1]
        )
        self.solves, self.failed = self.solves + 1, self.failed + (not good)
        return (sum(timed_energy(self.robot, drive) for drive in found), found, poses) if good else None

    def best(self, rows):
        """The best of (energy, drives, poses), each basin once and refined; how many basins."""
        rows, basins = sorted(rows, key=lambda row: row[0]), []
        for row in rows:
            if not basins or row[0] > basins[-1][0] * (1 + SAME):
                basins.append(row)
        near = [row for row in basins if row[0] <= WITHIN * basins[0][0]]
        refined = [self.over_time(row[1], row[2], fine=True) or row for row in near]
        return min(refined, key=lambda row: row[0]), len(basins)

    def leg(self, start, goal):
        """Between two poses (m, m, rad): (energy in J, drives, poses), the least energy (J) over arc
        length, first drives and basins."""
        rows, by_arc, half_m = [], [], self.robot.half_track_m
        firsts = guesses(self.robot, start, goal)
        for first in firsts.values():
            poses = [start, as_end(goal, first.heading[-1])]
            found = self.over_arc_length(first, poses)
            if found:
                by_arc.append(drive_energy(self.robot, found.s, found.u, found.b)[0])
            rows += [row for row in [self.over_time([timed(found or first, half_m)], poses)] if row]
        best, basins = self.best(rows)
        return best, min(by_arc, default=math.nan), len(firsts), basins

    def again(self, best, sharpest):
        """Energy (J) of the best drive solved again with another bound of u, or NaN."""
        middle = self.over_time(best[1], best[2], sharpest=sharpest)
        fine = middle and self.over_time(middle[1], middle[2], fine=True, sharpest=sharpest)
        return (fine or middle or [math.nan])[0]

    def two_legs(self, start, stop, goal):
        """Through a stop (m, m) of free heading: the best (energy, drives, poses), first drives, basins."""
        rows, count = [], 0
        for k in range(STOP_HEADINGS):
            here = stop[0], stop[1], 0.3 + 2 * math.pi * k / STOP_HEADINGS
            for one in self.words(start, here):
                middle = as_end(here, one.heading[-1])
                for two in self.words(middle, goal):
                    poses = [start, middle, as_end(goal, two.heading[-1])]
                    drives = [timed(drive, self.robot.half_track_m) for drive in (one, two)]
                    rows += [row for row in [self.over_time(drives, poses)] if row]
                    count += 1
        best, basins = self.best(rows)
        return best, count, basins

    def words(self, start, goal):
        """Arc, line, arc with the four pairs of senses, of the smaller radius."""
        firsts = guesses(self.robot, start, goal)
        return [drive for name, drive in itertools.islice(firsts.items(), 4) if "S" in name]
