"""Motions: problems of poses of a body, and what is found of them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from test_linkages import textbook

import linkwright as lw

#: A crank-rocker, and a body on its coupler that lies at an angle of 20 degrees from the direction C -> D.
LINKAGE = lw.FourBar((0, 0), (4, 1), 2, 5, 5, 5, 5, t1=1, t2=-1)
FRAME_DEG = 20.0


def poses_of(linkage: lw.FourBar, crank_deg: object, frame_deg: float) -> np.ndarray:
    """x, y and the angle in degrees of a body on the coupler, shape (n, 3), by the circles of :func:`textbook`."""
    phi = np.radians(np.asarray(crank_deg, dtype=float))
    d, p = textbook(linkage, phi)
    c = np.array(linkage.A) + linkage.a * np.stack([np.cos(phi), np.sin(phi)], axis=-1)
    coupler = np.degrees(np.arctan2(d[:, 1] - c[:, 1], d[:, 0] - c[:, 0]))
    return np.column_stack([p, coupler + frame_deg])


def apart_deg(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """The difference of angles, within half a turn."""
    return np.asarray((one - other + 180) % 360 - 180)


POSES = poses_of(LINKAGE, [10, 50, 90, 140, 200, 260], FRAME_DEG)


@pytest.fixture(scope="module")
def found() -> lw.Result:
    return lw.synth(lw.motion(POSES, name="six poses", unit="mm"))


def test_an_array_of_poses_is_a_problem_of_a_motion() -> None:
    problem = lw.motion(POSES, angle_weight=3.0, weight=[1, 1, 1, 1, 1, 2], unit="mm")
    motion = problem.resolved["task"]["motion"]
    assert motion["poses"] == POSES.tolist()
    assert motion["angle_weight"] == 3.0
    assert motion["weight"] == [1, 1, 1, 1, 1, 2]
    assert np.allclose(problem.points(), POSES[:, :2])
    assert problem.best_known_objective is None
    assert lw.motion(POSES.tolist()).digest == lw.motion(POSES).digest
    assert lw.motion(POSES).digest != problem.digest


def test_a_pose_may_be_a_place_alone() -> None:
    poses = POSES.tolist()
    poses[2] = poses[2][:2]
    motion = lw.motion(poses).resolved["task"]["motion"]
    assert [len(pose) for pose in motion["poses"]] == [3, 3, 2, 3, 3, 3]


def test_the_best_answer_passes_the_poses_by_a_judge_of_this_test(found: lw.Result) -> None:
    best = found.candidates[0]
    assert best.accepted
    assert len(best.crank_deg) == len(best.t1_at) == len(POSES)
    assert set(best.t1_at) == {best.linkage.t1}
    passed = poses_of(best.linkage, best.crank_deg, best.frame_deg)
    assert np.abs(passed[:, :2] - POSES[:, :2]).max() < 1e-9
    assert np.abs(apart_deg(passed[:, 2], POSES[:, 2])).max() < 1e-8
    assert best.error["rms"] < 1e-9
    assert best.error["angle"]["rms_deg"] < 1e-8
    assert best.error["angle"]["max_deg"] >= best.error["angle"]["rms_deg"]


def test_the_arrays_of_the_best_answer_have_a_row_a_pose(found: lw.Result) -> None:
    best = found.candidates[0]
    at = best.linkage.positions(np.radians(best.crank_deg))
    assert at.C.shape == at.D.shape == at.P.shape == (len(POSES), 2)
    assert np.abs(at.P - POSES[:, :2]).max() < 1e-9


def test_errors_of_poses_that_no_linkage_passes_are_those_of_their_definition() -> None:
    rng = np.random.default_rng(7)
    poses = poses_of(LINKAGE, np.arange(0, 360, 30), FRAME_DEG)
    poses += rng.normal(size=poses.shape) * [0.02, 0.02, 0.5]
    problem = lw.motion(poses)
    best = lw.synth(problem).candidates[0]
    assert set(best.t1_at) == {best.linkage.t1}
    passed = poses_of(best.linkage, best.crank_deg, best.frame_deg)
    places_sq = float(((passed[:, :2] - poses[:, :2]) ** 2).sum())
    turned = apart_deg(passed[:, 2], poses[:, 2])
    weight = problem.resolved["task"]["motion"]["angle_weight"]
    objective = places_sq + weight**2 * float((np.radians(turned) ** 2).sum())
    error = best.error
    assert error["sum_sq"] == pytest.approx(places_sq, rel=1e-9)
    assert error["rms"] == pytest.approx(math.sqrt(places_sq / len(poses)), rel=1e-9)
    assert error["angle"]["rms_deg"] == pytest.approx(math.sqrt(float((turned**2).mean())), rel=1e-9)
    assert error["angle"]["max_deg"] == pytest.approx(float(np.abs(turned).max()), rel=1e-9)
    assert error["objective"] == pytest.approx(objective, rel=1e-9)
    # The noise is what is left at most.
    assert error["rms"] < 0.05
    assert error["angle"]["rms_deg"] < 1.0


def test_bad_poses_are_refused_with_the_remedy() -> None:
    with pytest.raises(lw.ProblemError, match="expected a pose"):
        lw.motion([[1, 2, 3, 4]] * 5)
    with pytest.raises(lw.ProblemError, match="reduced"):
        lw.motion(POSES, solve={"method": "genetic", "variables": "reduced"})


def test_poses_are_passed_at_given_crank_angles() -> None:
    turns = [10, 50, 90, 140, 200, 260]
    ground = math.degrees(math.atan2(1, 4))
    problem = lw.motion(POSES, crank_deg=[turn - ground for turn in turns], offset="ground")
    best = lw.synth(problem).candidates[0]
    assert best.accepted
    assert np.allclose(best.crank_deg, turns, atol=1e-6)
    assert best.linkage.a == pytest.approx(LINKAGE.a, rel=1e-7)
    passed = poses_of(best.linkage, best.crank_deg, best.frame_deg)
    assert np.abs(passed[:, :2] - POSES[:, :2]).max() < 1e-7
    with pytest.raises(lw.ProblemError, match="6 poses and 2 crank angles"):
        lw.motion(POSES, crank_deg=[0, 10])
