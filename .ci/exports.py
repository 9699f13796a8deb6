"""Exported files read by other people's programs: exports.py dxf|stl|openscad PROGRAM FOLDER.

The linkages: two shipped ones and four whose plates are awkward (P on the line C-D, P on C, coincident pivots,
P right of C-D in inches), each also with a kerf and other sizes. What is expected is computed here, from the JSON
export alone.
"""

import cmath
import json
import math
import re
import subprocess
import sys
from pathlib import Path

KIND, PROGRAM, FOLDER = sys.argv[1], sys.argv[2], Path(sys.argv[3])

AWKWARD = {
    "in-line": ("mm", [0, 0], [40, 10], 20, 50, 45, 30, 20, 1, 1),
    "on-c": ("cm", [1, -2], [4, 1], 2, 5, 5, 0, 5, 1, 1),
    "coincident": ("mm", [3, 3], [3, 3], 30, 10, 32, 12, 9, 1, 1),
    "right": ("in", [-1, 0.5], [2, 1], 1, 2.5, 2.75, 1.5, 2.25, 1, -1),
}


def linkages():
    for name in ("hoeken", "roberts"):
        yield Path("problems/linkages") / f"{name}.toml"
    for name, (unit, A, B, a, b, c, d, e, t1, t2) in AWKWARD.items():
        path = FOLDER / f"{name}.toml"
        path.write_text(
            f'format = 1\nunit = "{unit}"\n[linkage]\nA = {A}\nB = {B}\na = {a}\nb = {b}\nc = {c}\n'
            f"d = {d}\ne = {e}\nt1 = {t1}\nt2 = {t2}\n"
        )
        yield path


def export(linkage, form, **settings):
    out = FOLDER / f"{linkage.stem}.{form}"
    arguments = [PROGRAM, "export", str(linkage), "--format", form, "--out", str(out)]
    for key, value in settings.items():
        arguments += ["--set", f"{key}={value}"]
    subprocess.run(arguments, check=True, capture_output=True)
    return out


class Linkage:
    """A linkage in millimetres, its joints and the holes of its plates."""

    def __init__(self, path):
        data = json.loads(export(path, "json").read_text())
        mm = {"mm": 1, "cm": 10, "m": 1000, "in": 25.4, None: 1}[data.get("unit")]
        given = data["linkage"]
        self.A, self.B = (complex(*given[key]) * mm for key in "AB")
        self.a, self.b, self.c, self.d, self.e = (given[key] * mm for key in "abcde")
        self.t1, self.t2 = given["t1"], given["t2"]
        along = (self.b**2 + self.d**2 - self.e**2) / (2 * self.b)
        self.P = complex(along, self.t2 * math.sqrt(max(0, self.d**2 - along**2)))

    def joints(self, crank_deg):
        C = self.A + cmath.rect(self.a, math.radians(crank_deg))
        V = self.B - C
        s = abs(V)
        along = (s * s + self.b**2 - self.c**2) / (2 * s)
        D = C + V / s * complex(along, self.t1 * math.sqrt(self.b**2 - along**2))
        return {"A": self.A, "B": self.B, "C": C, "D": D, "P": C + (D - C) / self.b * self.P}

    def holes(self):
        near = lambda holes: [h for i, h in enumerate(holes) if all(abs(h - k) > 1e-6 for k in holes[:i])]
        g = abs(self.B - self.A)
        return {
            "ground": near([0, g]),
            "crank": [0, self.a],
            "coupler": near([0, self.b, self.P]),
            "follower": [0, self.c],
        }

    def area(self, link, reach, hole):
        """The rounded hull of the holes, less the holes (Steiner)."""
        holes = [complex(h) for h in self.holes()[link]]
        if len(holes) == 3:
            p, q, r = holes
            area = 0.5 * abs(((q - p).conjugate() * (r - p)).imag)
            around = abs(q - p) + abs(r - q) + abs(p - r)
        else:
            area, around = 0, 2 * abs(holes[-1] - holes[0])
        if len(holes) == 3 and area < 1e-9:
            around = 2 * max(abs(x - y) for x in holes for y in holes)
        return area + around * reach + math.pi * reach**2 - len(holes) * math.pi * hole**2 / 4


