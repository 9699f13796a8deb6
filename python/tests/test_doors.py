"""Everything that the command line does, against the command line."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from conftest import ARC, call

import linkwright as lw


@pytest.fixture(scope="module")
def saved(arc: lw.Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("results") / "arc"
    arc.save(place)
    return place


def test_verify_finds_what_was_changed(arc: lw.Result, tmp_path: Path) -> None:
    assert lw.verify(arc)
    changed = json.loads(arc.record_json)
    changed["candidates"][0]["error"]["rms"] = 0.5
    (tmp_path / "record.json").write_text(json.dumps(changed))
    found = lw.verify(tmp_path / "record.json")
    assert not found
    assert any(m["rank"] == 1 and "rms" in m["what"] for m in found.mismatches)
    assert "NOT true" in repr(found)


def test_analyze_is_that_of_the_command(arc: lw.Result, saved: Path, program: list[str]) -> None:
    said = call([*program, "analyze", str(saved), "--cycle", "7", "--omega", "2", "--json"])
    found = lw.analyze(arc, cycle=7, omega=2.0)
    assert found.data == json.loads(said.stdout)
    assert lw.analyze(saved, cycle=7, omega=2.0).data == found.data
    assert lw.analyze(arc.candidates[0].linkage, angle_deg=[0, 30.0]).data["configurations"][0]["rows"][1]["crank_deg"] == 30
    assert found.svg.startswith("<svg") or found.svg.startswith("<?xml")
    assert len(found.to_frame()) == 7


def test_cognates_trace_the_same_curve(arc: lw.Result) -> None:
    linkage = arc.candidates[0].linkage
    found = lw.cognates(arc)
    assert found == linkage.cognates() == lw.cognates(arc.candidates[0])
    for cognate in found:
        # The same curve: its extreme points, to what 0.5 degrees of the input leave.
        own, other = linkage.coupler_curve(0.1), cognate.coupler_curve(0.1)
        assert abs(own.max(axis=0) - other.max(axis=0)).max() < 1e-2 or other.shape != own.shape


def test_compare_is_that_of_the_command(arc: lw.Result, saved: Path, program: list[str]) -> None:
    said = call([*program, "compare", str(saved), "--json"])
    opened = lw.open(saved)
    assert lw.compare(opened).data == json.loads(said.stdout)
    first = opened.candidates[0]
    both = lw.compare(first, first.linkage, reference=first)
    assert len(both.data["candidates"] if "candidates" in both.data else both.to_frame()) == 2
    assert "<svg" in both._repr_html_()
    assert both.html.lower().startswith("<!doctype html>")
    assert len(lw.compare(first.linkage, target=lw.path(ARC)).to_frame()) == 1


def test_build_is_that_of_the_command(arc: lw.Result, saved: Path, program: list[str]) -> None:
    said = call([*program, "build", str(saved), "--hole", "0.1", "--margin", "0.1"])
    found = lw.build(arc, hole=0.1, margin=0.1)
    assert found.text in said.stdout
    assert found.data["hole"] == pytest.approx(0.1)
    assert len(found.data["sensitivity"]["dimensions"]) == 9
    assert lw.build(arc.candidates[0].linkage).data["distances"]


def test_snap_brings_lengths_to_the_stock(k18: lw.Result) -> None:
    snapped = lw.snap(k18, grid=0.05, snap=["a", "b"], keep=["A"], threads=2)
    best = snapped.candidates[0].linkage
    for length in (best.a, best.b):
        assert length / 0.05 == pytest.approx(round(length / 0.05), abs=1e-9)
    assert best.A == k18.candidates[0].linkage.A
    assert lw.verify(snapped).ok
    crank = k18.candidates[0].linkage.a
    stock = [0.98 * crank, 1.01 * crank]
    assert lw.snap(k18.candidates[0], lengths=stock, snap=["a"]).candidates[0].linkage.a in stock


@pytest.mark.parametrize("format", ["svg", "svg-plates", "dxf", "dxf-plates", "stl", "scad", "csv", "toml", "json", "cut-list", "cut-list-csv"])
def test_every_export_has_the_bytes_of_the_command(
    format: str, arc: lw.Result, saved: Path, program: list[str], tmp_path: Path
) -> None:
    assert format in lw.formats()
    file = tmp_path / "file"
    said = call([*program, "export", str(saved), "--format", format, "--set", "scale=20", "--out", str(file)])
    assert said.returncode == 0, said.stderr
    assert arc.export(format, scale=20) == file.read_bytes()
    arc.candidates[0].to_file(tmp_path / "mine", format, scale=20)
    assert (tmp_path / "mine").read_bytes() == file.read_bytes()


def test_pictures_are_made(arc: lw.Result, tmp_path: Path) -> None:
    assert arc.export("png", size_px=200)[:4] == b"\x89PNG"
    assert arc.export("gif", size_px=100, frames=3)[:3] == b"GIF"
    for name in ("arc.dxf", "arc.svg", "arc.stl", "arc.toml", "arc.txt"):
        arc.to_file(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 100
    arc.to_file(tmp_path / "report.html")
    assert "<svg" in (tmp_path / "report.html").read_text()
    assert lw.load(tmp_path / "arc.toml") == arc.candidates[0].linkage


def test_a_bound_is_proved(literature: Path, tmp_path: Path) -> None:
    found = lw.synth(literature / "k18.toml")
    told: list[dict[str, object]] = []
    proved = lw.certify(found, gap=0.9, time_limit_s=20, progress=told.append)
    assert found.certificate is None
    assert proved.certificate is not None
    assert proved.certificate["lower_bound"] <= found.candidates[0].error["sum_sq"]
    proved.save(tmp_path / "proved")
    assert (tmp_path / "proved" / "certificate.leaves").is_file()
    assert lw.verify(tmp_path / "proved").ok


def test_leaves_are_checked_as_by_the_command(root: Path, tmp_path: Path, program: list[str]) -> None:
    """The leaves of a proof, held or beside a record, show it; others, cut ones and none do not."""
    found = lw.synth(root / "problems" / "literature" / "k18.toml")
    with pytest.raises(lw.ProblemError, match="the record has no certificate; run certify with --leaves first"):
        lw.verify(found, leaves=True)
    proved = lw.certify(found, gap=0.9, time_limit_s=0.5)
    shown = lw.verify(proved, leaves=True)
    assert shown, shown
    assert shown.leaves is not None
    assert shown.leaves["leaves"] > 0
    assert shown.leaves["boxes"] >= shown.leaves["leaves"]
    assert lw.verify(proved).leaves is None
    place = tmp_path / "proved"
    proved.save(place)
    files = {path.name: path.read_bytes() for path in place.iterdir()}
    assert "certificate.leaves" in files
    lw.open(place).save(place)
    lw.open(place / "record.json").save(tmp_path / "again")
    for other in (place, tmp_path / "again"):
        assert {path.name: path.read_bytes() for path in other.iterdir()} == files
    assert lw.verify(place, leaves=True).leaves == lw.verify(place / "record.json", leaves=True).leaves == shown.leaves
    said = call([*program, "verify", str(place), "--leaves"])
    assert said.returncode == 0, said.stderr
    assert f"{shown.leaves['leaves']} leaves, {shown.leaves['boxes']}" in " ".join(said.stdout.split())
    leaves = place / "certificate.leaves"
    whole = leaves.read_bytes()
    leaves.write_bytes(whole[:-7])
    wrong = lw.verify(place, leaves=True)
    assert not wrong
    assert wrong.leaves is not None
    assert wrong.leaves["refuted"]
    assert "cut off" in wrong.leaves["text"]
    assert "NOT true: leaves: " in repr(wrong)
    for fault, words in ((b"something else", "certificate.leaves: these are no leaves"), (None, "there are no leaves")):
        leaves.write_bytes(fault) if fault else leaves.unlink()
        with pytest.raises(lw.ProblemError, match=words):
            lw.verify(place, leaves=True)
        said = call([*program, "verify", str(place), "--leaves"])
        assert said.returncode == 2
        assert words in said.stderr


def test_a_proof_that_was_stopped_goes_on(k18: lw.Result, tmp_path: Path, program: list[str]) -> None:
    first = lw.certify(k18, time_limit_s=0.5)
    then = lw.certify(first, time_limit_s=0.5, resume=True)
    assert first.certificate is not None
    assert then.certificate is not None
    assert not then.certificate["closed"]
    assert then.certificate["boxes"] > first.certificate["boxes"]
    assert then.certificate["lower_bound"] >= first.certificate["lower_bound"]
    # From the files of before, here and by the command; the proof says what its leaves show.
    place = tmp_path / "proof"
    then.save(place)
    said = call([*program, "certify", str(place), "--resume", "--quiet", "--set", "certify.time_limit_s=0.5"])
    assert said.returncode == 1, said.stderr
    opened = lw.open(place)
    assert opened.certificate is not None
    assert opened.certificate["boxes"] > then.certificate["boxes"]
    last = lw.certify(opened, time_limit_s=0.5, resume=True)
    assert last.certificate is not None
    assert last.certificate["boxes"] > opened.certificate["boxes"]
    assert lw.verify(last, leaves=True)
    # A proof that begins anew and proves less takes nothing away.
    less = lw.certify(last, time_limit_s=1e-9)
    assert less.certificate == last.certificate
    # What is of another proof, or was cut, is refused as by the command.
    with pytest.raises(lw.ProblemError, match=r"certificate\.checkpoint: this is of another result or another gap"):
        lw.certify(place, gap=0.5, time_limit_s=0.5, resume=True)
    checkpoint = place / "certificate.checkpoint"
    checkpoint.write_bytes(checkpoint.read_bytes()[:-9])
    with pytest.raises(lw.ProblemError, match="cut off"):
        lw.certify(place, time_limit_s=0.5, resume=True)
    # Where none was stopped it begins anew.
    checkpoint.unlink()
    assert lw.certify(place, gap=0.9, time_limit_s=0.5, resume=True).certificate is not None
    assert lw.certify(k18, gap=0.9, time_limit_s=0.5, resume=True).certificate is not None


def test_the_stock_can_be_a_file(k18: lw.Result, tmp_path: Path, program: list[str]) -> None:
    crank = k18.candidates[0].linkage.a
    bars = tmp_path / "bars.txt"
    bars.write_text(f"{0.98 * crank}, {1.01 * crank}\n{2 * crank}\n")
    stock = [0.98 * crank, 1.01 * crank, 2 * crank]
    found = lw.snap(k18, pitches=bars, snap=["a"])
    assert found.candidates[0].linkage.a in stock
    assert found.record["candidates"] == lw.snap(k18, lengths=stock, snap=["a"]).record["candidates"]
    k18.save(tmp_path / "k18")
    said = call([*program, "snap", str(tmp_path / "k18"), "--pitches", str(bars), "--snap", "a", "--out", str(tmp_path / "snapped")])
    assert (tmp_path / "snapped").is_dir(), said.stderr
    assert lw.open(tmp_path / "snapped").record["candidates"] == found.record["candidates"]
    bars.write_text("1\nlong\n")
    with pytest.raises(lw.ProblemError, match=r"bars\.txt: .*line 2: `long`"):
        lw.snap(k18, pitches=bars)
    with pytest.raises(lw.ProblemError, match=r"none\.txt: there is no such file"):
        lw.snap(k18, pitches=tmp_path / "none.txt")
    bars.write_text("1\n" * (1 << 20))
    with pytest.raises(lw.ProblemError, match="more than 1 MB"):
        lw.snap(k18, pitches=str(bars))
    for options in ({}, {"grid": 1.0, "pitches": bars}):
        with pytest.raises(lw.ProblemError, match="give the stock: one of grid, lengths and pitches"):
            lw.snap(k18, **options)  # type: ignore[arg-type]


def test_the_suite_runs() -> None:
    found = lw.suite("a6b", seeds=1)
    assert found.data["seeds"] == 1
    assert [p["name"] for p in found.data["problems"]]
    assert found.text
    assert found.markdown.startswith("#")


def test_the_suite_takes_motions(root: Path) -> None:
    found = lw.suite("lwg-36", seeds=1, problems=root / "problems" / "motion")
    (problem,) = found.data["problems"]
    assert problem["best_known_objective"] == lw.load_problem(root / "problems/motion/lwg-36.toml").best_known_objective
    assert problem["search"]["summary"]["hits"] == 1
    assert {p["method"] for p in problem["populations"]} == {"genetic", "differential-evolution"}
    assert found.data["collection"] == "motion"
    assert "problems=" in found.data["command"]
    assert "104.25085" in found.text
    assert found.markdown.startswith("# Problems in motion")


def test_exact_linkages_come_by_method(root: Path) -> None:
    files = [f for f in sorted((root / "problems").rglob("*.toml")) if 'method = "continuation"' in f.read_text()]
    assert files
    problem = lw.load_problem(files[0])
    assert problem.resolved["solve"]["method"] == "continuation"


def test_the_schema_is_that_of_the_command(program: list[str]) -> None:
    for kind in ("problem", "linkage", "record"):
        assert lw.schema(kind) == json.loads(call([*program, "schema", kind]).stdout)


def test_a_notebook_shows_drawing_and_table(arc: lw.Result) -> None:
    html = arc._repr_html_()
    assert "<svg" in html
    assert "<pre" in html
    assert "<script" not in html
    assert "arc" in repr(arc)
    assert "rms" in repr(arc.candidates[0])


def test_tables_are_frames(arc: lw.Result) -> None:
    frame = arc.to_frame()
    assert len(frame) == len(arc)
    assert frame["rms"].iloc[0] == pytest.approx(arc.candidates[0].error["rms"], rel=1e-6, abs=1e-15)


def test_drawings_and_animations_are_made(k18: lw.Result) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    ax = k18.plot()
    assert len(ax.lines) >= 3
    moving = k18.animate(frames=6)
    assert "<script" in moving.to_jshtml(fps=10)
    plt.close("all")


def test_the_command_is_installed(program: list[str]) -> None:
    said = call([*program, "--version"])
    assert said.stdout == f"linkwright {lw.__version__}\n"
    assert call([*program, "synth"]).returncode == 2
    assert "studio" in call([*program, "--help"]).stdout


def test_loads_give_torque_and_joint_forces(tmp_path: Path, program: list[str]) -> None:
    four_bar = lw.FourBar((0, 0), (80, 20), 30, 90, 80, 60, 60, unit="mm")
    loads = {"gravity": [0, -9.81], "body": {"crank": {"mass_kg": 2.0, "center": [10, 0]}}}
    rows = lw.analyze(four_bar, angle_deg=[0.0, 60.0], loads=loads).data["configurations"][0]["rows"]
    # A crank with its centre 10 mm from A: it takes m g r cos(phi) to hold it.
    torques = [row["loads"]["torque_N_m"] for row in rows]
    assert torques == pytest.approx([2.0 * 9.81 * 0.01, 2.0 * 9.81 * 0.01 * 0.5], rel=1e-12)

    # From files, as the command prints it.
    (tmp_path / "four-bar.toml").write_text(four_bar.to_toml())
    keys = 'format = 1\nunit = "mm"\n[loads]\ngravity = [0, -9.81]\n[loads.body.crank]\nmass_kg = 2.0\ncenter = [10, 0]\n'
    (tmp_path / "loads.toml").write_text(keys)
    options = [str(tmp_path / "four-bar.toml"), "--loads", str(tmp_path / "loads.toml"), "--json"]
    said = call([*program, "analyze", *options])
    found = lw.analyze(tmp_path / "four-bar.toml", loads=tmp_path / "loads.toml")
    assert json.loads(said.stdout) == found.data
    assert abs(found.data["loads"]["torque_peak_N_m"]["value"]) == pytest.approx(2.0 * 9.81 * 0.01, rel=1e-9)
    with pytest.raises(lw.ProblemError, match="crnk"):
        lw.analyze(four_bar, loads={"body": {"crnk": {"mass_kg": 1.0}}})
    with pytest.raises(lw.ProblemError, match="unit"):
        lw.analyze(lw.FourBar((0, 0), (4, 1), 2, 5, 5, 5, 5), loads={"gravity": [0, -9.81]})


def test_a_speed_over_the_crank_angle_comes_with_the_loads() -> None:
    four_bar = lw.FourBar((0, 0), (80, 20), 30, 90, 80, 60, 60, unit="mm")
    table = [[0, 60], [120, 90], [240, 70]]
    loads = {"speed_rpm": table, "body": {"crank": {"mass_kg": 0.0, "inertia_kg_m2": 2e-3}}}
    found = lw.analyze(four_bar, angle_deg=[0.0, 60.0, 120.0], loads=loads)
    rows = [row["loads"] for row in found.data["configurations"][0]["rows"]]
    assert [rows[0]["omega2_rad_s"], rows[2]["omega2_rad_s"]] == pytest.approx([2 * math.pi, 3 * math.pi])
    for row in rows:
        assert row["torque_N_m"] == pytest.approx(2e-3 * row["alpha2_rad_s2"], rel=1e-12)
    # Near the harmonic mean of the rows.
    assert found.data["loads"]["speed_over_turn"]["turn_s"] == pytest.approx(20 / 60 + 20 / 90 + 20 / 70, rel=5e-3)
    steady = lw.analyze(four_bar, angle_deg=[60.0], omega=3.0, loads=loads).data
    assert steady["omega2_rad_s"] == 3.0 and "speed_over_turn" not in steady["loads"]
    with pytest.raises(lw.ProblemError, match="follows from it"):
        lw.analyze(four_bar, alpha=1.0, loads=loads)
    with pytest.raises(lw.ProblemError, match="nowhere 0"):
        lw.analyze(four_bar, loads={"speed_rpm": [[0, 60], [180, 0]]})


def test_a_balance_is_that_of_the_command(tmp_path: Path, program: list[str]) -> None:
    lamp = lw.FourBar((0, 0), (500, 0), 300, 520, 400, 100, 450, unit="mm")
    arm = {"gravity": [0, -9.81], "body": {"crank": {"mass_kg": 1.0, "center": [300, 0]}}}
    held = lw.balance(lamp, spring=(("crank", (150, 0)), (0, 120)), over_deg=(20, 70), loads=arm)
    # k a b = m g r.
    assert held.data["spring"]["extension"]["rate_N_per_m"] == pytest.approx(163.5, rel=1e-9)
    assert "a spring that lets it stay" in held.text
    left = lw.analyze(lamp, angle_deg=[30.0, 60.0], loads=held.loads).data["configurations"][0]["rows"]
    assert [row["loads"]["torque_N_m"] for row in left] == pytest.approx([0.0, 0.0], abs=1e-9)

    # From a file with its loads, as the command prints it.
    keys = "[loads]\ngravity = [0, -9.81]\nspeed_rpm = 30\n[loads.body.crank]\nmass_kg = 1.0\ncenter = [300, 0]\n"
    (tmp_path / "lamp.toml").write_text(lamp.to_toml() + keys)
    commands: list[tuple[list[str], dict[str, Any]]] = [
        (["--spring", "crank:150,0", "0,120", "--over", "20,70"], {"spring": ("crank:150,0", "0,120"), "over_deg": (20, 70)}),
        (["--torsion", "crank", "--over", "20,70"], {"torsion": "crank", "over_deg": (20, 70)}),
    ]
    for options, asked in commands:
        said = call([*program, "balance", str(tmp_path / "lamp.toml"), *options, "--json"])
        assert json.loads(said.stdout) == lw.balance(tmp_path / "lamp.toml", **asked).data
    loaded = lw.FourBar((0, 0), (400, 0), 100, 350, 300, 200, 220, unit="mm")
    weight = {"gravity": [0, -9.81], "body": {"crank": {"mass_kg": 2.0, "center": [80, 0]}}}
    even = lw.balance(loaded, masses="crank", radius=50, loads=weight)
    assert even.data["ripple_percent"] < 1e-6
    assert even.data["masses"][0]["mass_kg"] * even.data["masses"][0]["distance_m"] == pytest.approx(0.16, rel=1e-6)
    refused: list[tuple[dict[str, Any], str]] = [
        ({}, "one of spring="),
        ({"spring": ("Q", (0, 1))}, "joints and points of this linkage"),
        ({"masses": "crank"}, "radius"),
        ({"masses": "crank", "radius": 5, "even": "noise"}, "shaking-force"),
        ({"spring": ("C", (0, 120)), "over_deg": (30, 30)}, "wider than 0"),
    ]
    for wrong, words in refused:
        with pytest.raises(lw.ProblemError, match=words):
            lw.balance(lamp, loads=arm, **wrong)
    with pytest.raises(lw.ProblemError, match="no loads to balance"):
        lw.balance(lamp, spring=("C", (0, 120)))


def test_shop_data_are_those_of_the_command(tmp_path: Path, program: list[str]) -> None:
    four_bar = lw.FourBar((0, 0), (80, 20), 30, 90, 80, 60, 60, unit="mm")
    shop = {"hole": 4, "margin": 5, "joint": {"B": {"hole_in": {"follower": 10}}}}
    keys = "[shop]\nhole = 4\nmargin = 5\n[shop.joint.B]\nhole_in = { follower = 10 }\n"
    (tmp_path / "four-bar.toml").write_text(four_bar.to_toml() + keys)
    (tmp_path / "shop.toml").write_text('format = 1\nunit = "mm"\n' + keys)
    own = lw.build(tmp_path / "four-bar.toml")
    assert own.data["hole"] == 4 and own.data["margin"] == 5
    assert lw.build(four_bar, shop=shop).data == own.data == lw.build(four_bar, shop=tmp_path / "shop.toml").data
    assert lw.build(four_bar, shop=shop, hole=3).data["hole"] == 3
    said = call([*program, "export", str(tmp_path / "four-bar.toml"), "--format", "cut-list"])
    assert lw.export(tmp_path / "four-bar.toml", "cut-list").decode() == said.stdout
    assert lw.export(four_bar, "cut-list", shop=shop) != lw.export(four_bar, "cut-list")
    with pytest.raises(lw.ProblemError, match="hole_in"):
        lw.build(four_bar, shop={"joint": {"B": {"hole_of": 3}}})
    with pytest.raises(lw.ProblemError, match="no holes"):
        lw.export(four_bar, "csv", shop=shop)
