"""The best drive that the nonlinear program of joint_program.py finds from many first drives, coarse to fine."""
import itertools
import math

from joint_guesses import guesses
from joint_program import Program, drive_energy, remeshed

COARSE, MIDDLE, FINE = (36, 0.1, 1e-5), (72, 0.03, 1e-6), (120, 0.01, 1e-6)  # parts, width of the sign, tolerance
REFINED, ALIKE = 3, 2e-3  # drives that go on to the middle mesh; closer energies with like lengths are one drive
WITHIN = 1.02  # of the best coarse energy: drives above it are dropped
STOP_HEADINGS = 6  # of a free heading at a stop, of first drives


def as_end(goal, heading_rad):
    """The goal with the whole turns of a first drive."""
    return goal[0], goal[1], goal[2] + 2 * math.pi * round((heading_rad - goal[2]) / (2 * math.pi))


class Search:
    """Programs of one robot on three meshes, and the search over first drives."""

    def __init__(self, robot, legs=1):
        self.robot, self.legs = robot, legs
        self.programs = {mesh: Program(robot, mesh[0], legs) for mesh in (COARSE, MIDDLE, FINE)}
        self.solves, self.failed = 0, 0

    def on(self, mesh, drives, poses):
        """Solved on a mesh that follows the drives: the drives, their exact energy (J) and the poses."""
        parts, width, tolerance = mesh
        half_m = self.robot.half_track_m
        firsts = [remeshed(drive, parts, half_m) for drive in drives]
        found, _, good = self.programs[mesh].solve(firsts, poses, width, tolerance=tolerance)
        self.solves, self.failed = self.solves + 1, self.failed + (not good)
        if not good:
            return None
        return sum(drive_energy(self.robot, drive.s, drive.u, drive.b)[0] for drive in found), found, poses

    def best(self, firsts):
        """(energy in J, drives, poses, names of the starts' energies) of the best of (name, drives, poses)."""
        coarse, by_start = [], {}
        for name, drives, poses in firsts:
            found = self.on(COARSE, drives, poses)
            if found:
                by_start[name] = found[0]
                coarse.append((*found, name))
        coarse.sort(key=lambda row: row[0])
        middle = []
        for row in self.unlike(coarse)[:REFINED]:
            found = self.on(MIDDLE, row[1], row[2])
            middle.append((*found, row[3]) if found else row)
        middle.sort(key=lambda row: row[0])
        energy, drives, poses, name = middle[0]
        for _ in range(2):
            found = self.on(FINE, drives, poses)
            if found and found[0] < energy:
                energy, drives, poses = found
        return energy, drives, poses, name, by_start

    def unlike(self, rows):
        """Drives within reach of the best one, one of each kind."""
        kept = []
        for row in rows:
            length = sum(drive.s[-1] for drive in row[1])
            like = any(abs(row[0] / other[0] - 1) < ALIKE and abs(length / sum(d.s[-1] for d in other[1]) - 1) < ALIKE
                       for other in kept)
            if row[0] <= WITHIN * rows[0][0] and not like:
                kept.append(row)
        return kept

    def leg(self, start, goal):
        """The best drive between two poses (m, m, rad)."""
        return self.best([(name, [first], [start, as_end(goal, first.heading[-1])])
                          for name, first in guesses(self.robot, start, goal).items()])