def same(x, y, tolerance=1e-9):
    assert abs(x - y) <= tolerance * max(1, abs(x), abs(y)), (x, y)


def check_dxf(path):
    import ezdxf
    from ezdxf import bbox

    linkage = Linkage(path)

    def read(file):
        document = ezdxf.readfile(file)
        auditor = document.audit()
        assert not auditor.errors and not auditor.fixes, (file, auditor.errors, auditor.fixes)
        assert document.units == ezdxf.units.MM
        box = bbox.extents(document.modelspace(), fast=False)
        # ezdxf's boxes of arcs are those of polygons.
        for told, drawn in ((document.header["$EXTMIN"], box.extmin), (document.header["$EXTMAX"], box.extmax)):
            assert max(abs(told[0] - drawn.x), abs(told[1] - drawn.y)) < 2e-2, (file, told, drawn)
        return document.modelspace()

    # A crank angle that is asked for, so that the joints are known.
    crank_deg = next(
        angle for angle in range(0, 360, 7)
        if abs(linkage.b - linkage.c) < abs(linkage.B - linkage.A - cmath.rect(linkage.a, math.radians(angle)))
        < linkage.b + linkage.c
    )
    space = read(export(path, "dxf", crank_deg=crank_deg, hole_mm=0.5))
    joints = linkage.joints(crank_deg)
    circles = [e for e in space.query("CIRCLE") if e.dxf.layer == "JOINTS"]
    assert len(circles) == 5 and all(e.dxf.radius == 0.25 for e in circles)
    for circle, at in zip(circles, joints.values()):
        same(complex(circle.dxf.center.x, circle.dxf.center.y), at)
    ends = [
        (complex(e.dxf.start.x, e.dxf.start.y), complex(e.dxf.end.x, e.dxf.end.y))
        for e in space.query("LINE[layer=='SKELETON']")
    ]
    bars = [("A", "B"), ("A", "C"), ("C", "D"), ("B", "D"), ("C", "P"), ("D", "P")]
    bars = [(joints[p], joints[q]) for p, q in bars if abs(joints[p] - joints[q]) > 1e-9]
    assert len(ends) == len(bars)
    for (start, end), (p, q) in zip(ends, bars):
        same(start, p)
        same(end, q)
    curves = space.query("LWPOLYLINE[layer=='CURVE']")
    assert curves and all(e.closed and len(e) > 300 for e in curves)
    # Every point of the curve is where some closed loop puts P: |CP| = d about the crank's circle.
    for x, y in (p[:2] for e in curves for p in e.get_points()):
        reach = abs(complex(x, y) - linkage.A)
        assert abs(linkage.a - linkage.d) - 1e-6 <= reach <= linkage.a + linkage.d + 1e-6

    for kerf in (0, 0.2):
        hole, margin, gap = 0.8, 1.1, 2.0
        space = read(export(path, "dxf-plates", hole_mm=hole, margin_mm=margin, kerf_mm=kerf, gap_mm=gap))
        boxes = []
        for link, holes in linkage.holes().items():
            layer = link.upper()
            contours = space.query(f"LWPOLYLINE[layer=='{layer}']")
            circles = space.query(f"CIRCLE[layer=='{layer}']")
            assert len(contours) == 1 and contours[0].closed and len(circles) == len(holes), (link, holes)
            centres = [complex(e.dxf.center.x, e.dxf.center.y) for e in circles]
            for circle in circles:
                same(circle.dxf.radius, (hole - kerf) / 2)
            for i, p in enumerate(centres):
                for j, q in enumerate(centres):
                    same(abs(p - q), abs(holes[i] - holes[j]))
            # The area inside the contour, its arcs by their bulges, is that of the grown plate.
            reach = hole / 2 + margin + kerf / 2
            points = list(contours[0].get_points("xyb"))
            area = 0
            for (x, y, bulge), (u, v, _) in zip(points, points[1:] + points[:1]):
                area += 0.5 * (x * v - u * y)
                angle = 4 * math.atan(bulge)
                if bulge:
                    chord = math.hypot(u - x, v - y)
                    radius = chord / (2 * math.sin(angle / 2))
                    same(radius, reach, 1e-7)
                    area += 0.5 * radius**2 * (angle - math.sin(angle))
            same(area, linkage.area(link, reach, 0), 1e-7)
            boxes.append(bbox.extents(list(contours)))
        names = space.query("LWPOLYLINE[layer=='MARK']")
        assert len(names) >= sum(map(len, linkage.holes().values())) and not any(e.closed for e in names)
        assert {e.dxf.layer for e in space} == {"GROUND", "CRANK", "COUPLER", "FOLLOWER", "MARK"}
        bare = read(export(path, "dxf-plates", hole_mm=hole, margin_mm=margin, kerf_mm=kerf, gap_mm=gap, marks="no"))
        assert len(bare) == len(space) - len(names)
        for i, one in enumerate(boxes):
            for other in boxes[:i]:
                apart = max(
                    one.extmin.x - other.extmax.x, other.extmin.x - one.extmax.x,
                    one.extmin.y - other.extmax.y, other.extmin.y - one.extmax.y,
                )
                # ezdxf's boxes of arcs are those of polygons.
                assert apart >= gap - 1e-3, apart


