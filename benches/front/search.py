"""Searches for a front with pymoo's NSGA-II and NSGA-III, on a problem's own bounds and requirements."""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.algorithms.moo.nsga3 import NSGA3
from pymoo.core.problem import Problem as Optimisation
from pymoo.optimize import minimize
from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting
from pymoo.util.ref_dirs import get_reference_directions

from evaluate import REPORT, SEARCH, evaluated
from linkage import Array, FourBars
from problem import LEAST_SEARCHED, REACH, Problem

POPULATION = 200
# 18 divisions of three axes give 190 reference directions, the most that a population of 200 holds.
DIVISIONS = 18
ALGORITHMS = ("NSGA-II", "NSGA-III")
# What passes within this much, without a unit, is met.
MET = 1e-6


@dataclass
class Member:
    """A member of a front: the axes, the linkage's keys and the parameters at its targets."""

    rms: float
    transmission_deg: float
    extent: float
    keys: dict[str, float]
    t: list[float]


@dataclass
class Front:
    """A front of one algorithm on one problem, the time of its search (one process), the seed and the budget."""

    algorithm: str
    problem: str
    digest: str
    seed: int
    evaluations: int
    wall_s: float
    cpu_s: float
    members: list[Member]

    def as_json(self) -> dict:
        """Returns the front as plain data."""
        return asdict(self)

    @classmethod
    def of_json(cls, data: dict) -> Front:
        """Returns the front of plain data."""
        return cls(**{**data, "members": [Member(**member) for member in data["members"]]})


class Variables:
    """The free variables: pivots, lengths, coupler point, the assembly, and the offset of a timed task."""

    def __init__(self, problem: Problem) -> None:
        """Takes the bounds of the problem; a bound that the file leaves open gets the reach of the defaults."""
        bounds, far = dict(problem.bounds), 2 * REACH * problem.size
        self.polar = "Bx" not in bounds
        second = ("ground", "ground_angle_deg") if self.polar else ("Bx", "By")
        bounds.setdefault("ground_angle_deg", (-180.0, 180.0))
        for key in ("coupler_x", "coupler_y"):
            reach = bounds.get("d", (0.0, bounds["b"][1] + bounds.get("e", (0.0, far))[1]))[1]
            bounds.setdefault(key, (-reach, reach))
        for key in ("a", "b", "c", "ground"):
            low, high = bounds.get(key, (0.0, far))
            bounds[key] = (max(low, min(LEAST_SEARCHED * problem.size, high)), high)
        names = ["Ax", "Ay", *second, "a", "b", "c", "coupler_x", "coupler_y"]
        self.bounds = [bounds[name] for name in names] + [(0.0, 4.0)]
        if problem.timing is not None:
            self.bounds.append((-np.pi, np.pi) if problem.timing.offset == "free" else (0.0, 0.0))
        limits = np.array(self.bounds)
        self.free = np.flatnonzero(limits[:, 0] < limits[:, 1])
        self.low, self.high = limits[self.free].T

    def linkages(self, genes: Array) -> tuple[FourBars, tuple[Array, Array, Array]]:
        """Returns the linkages of rows of genes with t1, the arc and the offset."""
        x = np.tile([low for low, _ in self.bounds], (len(genes), 1))
        x[:, self.free] = genes
        A = x[:, 0] + 1j * x[:, 1]
        B = A + x[:, 2] * np.exp(1j * np.radians(x[:, 3])) if self.polar else x[:, 2] + 1j * x[:, 3]
        bars = FourBars(A, B, x[:, 4], x[:, 5], x[:, 6], x[:, 7] + 1j * x[:, 8])
        t1 = np.where(x[:, 9] % 2 < 1, 1.0, -1.0)
        arc = np.where(x[:, 9] < 2, 1.0, -1.0)
        return bars, (t1, arc, x[:, 10] if x.shape[1] > 10 else np.zeros(len(x)))


class FrontOptimisation(Optimisation):
    """The problem as pymoo takes it: objectives log10 rms, minus transmission angle, extent; constraints g <= 0."""

    def __init__(self, problem: Problem) -> None:
        """Counts the constraints at one point of the box."""
        self.task, self.variables = problem, Variables(problem)
        low, high = self.variables.low, self.variables.high
        rows = len(self.evaluate_rows(0.5 * (low + high)[None])[1])
        super().__init__(n_var=len(low), n_obj=3, n_ieq_constr=rows, xl=low, xu=high)

    def evaluate_rows(self, genes: Array) -> tuple[Array, Array]:
        """Returns objectives and violations in rows."""
        # Degenerate designs divide by zero; their violations say so.
        with np.errstate(all="ignore"):
            figures = evaluated(self.task, *self.variables.linkages(genes), SEARCH)
        log_rms = np.log10(np.maximum(figures.rms, 1e-15 * self.task.size))
        return np.array([log_rms, -figures.transmission_deg, figures.extent]), figures.violations

    def _evaluate(self, x: Array, out: dict, *_args: object, **_keys: object) -> None:
        rows, violations = self.evaluate_rows(x)
        out["F"], out["G"] = rows.T, violations.T


def axes_of(members: list[Member]) -> Array:
    """Returns log10 rms, minus transmission angle and extent in columns: all to be small."""
    rows = [(np.log10(max(m.rms, 1e-300)), -m.transmission_deg, m.extent) for m in members]
    return np.array(rows).reshape(-1, 3)


def members_of(problem: Problem, genes: Array) -> list[Member]:
    """Returns the feasible members of a population that no other beats, with refined crank angles."""
    bars, sides = Variables(problem).linkages(genes)
    figures = evaluated(problem, bars, sides, REPORT)
    members = []
    for i in np.flatnonzero((figures.violations <= MET).all(axis=0)):
        keys = bars.keys(i) | {"t1": float(sides[0][i]), "arc": float(sides[1][i])}
        axes = [float(v[i]) for v in (figures.rms, figures.transmission_deg, figures.extent)]
        members.append(Member(*axes, keys, figures.t[:, i].tolist()))
    if not members:
        return []
    best = NonDominatedSorting().do(axes_of(members), only_non_dominated_front=True)
    return [members[i] for i in sorted(best, key=lambda i: members[i].rms)]


def searched(problem: Problem, name: str, seed: int, evaluations: int) -> Front:
    """Runs one algorithm and returns its front; the time is that of the search alone."""
    if name == "NSGA-II":
        algorithm = NSGA2(pop_size=POPULATION)
    else:
        directions = get_reference_directions("das-dennis", 3, n_partitions=DIVISIONS)
        algorithm = NSGA3(ref_dirs=directions, pop_size=POPULATION)
    begun, begun_cpu = time.perf_counter(), time.process_time()
    result = minimize(FrontOptimisation(problem), algorithm, ("n_eval", evaluations), seed=seed)
    wall, cpu = time.perf_counter() - begun, time.process_time() - begun_cpu
    members = members_of(problem, result.pop.get("X"))
    return Front(name, problem.name, problem.digest, seed, evaluations, wall, cpu, members)
