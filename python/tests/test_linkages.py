"""Linkages: positions, velocities and accelerations; the rule by which arrays are converted."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest

import linkwright as lw

LINKAGE = lw.FourBar((0, 0), (4, 1), 2, 5, 5, 5, 5, t1=1, t2=-1)
#: A linkage whose loop is open at some crank angles.
ROCKER = lw.FourBar((0, 0), (4, 0), 3, 2, 2, 1.5, 1.5)


def textbook(linkage: lw.FourBar, phi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """D and P by circles: written for this test, from the definitions of t1 and t2."""
    a, b = np.array(linkage.A), np.array(linkage.B)
    c = a + linkage.a * np.stack([np.cos(phi), np.sin(phi)], axis=-1)
    v = b - c
    s = np.hypot(v[..., 0], v[..., 1])
    along = (linkage.b**2 - linkage.c**2 + s**2) / (2 * s)
    with np.errstate(invalid="ignore"):
        across = np.sqrt(linkage.b**2 - along**2)
    unit = v / s[..., None]
    left = np.stack([-unit[..., 1], unit[..., 0]], axis=-1)
    d = c + along[..., None] * unit + linkage.t1 * across[..., None] * left
    w = (d - c) / linkage.b
    x = (linkage.d**2 - linkage.e**2 + linkage.b**2) / (2 * linkage.b)
    y = linkage.t2 * math.sqrt(max(linkage.d**2 - x**2, 0))
    return d, c + x * w + y * np.stack([-w[..., 1], w[..., 0]], axis=-1)


@pytest.mark.parametrize("linkage", [LINKAGE, ROCKER])
def test_positions_are_those_of_the_textbook_and_nan_where_the_loop_is_open(linkage: lw.FourBar) -> None:
    phi = np.linspace(-7, 7, 1001)
    at = linkage.positions(phi)
    d, p = textbook(linkage, phi)
    # Away from toggles: there the textbook's root loses half of its digits.
    sure = ~np.isnan(d[:, 0]) & (linkage.transmission_deg(phi) > 1) & (linkage.transmission_deg(phi) < 179)
    assert np.allclose(at.D[sure], d[sure], rtol=0, atol=1e-11)
    assert np.allclose(at.P[sure], p[sure], rtol=0, atol=1e-11)
    assert np.isnan(at.P[np.isnan(d[:, 0])]).all()
    assert np.isnan(at.C[np.isnan(d[:, 0])]).all()


def test_velocities_and_accelerations_are_differences_of_positions() -> None:
    phi = np.linspace(0, 6, 50)
    omega, alpha, step = 3.0, 0.7, 1e-5

    def at(t: float) -> lw.Positions:
        return LINKAGE.positions(phi + omega * t + 0.5 * alpha * t * t)

    speed = LINKAGE.velocities(phi, omega)
    pull = LINKAGE.accelerations(phi, omega, alpha)
    for joint in "CDP":
        before, here, after = (getattr(at(t), joint) for t in (-step, 0.0, step))
        sure = ~np.isnan(getattr(pull, joint))
        velocity, acceleration = (after - before) / (2 * step), (after - 2 * here + before) / step**2
        # Central differences: an error of step^2 for the first, rounding over step^2 for the second.
        assert np.allclose(getattr(speed, joint)[sure], velocity[sure], rtol=1e-6, atol=1e-6)
        assert np.allclose(getattr(pull, joint)[sure], acceleration[sure], rtol=1e-3, atol=1e-3)
    assert speed.coupler.shape == speed.follower.shape == phi.shape


SHAPES = [
    (0.3, ()),
    (np.float64(0.3), ()),
    (1, ()),
    ([0.1, 0.2], (2,)),
    ((0.1, 0.2, 0.3), (3,)),
    ([], (0,)),
    ([[0.1, 0.2], [0.3, 0.4]], (2, 2)),
    (np.zeros((2, 3, 4)), (2, 3, 4)),
    (range(5), (5,)),
]


@pytest.mark.parametrize(("phi", "shape"), SHAPES)
def test_answers_have_the_shape_of_the_angles(phi: object, shape: tuple[int, ...]) -> None:
    at = LINKAGE.positions(phi)  # type: ignore[arg-type]
    assert at.C.shape == at.D.shape == at.P.shape == (*shape, 2)
    assert at.P.dtype == np.float64
    assert LINKAGE.transmission_deg(phi).shape == shape  # type: ignore[arg-type]
    assert LINKAGE.velocities(phi).coupler.shape == shape  # type: ignore[arg-type]


ANGLES = np.array([0.0, 0.5, 1.0, 2.5, -4.0, 100.0])
FORMS = {
    "list": ANGLES.tolist(),
    "big-endian": ANGLES.astype(">f8"),
    "float32": ANGLES.astype("f4"),
    "long double": ANGLES.astype("g"),
    "half": ANGLES.astype("f2"),
    "reversed": ANGLES[::-1].copy()[::-1],
    "strided": np.repeat(ANGLES, 3)[::3],
    "a column": np.stack([ANGLES, ANGLES], axis=1)[:, 0],
    "read-only": np.frombuffer(ANGLES.tobytes()),
    "unaligned": np.frombuffer(b"x" + ANGLES.tobytes(), dtype=np.uint8)[1:].view("f8"),
}


@pytest.mark.parametrize("form", FORMS)
def test_any_array_of_real_numbers_is_converted(form: str) -> None:
    assert np.array_equal(LINKAGE.positions(FORMS[form]).P, LINKAGE.positions(ANGLES).P, equal_nan=True)


@pytest.mark.parametrize("kind", ["i1", "i8", "u1", ">i4", "u8"])
def test_whole_numbers_are_angles_too(kind: str) -> None:
    phi = np.arange(5).astype(kind)
    assert np.array_equal(LINKAGE.positions(phi).P, LINKAGE.positions(np.arange(5.0)).P)


def test_two_dimensional_arrays_in_fortran_order_keep_their_places() -> None:
    phi = np.asfortranarray(np.arange(12.0).reshape(3, 4))
    assert np.array_equal(LINKAGE.positions(phi).P, LINKAGE.positions(phi.ravel()).P.reshape(3, 4, 2))


@pytest.mark.parametrize(
    "phi", [[True, False], [1j], ["a"], [None], [object()], np.array(["2020-01-01"], "M8[D]"), "0.5", b"0.5"]
)
def test_what_is_no_array_of_real_numbers_is_refused_by_name(phi: object) -> None:
    with pytest.raises(TypeError, match="phi: real numbers are needed"):
        LINKAGE.positions(phi)  # type: ignore[arg-type]


def test_a_ragged_list_is_refused_by_name() -> None:
    with pytest.raises(ValueError, match="phi: it cannot be made an array of numbers"):
        LINKAGE.positions([[1.0], [1.0, 2.0]])


def test_nan_and_infinities_are_angles_at_which_no_loop_closes() -> None:
    at = LINKAGE.positions([math.nan, math.inf, -math.inf, 0.0])
    assert np.isnan(at.P[:3]).all()
    assert np.isnan(at.C[:3]).all()
    assert np.isfinite(at.P[3]).all()
    assert np.isnan(LINKAGE.velocities([0.0], math.nan).P).all()
    assert np.isnan(LINKAGE.transmission_deg(math.nan))


def test_a_huge_array_is_answered() -> None:
    phi = np.linspace(0, 1000, 3_000_001)
    at = LINKAGE.positions(phi)
    assert at.P.shape == (3_000_001, 2)
    assert np.array_equal(at.P[-5:], LINKAGE.positions(phi[-5:]).P)


def test_answers_are_arrays_of_ones_own() -> None:
    one, other = LINKAGE.positions(ANGLES), LINKAGE.positions(ANGLES)
    one.P[:] = 0
    assert not np.array_equal(one.P, other.P)
    assert one.P.flags["W"]
    assert one.P.flags["C"]


def test_memory_that_is_used_again_is_memory_that_nobody_uses() -> None:
    phi = np.linspace(0, 6, 200_000)
    expected = [LINKAGE.positions(float(angle)).P for angle in phi[::50_000]]
    view = LINKAGE.positions(phi).P[::50_000]
    pickled = pickle.dumps(LINKAGE.positions(phi).C)
    for _ in range(3):
        other = LINKAGE.positions(phi + 1)
        other.P[:] = other.C[:] = other.D[:] = 0
        assert np.array_equal(view, expected)
    again = LINKAGE.positions(phi)
    assert np.array_equal(again.P[::50_000], expected)
    assert not np.shares_memory(again.P, again.C)
    assert not np.shares_memory(again.P, view)
    assert np.array_equal(pickle.loads(pickled), again.C)
    assert again.P.flags["W"]
    assert np.isfinite(LINKAGE.velocities(phi).P).all()


def test_a_linkage_tells_its_parameters_and_is_read_back(tmp_path: Path) -> None:
    linkage = lw.FourBar((0.1, 0.2), (4, 1), 2, 5, 5, 4.5, 5, t1=-1, t2=1, name="mine", unit="cm")
    assert (linkage.A, linkage.B, linkage.a, linkage.d, linkage.t1, linkage.t2) == ((0.1, 0.2), (4.0, 1.0), 2, 4.5, -1, 1)
    assert linkage.ground == math.hypot(3.9, 0.8)
    file = tmp_path / "mine.toml"
    file.write_text(linkage.to_toml())
    read = lw.load(file)
    assert read == linkage
    assert (read.name, read.unit) == ("mine", "cm")
    assert eval(repr(linkage), {"FourBar": lw.FourBar}) == linkage
    assert hash(read) == hash(linkage)
    assert linkage != LINKAGE
    assert linkage.mobility["type"] == linkage.type


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"a": 0.0}, "a = 0: a link's length must be positive"),
        ({"b": -1.0}, "b = -1: a link's length must be positive"),
        ({"d": -1.0}, "d = -1: the distance from a pin to the coupler point cannot be negative"),
        ({"A": (math.nan, 0.0)}, "A = NaN is not a finite number below 1e12 in magnitude"),
        ({"c": 1e13}, "c = 10000000000000 is not a finite number below 1e12"),
        ({"d": 100.0}, "no triangle has the sides b = 5, d = 100, e = 5"),
        ({"t1": 0}, "t1: a sign is 1 or -1, not 0"),
        ({"unit": "furlong"}, "`unit` is no unit of length: furlong; choose mm, cm, m or in"),
    ],
)
def test_lengths_of_no_linkage_are_refused(change: dict[str, object], text: str) -> None:
    given: dict[str, object] = {"A": (0, 0), "B": (4, 1), "a": 2, "b": 5, "c": 5, "d": 5, "e": 5, **change}
    with pytest.raises(lw.ProblemError) as refused:
        lw.FourBar(**given)  # type: ignore[arg-type]
    assert text in str(refused.value)


def test_a_coupler_curve_passes_its_positions() -> None:
    curve = LINKAGE.coupler_curve(0.0, samples=3600)
    p = LINKAGE.positions(0.0).P
    assert np.min(np.hypot(*(curve - p).T)) < 0.02
    with pytest.raises(ValueError, match="samples = 2"):
        LINKAGE.coupler_curve(0.0, samples=2)




def test_a_chain_moves_every_point(root: Path) -> None:
    files = [
        file for folder in ("problems", "tests/reference") for file in sorted((root / folder).rglob("*.toml"))
        if "[chain" in file.read_text()
    ]  # fmt: skip
    assert files
    chain = lw.load(files[0])
    assert isinstance(chain, lw.Chain)
    at = chain.positions(ANGLES)
    assert list(at) == chain.names
    assert at[chain.trace].shape == (6, 2)
    step = 1e-6
    speed = chain.velocities(ANGLES, 1.0)
    for name in chain.names:
        around = (chain.positions(ANGLES + step)[name] - chain.positions(ANGLES - step)[name]) / (2 * step)
        sure = ~np.isnan(around) & ~np.isnan(speed[name]) & (np.abs(around) < 1e3)
        assert np.allclose(around[sure], speed[name][sure], rtol=1e-4, atol=1e-4)
    assert set(chain.accelerations(0.5)) == set(chain.names)
    assert "stages" in repr(chain)
    with pytest.raises(lw.ProblemError, match="a chain is not a four-bar"):
        lw.cognates(chain)  # type: ignore[arg-type]


SLIDERS = [
    lw.slider_crank((0, 0), 1.0, 3.0, (0, 0.4), 10.0, 2.0, 0.5, name="saw", unit="mm"),
    lw.inverted_slider_crank((0, 0), (3, 0.5), 1.0, 0.3, 4.0, 0.2),
]


def test_a_six_bar_of_a_result_is_a_chain_that_draws_the_path(root: Path, tmp_path: Path) -> None:
    points = np.loadtxt(root / "problems/shapes/heart.csv", delimiter=",", skiprows=3)[::3]
    result = lw.synth(
        lw.path(
            points.tolist(),
            closed=True,
            design={"mechanism": "six-bar"},
            require={"transmission_deg_min": 30},
            solve={"evaluations": 40000, "candidates": 2},
        )
    )
    assert lw.verify(result).ok
    best = result.candidates[0]
    assert best.accepted and best.data["linkage"]["kind"] == "six-bar"
    chain = best.linkage
    assert isinstance(chain, lw.Chain) and chain.names[-1] == "P" and "F2" in chain.names
    at = chain.positions(np.radians(best.data["crank_deg"]))["P"]
    errors = np.hypot(*(at - points).T)
    assert math.sqrt(float(np.mean(errors**2))) == pytest.approx(best.error["rms"], rel=1e-9)
    file = tmp_path / "six-bar.toml"
    file.write_text(chain.to_toml())
    read = lw.load(file)
    assert isinstance(read, lw.Chain) and read.names == chain.names
    assert b"LINK6" in lw.export(chain, "dxf-plates", unit="mm", scale=20)
    built = lw.build(best)
    assert "link5" in built.text and len(built.data["distances"]) == 28
    again = lw.compare(chain, target=lw.path(points.tolist(), closed=True)).to_frame()
    assert again["rms"].max() == pytest.approx(best.error["rms"], rel=0.02)


def test_lengths_of_a_six_bar_are_snapped(root: Path) -> None:
    chain = lw.load(root / "problems" / "linkages" / "watt-six-bar.toml")
    snapped = lw.snap(chain, grid=4.0, snap=["a", "X2F2", "F2Y2"])
    best = snapped.candidates[0].linkage
    assert isinstance(best, lw.Chain)
    at = best.positions(ANGLES[:1])
    for one, other in (("A", "C"), ("X2", "F2"), ("Y2", "F2")):
        apart = np.hypot(*(at[one] - at[other]).T)[0]
        assert apart / 4.0 == pytest.approx(round(apart / 4.0), abs=1e-9)
    assert lw.verify(snapped).ok
    with pytest.raises(lw.ProblemError, match="a six-bar has no such dimension"):
        lw.snap(chain, grid=4.0, keep=["AF2"])


@pytest.mark.parametrize("linkage", SLIDERS, ids=lambda linkage: str(linkage.kind))
def test_lengths_of_a_linkage_with_a_slider_are_snapped(linkage: lw.SliderLinkage) -> None:
    wished = ["a", "b"] if linkage.b is not None else ["a", "ground"]
    snapped = lw.snap(linkage, grid=0.07, snap=wished)
    best = snapped.candidates[0].linkage
    assert isinstance(best, lw.SliderLinkage) and best.kind == linkage.kind
    lengths = [best.a] + [length for length in (best.b,) if length is not None]
    for length in lengths:
        assert length / 0.07 == pytest.approx(round(length / 0.07), abs=1e-9)
    assert lw.verify(snapped).ok
    with pytest.raises(lw.ProblemError, match=f"an? {linkage.kind} has no such dimension"):
        lw.snap(linkage, grid=0.07, keep=["c"])


@pytest.mark.parametrize("linkage", SLIDERS, ids=lambda linkage: str(linkage.kind))
def test_a_linkage_with_a_slider_moves_and_reads_back(linkage: lw.SliderLinkage, tmp_path: Path) -> None:
    at = linkage.positions(ANGLES)
    crank = at.C - np.array(linkage.A)
    sure = ~np.isnan(ANGLES)
    assert np.allclose(np.hypot(*crank[sure].T), linkage.a)
    if linkage.b is not None:
        assert np.allclose(np.hypot(*(at.D - at.C)[sure].T), linkage.b)
    assert np.allclose(np.hypot(*(at.P - at.C)[sure].T), math.hypot(linkage.coupler_x, linkage.coupler_y))
    step, rates = 1e-6, linkage.velocities(ANGLES)
    places = (linkage.places(ANGLES + step) - linkage.places(ANGLES - step)) / (2 * step)
    assert np.allclose(places[sure], rates.slider[sure], atol=1e-6)
    around = (linkage.velocities(ANGLES + step).P - linkage.velocities(ANGLES - step).P) / (2 * step)
    assert np.allclose(around[sure], linkage.accelerations(ANGLES).P[sure], rtol=1e-4, atol=1e-4)
    assert linkage.mobility["input_turns_fully"] is True
    assert np.nanmin(linkage.transmission_deg(ANGLES)) > 10
    assert np.min(np.hypot(*(linkage.coupler_curve(0.0) - linkage.positions(0.0).P).T)) < 0.05
    file = tmp_path / "linkage.toml"
    file.write_text(linkage.to_toml())
    read = lw.load(file)
    assert read == linkage
    assert hash(read) == hash(linkage)
    assert linkage.kind in repr(linkage)
    with pytest.raises(lw.ProblemError, match="is not a four-bar"):
        lw.cognates(linkage)  # type: ignore[arg-type]
    # It is measured on any target, built and exported without a run.
    own = lw.path(linkage.coupler_curve(0.0)[:-1:45].tolist(), closed=True)
    assert lw.compare(linkage, target=own).to_frame()["rms"].max() < 1e-6
    assert "slot" in lw.build(linkage).text
    assert b"AC1015" in lw.export(linkage, "dxf-plates")


def test_a_function_of_a_slider_is_found_and_drawn() -> None:
    problem = lw.function([0, 40, 80, 120, 160, 200], output=[0, 12, 40, 68, 90, 99], unit="mm", solve={"candidates": 1})
    best = lw.synth(problem).candidates[0]
    linkage = best.linkage
    assert isinstance(linkage, lw.SliderLinkage)
    sign = -1 if best.sense == "opposite" else 1
    made = sign * linkage.places(np.radians(best.crank_deg)) - best.output_offset
    assert np.sqrt(np.mean((made - [0, 12, 40, 68, 90, 99]) ** 2)) == pytest.approx(best.error["rms"])
    pytest.importorskip("matplotlib").use("agg")
    assert len(best.plot().lines) > 3
    with pytest.raises(lw.ProblemError, match="a length must be positive|must be positive"):
        lw.slider_crank((0, 0), -1.0, 3.0, (0, 0), 0.0)