def bodies(file):
    import trimesh

    solids = re.split(r"(?m)^solid ", file.read_text())[1:]
    assert [s.split()[0] for s in solids] == ["ground", "crank", "coupler", "follower"]
    for text in solids:
        one = file.with_suffix(".one.stl")
        one.write_text("solid " + text)
        yield text.split()[0], trimesh.load_mesh(one)


def sound(mesh):
    assert mesh.is_watertight and mesh.is_winding_consistent and mesh.is_volume and mesh.euler_number % 2 == 0
    assert mesh.area_faces.min() > 0 and mesh.volume > 0


def check_stl(path):
    linkage = Linkage(path)
    for hole, chord in ((0.8, 0.001), (0.5, 0.0002)):
        reach, thickness = hole / 2 + 1.1, 1.5
        file = export(path, "stl", hole_mm=hole, margin_mm=1.1, thickness_mm=thickness, chord_mm=chord)
        for link, mesh in bodies(file):
            sound(mesh)
            # A plate with k holes has the Euler number 2 - 2k.
            assert mesh.euler_number == 2 - 2 * len(linkage.holes()[link]), link
            expected = linkage.area(link, reach, hole) * thickness
            edge = (2 * math.pi * (reach + 3 * hole)) * chord * thickness
            assert abs(mesh.volume - expected) <= edge + 1e-5 * expected, (link, mesh.volume, expected)
            assert abs(mesh.bounds[:, 2] - [0, thickness]).max() < 1e-6
    default = export(path, "stl")
    for _, mesh in bodies(default):
        sound(mesh)


def check_openscad(path):
    import trimesh

    linkage = Linkage(path)
    hole, margin, thickness, chord = 0.8, 1.1, 1.5, 0.01
    script = export(path, "scad", hole_mm=hole, margin_mm=margin, thickness_mm=thickness, chord_mm=chord)
    expected = sum(linkage.area(link, hole / 2 + margin, hole) for link in linkage.holes()) * thickness
    for view in ("plates", "assembly"):
        out = FOLDER / f"{path.stem}-{view}.stl"
        done = subprocess.run(
            ["openscad", "-o", str(out), "-D", f'view="{view}"', str(script)], capture_output=True, text=True
        )
        assert done.returncode == 0 and "WARNING" not in done.stderr, done.stderr
        mesh = trimesh.load_mesh(out)
        assert mesh.is_watertight
        assert mesh.body_count == 4, mesh.body_count
        assert abs(mesh.volume - expected) < 0.02 * expected, (mesh.volume, expected)


CHECK = {"dxf": check_dxf, "stl": check_stl, "openscad": check_openscad}[KIND]
count = 0
for path in linkages():
    CHECK(path)
    count += 1
print(f"{KIND}: {count} linkages, no complaint")
