"""Functions: problems of an angle turned into another, and what is found of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from test_linkages import textbook

import linkwright as lw

INPUTS = [0, 15, 30, 45, 60, 75, 90]
OUTPUTS = [0, 2, 8, 18, 31, 48, 67]


def turned_deg(best: lw.Candidate, inputs: Sequence[float]) -> np.ndarray:
    """How far the follower turns from its angle at an output of 0, in the sense of the outputs, by :func:`textbook`."""
    linkage = best.linkage
    ground = np.degrees(np.arctan2(linkage.B[1] - linkage.A[1], linkage.B[0] - linkage.A[0]))
    phi = np.radians(ground + best.input_offset_deg + np.asarray(inputs, dtype=float))
    d, _ = textbook(linkage, phi)
    psi = np.degrees(np.arctan2(d[:, 1] - linkage.B[1], d[:, 0] - linkage.B[0])) - ground - best.output_offset_deg
    turned = psi * (-1 if best.sense == "opposite" else 1)
    return np.asarray((turned - np.asarray(OUTPUTS) + 180) % 360 - 180 + np.asarray(OUTPUTS))


def test_arrays_are_a_problem_of_a_function() -> None:
    problem = lw.function(np.array(INPUTS), np.array(OUTPUTS), sense="same", tolerance_deg=1, design={"A": [0, 0], "B": [100, 0]})
    function = problem.resolved["task"]["function"]
    assert function["input_deg"] == INPUTS
    assert function["output_deg"] == OUTPUTS
    assert function["tolerance_deg"] == [1] * 7
    assert function["sense"] == "same"
    assert lw.function(INPUTS, OUTPUTS).digest != problem.digest


def test_errors_of_a_function_are_those_of_their_definition() -> None:
    result = lw.synth(lw.function(INPUTS, OUTPUTS, solve={"candidates": 3}))
    for best in result.candidates:
        assert best.accepted
        off = turned_deg(best, INPUTS) - np.asarray(OUTPUTS)
        output = best.error["output"]
        assert output["rms_deg"] == pytest.approx(float(np.sqrt((off**2).mean())), rel=1e-6)
        assert output["max_deg"] == pytest.approx(float(np.abs(off).max()), rel=1e-6)
        assert best.error["rms"] == pytest.approx(output["rms_deg"], rel=1e-9)
        assert best.error["objective"] == pytest.approx(float((off**2).sum()), rel=1e-6)


def test_a_formula_is_a_function() -> None:
    problem = lw.function(of="log10(x)", over=[1, 2], input_range_deg=60, output_range_deg=90, samples=61)
    function = problem.resolved["task"]["function"]
    x = np.linspace(1, 2, 61)
    assert np.allclose(function["input_deg"], np.linspace(0, 60, 61))
    assert np.allclose(function["output_deg"], 90 * np.log10(x) / np.log10(2))
    assert function["of"] == {"formula": "log10(x)", "over": [1, 2]}


def test_bad_functions_are_refused_with_the_remedy() -> None:
    with pytest.raises(lw.ProblemError, match="3 inputs and 2 outputs"):
        lw.function([0, 10, 20], [0, 5])
    with pytest.raises(lw.ProblemError, match="unknown name"):
        lw.function(of="y + 1", over=[0, 1], input_range_deg=90, output_range_deg=90)
    with pytest.raises(lw.ProblemError, match="free ranges"):
        lw.function(INPUTS, OUTPUTS, output_range_deg="free", solve={"method": "genetic"})


def test_free_ranges_are_found_and_pairs_are_proportions() -> None:
    result = lw.synth(lw.function(INPUTS, OUTPUTS, input_range_deg=[60, 120], output_range_deg="free", sense="same"))
    best = result.candidates[0]
    assert 60 - 1e-6 <= best.input_range_deg <= 120 + 1e-6
    assert 30 - 1e-6 <= best.output_range_deg <= 180 + 1e-6
    crank = np.asarray(best.crank_deg)
    assert np.ptp(crank) == pytest.approx(best.input_range_deg, rel=1e-9)
    scale = best.output_range_deg / 67
    linkage = best.linkage
    ground = np.degrees(np.arctan2(linkage.B[1] - linkage.A[1], linkage.B[0] - linkage.A[0]))
    d, _ = textbook(linkage, np.radians(crank))
    psi = np.degrees(np.arctan2(d[:, 1] - linkage.B[1], d[:, 0] - linkage.B[0])) - ground - best.output_offset_deg
    off = (psi - scale * np.asarray(OUTPUTS) + 180) % 360 - 180
    assert best.error["output"]["rms_deg"] == pytest.approx(float(np.sqrt((off**2).mean())), rel=1e-6)
    assert best.error["objective"] == pytest.approx(float((off**2).sum()) / scale**2, rel=1e-6)


def test_functions_and_motions_are_drawn() -> None:
    pytest.importorskip("matplotlib").use("agg")
    function = lw.synth(lw.function(INPUTS, OUTPUTS, solve={"candidates": 1})).candidates[0]
    target = function.plot().lines[0].get_xydata()
    at = function.linkage.positions(np.radians(function.crank_deg))
    # Errors are below a degree.
    assert np.abs(target - at.D).max() < 0.02 * function.linkage.c
    motion = lw.synth(lw.motion([[600, 0, 0], [579, 158, 15], [542, 284, 27], [501, 381, 37], [433, 483, 50]])).candidates[0]
    assert motion.plot().lines[0].get_xydata().shape == (5, 2)
