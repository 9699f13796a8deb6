"""Exported files read by other people's programs: exports.py dxf|stl|openscad PROGRAM FOLDER.

The linkages: two shipped four-bars and four whose plates are awkward (P on the line C-D, P on C, coincident pivots,
P right of C-D in inches); of either kind of slider a shipped one and two others (the rail slants, crank and slider are in
line, P lies in the slot, the block is behind the crank pin); a shipped six-bar, and one with a third pivot, its crank a
triangle. Each also with a kerf and other sizes, and with shop data: holes of their own at A, C and P, a wide crank, a thick
coupler. What is expected is computed here, from the JSON export alone; the slot
from 36,000 positions of a turn.
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


SLIDERS = {
    "slider-slant": ("slider_crank", "in", {"A": [1, 2], "a": 1, "b": 3.5, "line_point": [0, 3], "line_deg": 130,
                     "coupler_x": -1, "coupler_y": -1.5, "t1": -1}),
    "slider-in-line": ("slider_crank", "mm", {"A": [0, 0], "a": 20, "b": 60, "line_point": [5, 0], "line_deg": 0,
                       "coupler_x": 30, "coupler_y": 0, "t1": 1}),
    "inverted-behind": ("inverted_slider_crank", "mm", {"A": [0, 0], "B": [50, 40], "a": 15, "offset": -12,
                        "coupler_x": 20, "coupler_y": -30, "t1": -1}),
    "inverted-straight": ("inverted_slider_crank", "cm", {"A": [0, 0], "B": [6, 0], "a": 2, "offset": 0,
                          "coupler_x": 10, "coupler_y": 4, "t1": 1}),
}


def sliders():
    for name in ("slider-crank", "inverted-slider-crank"):
        yield Path("problems/linkages") / f"{name}.toml"
    for name, (table, unit, keys) in SLIDERS.items():
        path = FOLDER / f"{name}.toml"
        lines = "".join(f"{key} = {value}\n" for key, value in keys.items())
        path.write_text(f'format = 1\nunit = "{unit}"\n[{table}]\n{lines}')
        yield path


def several_loops():
    yield Path("problems/linkages/watt-six-bar.toml")
    yield Path("tests/corpora/linkage/eight-bar.toml")


def export(linkage, form, shop=None, **settings):
    out = FOLDER / f"{linkage.stem}.{form}"
    arguments = [PROGRAM, "export", str(linkage), "--format", form, "--out", str(out)]
    arguments += ["--shop", str(shop)] if shop else []
    for key, value in settings.items():
        arguments += ["--set", f"{key}={value}"]
    subprocess.run(arguments, check=True, capture_output=True)
    return out


MM = {"mm": 1, "cm": 10, "m": 1000, "in": 25.4, None: 1}


def hull(points):
    """The corners of the convex hull, counter-clockwise (Andrew's monotone chain)."""
    cross = lambda o, p, q: ((p - o).conjugate() * (q - o)).imag
    order = sorted(set(points), key=lambda z: (z.real, z.imag))
    chains = []
    for run in (order, order[::-1]):
        chain = []
        for p in run:
            while len(chain) > 1 and cross(chain[-2], chain[-1], p) <= 1e-9:
                chain.pop()
            chain.append(p)
        chains.append(chain[:-1])
    return chains[0] + chains[1]


class Linkage:
    """A linkage in millimetres, its joints and the holes of its plates."""

    bars = [("A", "B"), ("A", "C"), ("C", "D"), ("B", "D"), ("C", "P"), ("D", "P")]

    def slot(self, link, hole, margin):
        """The two ends of a plate's slot; a four-bar has none."""
        return None

    def __init__(self, path):
        data = json.loads(export(path, "json").read_text())
        mm = MM[data.get("unit")]
        given = data["linkage"]
        self.A, self.B = (complex(*given[key]) * mm for key in "AB")
        self.a, self.b, self.c, self.d, self.e = (given[key] * mm for key in "abcde")
        self.t1, self.t2 = given["t1"], given["t2"]
        along = (self.b**2 + self.d**2 - self.e**2) / (2 * self.b)
        self.P = complex(along, self.t2 * math.sqrt(max(0, self.d**2 - along**2)))

    def reaches(self, crank_deg):
        C = self.A + cmath.rect(self.a, math.radians(crank_deg))
        return abs(self.b - self.c) < abs(self.B - C) < self.b + self.c

    def can_be_at(self, p):
        """Every point of the curve is where some closed loop puts P: |CP| = d about the crank's circle."""
        return abs(self.a - self.d) - 1e-6 <= abs(p - self.A) <= self.a + self.d + 1e-6

    def joints(self, crank_deg):
        C = self.A + cmath.rect(self.a, math.radians(crank_deg))
        V = self.B - C
        s = abs(V)
        along = (s * s + self.b**2 - self.c**2) / (2 * s)
        D = C + V / s * complex(along, self.t1 * math.sqrt(self.b**2 - along**2))
        return {"A": self.A, "B": self.B, "C": C, "D": D, "P": C + (D - C) / self.b * self.P}

    def holes(self, hole=0.8, margin=1.1):
        near = lambda holes: [h for i, h in enumerate(holes) if all(abs(h - k) > 1e-6 for k in holes[:i])]
        g = abs(self.B - self.A)
        return {
            "ground": near([0, g]),
            "crank": [0, self.a],
            "coupler": near([0, self.b, self.P]),
            "follower": [0, self.c],
        }

    def area(self, link, reach, hole, margin=1.1):
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


class Slider:
    """A linkage with a slider in millimetres: its joints, and the holes and the slot of its plates."""

    def __init__(self, path):
        data = json.loads(export(path, "json").read_text())
        mm, given = MM[data.get("unit")], data["linkage"]
        self.rail = given["kind"] == "slider-crank"
        at = lambda key: complex(*given[key]) * mm
        self.A, self.a, self.t1 = at("A"), given["a"] * mm, given["t1"]
        self.Z = complex(given["coupler_x"], given["coupler_y"]) * mm
        if self.rail:
            self.b, self.Q = given["b"] * mm, at("line_point")
            self.s = cmath.rect(1, math.radians(given["line_deg"]))
            self.bars = [("A", "C"), ("C", "D"), ("C", "P"), ("D", "P")]
        else:
            self.B, self.h = at("B"), given["offset"] * mm
            self.bars = [("A", "B"), ("A", "C"), ("C", "P")] + ([("B", "D")] if self.h else [])
        places = [self.at(k / 100)[1] for k in range(36000)]
        self.travel = min(places), max(places)

    def at(self, crank_deg):
        """C, the slider's place and the direction of the coupler."""
        C = self.A + cmath.rect(self.a, math.radians(crank_deg))
        if self.rail:
            q = (C - self.Q) * self.s.conjugate()
            place = q.real + self.t1 * math.sqrt(self.b**2 - q.imag**2)
            return C, place, (self.Q + place * self.s - C) / self.b
        V = self.B - C
        place = self.t1 * math.sqrt(abs(V) ** 2 - self.h**2)
        return C, place, V / complex(place, self.h)

    def reaches(self, crank_deg):
        return True

    def can_be_at(self, p):
        return abs(self.a - abs(self.Z)) - 1e-6 <= abs(p - self.A) <= self.a + abs(self.Z) + 1e-6

    def joints(self, crank_deg):
        C, place, u = self.at(crank_deg)
        D = self.Q + place * self.s if self.rail else C + place * u
        second = {} if self.rail else {"B": self.B}
        third = {"D": D}
        return {"A": self.A, **second, "C": C, **third, "P": C + u * self.Z}

    def half(self, hole, margin):
        """Half the distance of the guide pins."""
        return hole + margin if self.rail else max(hole + margin, abs(self.h) / 4)

    def slot(self, link, hole, margin):
        if link != ("ground" if self.rail else "coupler"):
            return None
        more = self.half(hole, margin) + hole / 2
        origin = (self.Q - self.A) * self.s.conjugate() if self.rail else 0
        return [origin + self.travel[0] - more, origin + self.travel[1] + more]

    def holes(self, hole=0.8, margin=1.1):
        half = self.half(hole, margin)
        if self.rail:
            return {
                "ground": [0],
                "crank": [0, self.a],
                "coupler": [0, self.b, self.Z],
                "block": [0, -half, half],
            }
        low, high = self.slot("coupler", hole, margin)
        beside = complex(max(low - self.Z.real, 0, self.Z.real - high), self.Z.imag)
        return {
            "ground": [0, abs(self.B - self.A)],
            "crank": [0, self.a],
            "coupler": [0] + ([self.Z] if abs(beside) >= 1.5 * hole else []),
            "block": [1j * self.h, -half, half],
        }

    def area(self, link, reach, hole, margin=1.1):
        """The rounded hull of holes, slot and P, less the holes and the slot."""
        width = hole or 0.8
        holes, slot = self.holes(width, margin)[link], self.slot(link, width, margin) or []
        corners = hull([complex(z) for z in holes + slot + ([self.Z] if link == "coupler" else [])])
        pairs = list(zip(corners, corners[1:] + corners[:1]))
        area = sum(0.5 * (p.conjugate() * q).imag for p, q in pairs)
        around = sum(abs(q - p) for p, q in pairs)
        taken = len(holes) * math.pi * hole**2 / 4
        if slot:
            taken += abs(slot[1] - slot[0]) * hole + math.pi * hole**2 / 4
        return area + around * reach + math.pi * reach**2 - taken


class Chain:
    """A six-bar or an eight-bar in millimetres: its joints, and the holes of its plates."""

    names = ("coupler", "follower", "link5", "link6", "link7", "link8")

    def __init__(self, path):
        data = json.loads(export(path, "json").read_text())
        mm = MM[data.get("unit")]
        keys = data["linkage"]["chain"]
        self.pivots = {name: complex(*at) * mm for name, at in keys["pivots"].items()}
        self.crank = keys["crank"]["length"] * mm
        self.dyads = [(d["joint"], d["from"], [x * mm for x in d["lengths"]], d["side"]) for d in keys["dyad"]]
        self.points = {p["name"]: (tuple(p["on"]), complex(*p["at"]) * mm) for p in keys["point"]}
        # Every link with its line and the places of its holes along and across that.
        self.links = {"crank": (("A", "C"), [("A", 0), ("C", self.crank)])}
        for j, (joint, ends, lengths, _) in enumerate(self.dyads):
            for end, length, name in zip(ends, lengths, self.names[2 * j :]):
                self.links[name] = ((end, joint), [(end, 0), (joint, length)])
        for name, (on, at) in self.points.items():
            next(holes for line, holes in self.links.values() if line == on).append((name, at))
        self.path = [self.joints(k / 100)["P"] for k in range(36000)]

    def slot(self, link, hole, margin):
        return None

    def reaches(self, crank_deg):
        return True

    def joints(self, crank_deg):
        at = dict(self.pivots)
        at["C"] = at["A"] + cmath.rect(self.crank, math.radians(crank_deg))
        dyads, points = list(self.dyads), dict(self.points)
        while dyads or points:
            for name, ((p, q), own) in list(points.items()):
                if p in at and q in at:
                    at[name] = at[p] + (at[q] - at[p]) / abs(at[q] - at[p]) * own
                    del points[name]
            if dyads and all(end in at for end in dyads[0][1]):
                joint, (p, q), (l1, l2), side = dyads.pop(0)
                V = at[q] - at[p]
                s = abs(V)
                along = (s * s + l1**2 - l2**2) / (2 * s)
                at[joint] = at[p] + V / s * complex(along, side * math.sqrt(l1**2 - along**2))
        return at

    def can_be_at(self, p):
        return min(abs(p - q) for q in self.path[:: 50]) < max(abs(p - q) for p, q in zip(self.path, self.path[50:]))

    @property
    def bars(self):
        """The sides of the links, between their corners; the lines between fixed pivots."""
        pivots, at = list(self.pivots), self.joints(7)
        sides = set(map(frozenset, zip(pivots, pivots[1:]))) | {frozenset(("A", "C"))}
        for _, holes in self.links.values():
            of = {at[name]: name for name, _ in holes}
            corners = hull(list(of))
            sides |= {frozenset((of[p], of[q])) for p, q in zip(corners, corners[1:] + corners[:1])}
        return [tuple(side) for side in sides]

    def holes(self, hole=0.8, margin=1.1):
        origin = self.pivots["A"]
        ground = [at - origin for at in self.pivots.values()]
        return {"ground": ground} | {link: [at for _, at in holes] for link, (_, holes) in self.links.items()}

    def area(self, link, reach, hole, margin=1.1):
        """The rounded hull of the holes, less the holes (Steiner)."""
        holes = self.holes()[link]
        corners = hull([complex(z) for z in holes])
        pairs = list(zip(corners, corners[1:] + corners[:1]))
        area = sum(0.5 * (p.conjugate() * q).imag for p, q in pairs)
        around = sum(abs(q - p) for p, q in pairs)
        return area + around * reach + math.pi * reach**2 - len(holes) * math.pi * hole**2 / 4


def kind_of(path):
    text = path.read_text()
    return Chain if "[chain]" in text else Slider if "slider_crank]" in text else Linkage


def same(x, y, tolerance=1e-9):
    assert abs(x - y) <= tolerance * max(1, abs(x), abs(y)), (x, y)


def check_dxf(path):
    import ezdxf
    from ezdxf import bbox

    linkage = kind_of(path)(path)

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
    crank_deg = next(angle for angle in range(0, 360, 7) if linkage.reaches(angle))
    space = read(export(path, "dxf", crank_deg=crank_deg, hole_mm=0.5))
    joints = linkage.joints(crank_deg)
    circles = [e for e in space.query("CIRCLE") if e.dxf.layer == "JOINTS"]
    drawn = {name: at for name, at in joints.items() if name != "D" or not hasattr(linkage, "h")}
    assert len(circles) == len(drawn) and all(e.dxf.radius == 0.25 for e in circles)
    centres = [complex(circle.dxf.center.x, circle.dxf.center.y) for circle in circles]
    if isinstance(linkage, Chain):
        # In an order of their own.
        centres = [min(centres, key=lambda centre: abs(centre - at)) for at in drawn.values()]
    for centre, at in zip(centres, drawn.values()):
        same(centre, at)
    ends = [
        (complex(e.dxf.start.x, e.dxf.start.y), complex(e.dxf.end.x, e.dxf.end.y))
        for e in space.query("LINE[layer=='SKELETON']")
    ]
    bars = [(joints[p], joints[q]) for p, q in linkage.bars if abs(joints[p] - joints[q]) > 1e-9]
    if isinstance(linkage, Chain):
        # The sides of a link in the order of its hull, from whichever corner; the crank has its line beside its triangle.
        near = lambda one, other: all(min(abs(z - w) for w in other) < 1e-6 for z in one)
        assert all(any(near(bar, line) for line in ends) for bar in bars) and len(ends) <= len(bars) + 1
        assert all(any(near(line, bar) for bar in bars) for line in ends)
    else:
        assert len(ends) == len(bars)
        for (start, end), (p, q) in zip(ends, bars):
            same(start, p)
            same(end, q)
    curves = space.query("LWPOLYLINE[layer=='CURVE']")
    assert curves and all(e.closed and len(e) > 300 for e in curves)
    assert all(linkage.can_be_at(complex(*p[:2])) for e in curves for p in e.get_points())
    if isinstance(linkage, Slider):
        slot, block = space.query("LWPOLYLINE[layer=='SLIDER']")
        assert slot.closed and len(slot) == 4 and block.closed and len(block) == 4
        assert len(space.query("LINE[layer=='SLIDER']")) == 1

    for kerf in (0, 0.2):
        hole, margin, gap = 0.8, 1.1, 2.0
        space = read(export(path, "dxf-plates", hole_mm=hole, margin_mm=margin, kerf_mm=kerf, gap_mm=gap))
        boxes = []
        for link, holes in linkage.holes(hole, margin).items():
            layer, slot = link.upper(), linkage.slot(link, hole, margin)
            contours = space.query(f"LWPOLYLINE[layer=='{layer}']")
            circles = space.query(f"CIRCLE[layer=='{layer}']")
            assert len(contours) == 1 + bool(slot) and all(e.closed for e in contours), (link, slot)
            assert len(circles) == len(holes), (link, holes)
            if slot:
                # Two sides and two half circles; its ends lie where the travel of the block puts them.
                points = list(contours[1].get_points("xyb"))
                bulges = [bulge for _, _, bulge in points]
                assert len(points) == 4 and bulges.count(0) == 2
                assert all(abs(b - 1) < 1e-12 for b in bulges if b)
                corners = [complex(x, y) for x, y, _ in points]
                ends = [(p + q) / 2 for p, q, b in zip(corners, corners[1:] + corners[:1], bulges) if b]
                wide = [abs(p - q) for p, q, b in zip(corners, corners[1:] + corners[:1], bulges) if b]
                all(same(w, hole - kerf) for w in wide)
                at = complex(circles[0].dxf.center.x, circles[0].dxf.center.y)
                told = sorted(abs(end - at) for end in ends)
                for one, other in zip(told, sorted(abs(end - holes[0]) for end in slot)):
                    same(one, other, 1e-6)
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
            same(area, linkage.area(link, reach, 0), 1e-6)
            boxes.append(bbox.extents([contours[0]]))
        names = space.query("LWPOLYLINE[layer=='MARK']")
        assert len(names) >= sum(map(len, linkage.holes().values())) and not any(e.closed for e in names)
        assert {e.dxf.layer for e in space} == {link.upper() for link in linkage.holes()} | {"MARK"}
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


def bodies(file, links):
    import trimesh

    solids = re.split(r"(?m)^solid ", file.read_text())[1:]
    assert [s.split()[0] for s in solids] == list(links)
    for text in solids:
        one = file.with_suffix(".one.stl")
        one.write_text("solid " + text)
        yield text.split()[0], trimesh.load_mesh(one)


def sound(mesh):
    assert mesh.is_watertight and mesh.is_winding_consistent and mesh.is_volume and mesh.euler_number % 2 == 0
    assert mesh.area_faces.min() > 0 and mesh.volume > 0


def check_stl(path):
    linkage = kind_of(path)(path)
    for hole, chord in ((0.8, 0.001), (0.5, 0.0002)):
        reach, thickness = hole / 2 + 1.1, 1.5
        file = export(path, "stl", hole_mm=hole, margin_mm=1.1, thickness_mm=thickness, chord_mm=chord)
        for link, mesh in bodies(file, linkage.holes()):
            sound(mesh)
            # A plate with k holes has the Euler number 2 - 2k; a slot is one, too.
            slot = linkage.slot(link, hole, 1.1)
            assert mesh.euler_number == 2 - 2 * (len(linkage.holes(hole)[link]) + bool(slot)), link
            expected = linkage.area(link, reach, hole) * thickness
            edge = (2 * math.pi * (reach + 3 * hole)) * chord * thickness
            assert abs(mesh.volume - expected) <= edge + 1e-5 * expected, (link, mesh.volume, expected)
            assert abs(mesh.bounds[:, 2] - [0, thickness]).max() < 1e-6
    default = export(path, "stl")
    for _, mesh in bodies(default, linkage.holes()):
        sound(mesh)


def check_openscad(path):
    import trimesh

    linkage = kind_of(path)(path)
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
        assert mesh.body_count == len(linkage.holes()), mesh.body_count
        assert abs(mesh.volume - expected) < 0.02 * expected, (mesh.volume, expected)


class Shop:
    """Shop data in mm: diameters by joint and link, the radius and the thickness of each plate."""

    hole, margin, thickness = 0.8, 1.1, 1.5
    own = {("A", "crank"): 1.0, ("A", "ground"): 1.6, "C": 0.9, "P": 0.6}

    def __init__(self):
        self.path = FOLDER / "sizes.shop.toml"
        self.path.write_text(
            'format = 1\nunit = "cm"\n[shop]\nhole = 0.08\nmargin = 0.11\nthickness = 0.15\n'
            "[shop.joint.A]\nhole_in = { crank = 0.1, ground = 0.16 }\n"
            "[shop.joint.C]\nhole = 0.09\n[shop.joint.P]\nhole = 0.06\n"
            "[shop.body.crank]\nwidth = 0.42\n[shop.body.coupler]\nthickness = 0.25\n"
        )

    def names(self, linkage, link):
        """The joints of a plate's holes, in the order of the drawing."""
        if isinstance(linkage, Chain):
            return list(linkage.pivots) if link == "ground" else [name for name, _ in linkage.links[link][1]]
        rail = isinstance(linkage, Slider) and linkage.rail
        four_bar = isinstance(linkage, Linkage)
        return {
            "ground": "A" if rail else "AB",
            "crank": "AC",
            "coupler": "CDP" if four_bar or rail else "CP",
            "follower": "BD",
            "block": ("D" if rail else "B") + "EF",
        }[link]

    def holes(self, linkage, link):
        """The centres of a plate's holes with their diameters; joints at one place have the largest of their own."""
        places = self.places(linkage, link)
        found = []
        for name, at in zip(self.names(linkage, link), places):
            here = next((hole for hole in found if abs(hole[0] - at) < 1e-6), None)
            own = self.own.get((name, link), self.own.get(name))
            if here is None:
                found.append([at, own])
            elif own is not None:
                here[1] = max(here[1] or 0, own)
        return [(at, own or self.hole) for at, own in found]

    def places(self, linkage, link):
        if isinstance(linkage, Linkage):
            g = abs(linkage.B - linkage.A)
            return {
                "ground": [0, g], "crank": [0, linkage.a], "coupler": [0, linkage.b, linkage.P],
                "follower": [0, linkage.c],
            }[link]
        return linkage.holes(self.hole, self.margin)[link]

    def reach(self, linkage, link):
        if link == "crank":
            return 2.1
        return max([self.hole] + [d for _, d in self.holes(linkage, link)]) / 2 + self.margin

    def thick(self, link):
        return 2.5 if link == "coupler" else self.thickness

    def area(self, linkage, link):
        """The area of a plate without its holes and its slot."""
        taken = sum(math.pi * d**2 / 4 for _, d in self.holes(linkage, link))
        slot = linkage.slot(link, self.hole, self.margin)
        if slot:
            taken += abs(slot[1] - slot[0]) * self.hole + math.pi * self.hole**2 / 4
        return linkage.area(link, self.reach(linkage, link), 0) - taken

    def volume(self, linkage):
        return sum(self.area(linkage, link) * self.thick(link) for link in linkage.holes())


def check_shop_dxf(path):
    import ezdxf

    linkage, shop = kind_of(path)(path), Shop()
    for kerf in (0, 0.2):
        document = ezdxf.readfile(export(path, "dxf-plates", shop=shop.path, kerf_mm=kerf))
        auditor = document.audit()
        assert not auditor.errors and not auditor.fixes, (path, auditor.errors, auditor.fixes)
        space = document.modelspace()
        for link in linkage.holes(shop.hole, shop.margin):
            circles = list(space.query(f"CIRCLE[layer=='{link.upper()}']"))
            holes = shop.holes(linkage, link)
            assert len(circles) == len(holes), (path, link)
            centres = [complex(c.dxf.center.x, c.dxf.center.y) for c in circles]
            for i, (at, diameter) in enumerate(holes):
                same(circles[i].dxf.radius, (diameter - kerf) / 2)
                for j, (there, _) in enumerate(holes):
                    same(abs(centres[i] - centres[j]), abs(at - there))
            contour = space.query(f"LWPOLYLINE[layer=='{link.upper()}']")[0]
            points = list(contour.get_points("xyb"))
            arcs = [(p, q) for p, q in zip(points, points[1:] + points[:1]) if p[2]]
            radii = {
                round(math.hypot(q[0] - p[0], q[1] - p[1]) / (2 * math.sin(2 * math.atan(p[2]))), 6) for p, q in arcs
            }
            assert radii == {round(shop.reach(linkage, link) + kerf / 2, 6)}, (path, link, radii)
    crank_deg = next(angle for angle in range(0, 360, 7) if linkage.reaches(angle))
    document = ezdxf.readfile(export(path, "dxf", shop=shop.path, crank_deg=crank_deg))
    radii = sorted(round(c.dxf.radius, 9) for c in document.modelspace().query("CIRCLE[layer=='JOINTS']"))
    joints = [name for name in linkage.joints(crank_deg) if name != "D" or not hasattr(linkage, "h")]
    # What stands at a joint: at A the smaller of its two holes.
    drawn = {"A": 1.0, "C": 0.9, "P": 0.6}
    assert radii == sorted(round(drawn.get(name, 0.8) / 2, 9) for name in joints), (path, radii)


def check_shop_stl(path):
    linkage, shop = kind_of(path)(path), Shop()
    chord = 0.0005
    for link, mesh in bodies(export(path, "stl", shop=shop.path, chord_mm=chord), linkage.holes()):
        sound(mesh)
        expected = shop.area(linkage, link) * shop.thick(link)
        around = 2 * math.pi * shop.reach(linkage, link) + 8 * math.pi
        assert abs(mesh.volume - expected) <= around * chord * shop.thick(link) + 1e-5 * expected, (path, link)
        assert abs(mesh.bounds[:, 2] - [0, shop.thick(link)]).max() < 1e-6


def check_shop_openscad(path):
    import trimesh

    linkage, shop = kind_of(path)(path), Shop()
    script = export(path, "scad", shop=shop.path, chord_mm=0.01)
    for view in ("plates", "assembly"):
        out = FOLDER / f"{path.stem}-shop-{view}.stl"
        done = subprocess.run(
            ["openscad", "-o", str(out), "-D", f'view="{view}"', str(script)], capture_output=True, text=True
        )
        assert done.returncode == 0 and "WARNING" not in done.stderr, done.stderr
        mesh, expected = trimesh.load_mesh(out), shop.volume(linkage)
        assert mesh.is_watertight and mesh.body_count == len(linkage.holes()), (path, view, mesh.body_count)
        assert abs(mesh.volume - expected) < 0.02 * expected, (path, view, mesh.volume, expected)


SHOP = {"dxf": check_shop_dxf, "stl": check_shop_stl, "openscad": check_shop_openscad}[KIND]
CHECK = {"dxf": check_dxf, "stl": check_stl, "openscad": check_openscad}[KIND]
count = 0
for path in (*linkages(), *sliders(), *several_loops()):
    CHECK(path)
    SHOP(path)
    count += 1
print(f"{KIND}: {count} linkages, each without and with shop data, no complaint")
