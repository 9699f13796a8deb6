"""Compares the fronts of `linkwright front` with those of pymoo's NSGA-II and NSGA-III.

    python benches/front/compare.py [--program PROGRAM] [--seed N] [--quick] [--save FILE | --theirs FILE]

Exit status: 0 where every Must holds, 1 where one fails, 2 where the comparison itself could not be made.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pymoo.indicators.hv import HV
from pymoo.operators.survival.rank_and_crowding.metrics import get_crowding_function

from check import Row, beaten_within, faults_of, front_rows
from linkage import Array
from problem import Problem, read_problem
from search import ALGORITHMS, Front, axes_of, searched

ROOT = Path(__file__).resolve().parents[2]
PROBLEMS = (
    "problems/literature/k18.toml",
    "problems/literature/l10.toml",
    "problems/examples/walking-stride.toml",
    "problems/examples/straight-line.toml",
    "problems/literature/shape-letter-D.toml",
    "benches/front/egg.toml",
)
EVALUATIONS, QUICK_EVALUATIONS = 200_000, 20_000
REFERENCE = 1.1
# The Musts: the least ratio of hypervolumes, and the most of their time that ours may take.
LEAST_RATIO, MOST_TIME = 1.02, 1 / 20
# A member counts as beaten by one that beats it even after being made worse by this part on every axis.
CLEARLY = 1e-3


@dataclass
class Ours:
    """The rows of our front, the time of the command, and what went wrong."""

    rows: list[Row]
    wall_s: float
    faults: list[str]

    @property
    def axes(self) -> Array:
        """Returns log10 rms, minus transmission angle and extent in columns."""
        return np.array([row.axes for row in self.rows]).reshape(-1, 3)


@dataclass
class Verdict:
    """The comparison of our front with one of theirs."""

    theirs: int
    volume: float
    their_volume: float
    seconds: float
    beating: int

    @property
    def ratio(self) -> float:
        """Returns our hypervolume over theirs."""
        return self.volume / self.their_volume if self.their_volume > 0 else float("inf")


def problem_files(options: argparse.Namespace, folder: Path) -> list[Path]:
    """Returns the problem files; without tolerances, copies of those that have one, under another name."""
    files = [ROOT / file for file in PROBLEMS]
    if not options.without_tolerance:
        return [file for file in files if options.only in file.stem]
    copies = []
    for file in files:
        text, removed = re.subn(r"(?m)^tolerance\s*=.*\n", "", file.read_text(encoding="utf-8"))
        if removed and options.only in file.stem:
            copies.append(folder / f"{file.stem}-without-tolerance.toml")
            copies[-1].write_text(re.sub(r'(?m)^name\s*=\s*"(.*)"', r'name = "\1-without-tolerance"', text))
    return copies


def run_ours(problem: Problem, file: Path, options: argparse.Namespace, folder: Path) -> Ours:
    """Runs the command on a problem and checks every row of its front."""
    out = folder / "results" / problem.name
    out.parent.mkdir(exist_ok=True)
    asked = ["--axes", "rms,transmission,extent", "--points", str(options.points), "--out", str(out)]
    begun = time.perf_counter()
    done = subprocess.run(
        [str(options.program), "front", str(file), *asked], capture_output=True, text=True, check=False
    )
    wall = time.perf_counter() - begun
    faults = [] if done.returncode == 0 else [f"exit status {done.returncode}: {done.stderr.strip()[-300:]}"]
    if not (out / "front.csv").exists():
        return Ours([], wall, [*faults, "there is no front.csv"])
    rows = front_rows(out)
    for number, row in enumerate(rows, 1):
        faults += [f"row {number}: {fault}" for fault in faults_of(problem, row)]
    beaten = beaten_within(rows)
    return Ours(rows, wall, faults + ([f"{beaten} rows are beaten by rows of the same front"] if beaten else []))


def thinned(axes: Array, count: int) -> Array:
    """Returns `count` members: the most crowded one by pymoo's crowding distance is removed again and again."""
    crowding = get_crowding_function("cd")
    while len(axes) > max(count, 0):
        axes = np.delete(axes, int(np.argmin(crowding.do(axes, n_remove=0))), axis=0)
    return axes


def hypervolumes(one: Array, other: Array) -> tuple[float, float]:
    """Returns the exact hypervolumes of two fronts, scaled to their joint box."""
    both = np.vstack([one, other])
    low, width = both.min(axis=0), np.ptp(both, axis=0)
    scale = np.where(width > 0, width, 1.0)
    volume = HV(ref_point=np.full(3, REFERENCE))
    found = [float(volume((axes - low) / scale)) if len(axes) else 0.0 for axes in (one, other)]
    return found[0], found[1]


def beating(front: Front, ours: Ours) -> int:
    """Returns the number of their members that clearly beat one of ours."""
    count = 0
    for member in front.members:
        rms, extent = (value * (1 + CLEARLY) for value in (member.rms, member.extent))
        transmission = member.transmission_deg * (1 - CLEARLY)
        mine = [row.figures for row in ours.rows]
        count += any(rms <= f["rms"] and transmission >= f["transmission_deg"] and extent <= f["extent"] for f in mine)
    return count


def compared(ours: Ours, front: Front) -> Verdict:
    """Returns the comparison with one of their fronts; their time is the lesser of wall and processor time."""
    theirs = thinned(axes_of(front.members), len(ours.rows)) if ours.rows else axes_of(front.members)
    volumes = hypervolumes(ours.axes, theirs) if len(ours.rows) + len(theirs) else (0.0, 0.0)
    return Verdict(len(front.members), *volumes, min(front.wall_s, front.cpu_s), beating(front, ours))


def failures(ours: Ours, verdict: Verdict, name: str) -> list[str]:
    """Returns the Musts that fail against one algorithm."""
    failed = []
    if not verdict.ratio >= LEAST_RATIO or not ours.rows:
        failed.append(f"{name}: the ratio of hypervolumes is {verdict.ratio:.4f}, at least {LEAST_RATIO} is a must")
    if ours.wall_s > MOST_TIME * verdict.seconds:
        failed.append(f"{name}: ours takes {ours.wall_s:.2f} s, at most {MOST_TIME * verdict.seconds:.2f} s is a must")
    if verdict.beating:
        failed.append(f"{name}: {verdict.beating} of their members clearly beat one of ours")
    return failed


def load_fronts(file: Path | None) -> dict[tuple[str, str], Front]:
    """Returns stored fronts by problem and algorithm."""
    if file is None:
        return {}
    fronts = [Front.of_json(data) for data in json.loads(file.read_text())["fronts"]]
    return {(front.problem, front.algorithm): front for front in fronts}


def save_fronts(file: Path | None, fronts: dict[tuple[str, str], Front]) -> None:
    """Writes fronts to a file, if one is asked for."""
    if file is not None:
        file.write_text(json.dumps({"fronts": [front.as_json() for front in fronts.values()]}, indent=1))


def front_of(problem: Problem, name: str, options: argparse.Namespace, stored: dict) -> Front:
    """Returns the stored front, or searches for it where none is stored; refuses one that was made otherwise."""
    evaluations = QUICK_EVALUATIONS if options.quick else EVALUATIONS
    if options.theirs is None:
        print(f"{problem.name}: {name}, {evaluations} evaluations ..", file=sys.stderr, flush=True)
        return searched(problem, name, options.seed, evaluations)
    front = stored.get((problem.name, name))
    wanted = (problem.digest, options.seed, evaluations)
    if front is None or (front.digest, front.seed, front.evaluations) != wanted:
        raise NotComparable(f"{options.theirs} has no front of {problem.name} by {name} for this file, seed and budget")
    return front


class NotComparable(Exception):
    """The comparison could not be made: exit status 2."""


def report(problem: Problem, ours: Ours, verdicts: dict[str, Verdict]) -> list[str]:
    """Prints the table of one problem and returns the Musts that fail."""
    print(f"\n{problem.name}: {len(ours.rows)} members in {ours.wall_s:.2f} s")
    print(
        f"  {'against':9} {'members':>7} {'HV ours':>8} {'theirs':>8} {'ratio':>8} {'theirs s':>9} {'of it':>7} beat ours"
    )
    failed = []
    for name, v in verdicts.items():
        part = ours.wall_s / v.seconds
        print(
            f"  {name:9} {v.theirs:7} {v.volume:8.4f} {v.their_volume:8.4f} {v.ratio:8.4f} {v.seconds:9.1f}"
            f" {part:7.4f} {v.beating:9}"
        )
        failed += failures(ours, v, name)
    print(f"  check: {f'{len(ours.faults)} faults' if ours.faults else 'every figure and requirement holds'}")
    for fault in ours.faults:
        print(f"    {fault}")
    failed += ["the independent check finds faults"] if ours.faults else []
    for must in failed:
        print(f"  MUST: {must}")
    return failed


def arguments() -> argparse.Namespace:
    """Returns the options of the command line."""
    parser = argparse.ArgumentParser(description="Compares fronts with pymoo's NSGA-II and NSGA-III.")
    parser.add_argument("--program", type=Path, default=ROOT / "target/release/linkwright")
    parser.add_argument("--seed", type=int, default=1, help="of pymoo's algorithms")
    parser.add_argument("--points", type=int, default=20, help="members asked of our front")
    parser.add_argument(
        "--quick", action="store_true", help=f"{QUICK_EVALUATIONS} evaluations in place of {EVALUATIONS}"
    )
    parser.add_argument("--only", default="", help="only problems whose name contains this")
    parser.add_argument(
        "--without-tolerance", action="store_true", help="compare on the problems with a tolerance, but without it"
    )
    parser.add_argument("--search-only", action="store_true", help="run pymoo alone, with --save")
    stored = parser.add_mutually_exclusive_group()
    stored.add_argument("--save", type=Path, help="store their fronts and times in this file")
    stored.add_argument("--theirs", type=Path, help="take their fronts and times from this file")
    return parser.parse_args()


def main() -> int:
    """Runs the comparison and returns the exit status."""
    options = arguments()
    try:
        stored = load_fronts(options.theirs)
        fronts: dict[tuple[str, str], Front] = {}
        failed = []
        with tempfile.TemporaryDirectory() as folder:
            for file in problem_files(options, Path(folder)):
                problem = read_problem(file)
                for name in ALGORITHMS:
                    fronts[problem.name, name] = front_of(problem, name, options, stored)
                    save_fronts(options.save, fronts)
                if options.search_only:
                    continue
                ours = run_ours(problem, file, options, Path(folder))
                verdicts = {name: compared(ours, fronts[problem.name, name]) for name in ALGORITHMS}
                failed += report(problem, ours, verdicts)
    except (NotComparable, OSError, ValueError, KeyError) as error:
        print(f"compare: {error}", file=sys.stderr)
        return 2
    if not fronts:
        print(f"compare: no problem is named *{options.only}*", file=sys.stderr)
        return 2
    if options.search_only:
        return 0
    print(f"\n{len(failed)} Musts fail" if failed else "\nevery Must holds")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
