#!/usr/bin/env python3
"""Writes the shapes of this folder: 26 capital letters as single strokes and a dozen curves by formulas.

Each is a CSV file of points at equal distances along the stroke, and a problem file that asks for a six-bar. The strokes are our
own drawing: straight lines and circular arcs on a grid one unit high. Of a letter that cannot be drawn in one stroke some lines
are drawn twice. `generate.py --check` compares the files with what would be written, and changes nothing.
"""

import math
import sys
from pathlib import Path

HERE = Path(__file__).parent
POINTS = 80


def arc(cx, cy, rx, ry, begin, end, steps=240):
    """Points of an elliptic arc between two angles, degrees."""
    angles = [math.radians(begin + (end - begin) * i / steps) for i in range(steps + 1)]
    return [(cx + rx * math.cos(a), cy + ry * math.sin(a)) for a in angles]


def curve(x_of, y_of, begin, end, steps=2400):
    """Points of a curve by its parameter."""
    parameters = [begin + (end - begin) * i / steps for i in range(steps + 1)]
    return [(x_of(t), y_of(t)) for t in parameters]


def polar(radius_of, steps=2400):
    """Points of a closed curve by its radius in each direction."""
    angles = [2 * math.pi * i / steps for i in range(steps + 1)]
    return [(radius_of(a) * math.cos(a), radius_of(a) * math.sin(a)) for a in angles]


def stroke(*parts):
    """Joins points and lists of points."""
    line = []
    for part in parts:
        line.extend(part if isinstance(part, list) else [part])
    return line


LETTERS = {
    "A": (False, stroke((0, 0), (0.4, 1), (0.8, 0), (0.64, 0.4), (0.16, 0.4))),
    "B": (True, stroke((0, 0), (0, 1), (0.3, 1), arc(0.3, 0.76, 0.24, 0.24, 90, -90), arc(0.3, 0.26, 0.3, 0.26, 90, -90), (0, 0))),
    "C": (False, arc(0.5, 0.5, 0.45, 0.5, 45, 315)),
    "D": (True, stroke((0, 0), (0, 1), (0.2, 1), arc(0.2, 0.5, 0.5, 0.5, 90, -90), (0, 0))),
    "E": (False, stroke((0.55, 1), (0, 1), (0, 0.5), (0.53, 0.5), (0, 0.5), (0, 0), (0.6, 0))),
    "F": (False, stroke((0.6, 1), (0, 1), (0, 0.5), (0.5, 0.5), (0, 0.5), (0, 0))),
    "G": (False, stroke(arc(0.5, 0.5, 0.45, 0.5, 45, 360), (0.6, 0.5))),
    "H": (False, stroke((0, 1), (0, 0), (0, 0.5), (0.7, 0.5), (0.7, 1), (0.7, 0))),
    "I": (False, stroke((0, 1), (0, 0))),
    "J": (False, stroke((0.5, 1), (0.5, 0.25), arc(0.25, 0.25, 0.25, 0.25, 0, -180))),
    "K": (False, stroke((0, 1), (0, 0), (0, 0.42), (0.6, 1), (0.19, 0.6), (0.62, 0))),
    "L": (False, stroke((0, 1), (0, 0), (0.6, 0))),
    "M": (False, stroke((0, 0), (0.1, 1), (0.45, 0.3), (0.8, 1), (0.9, 0))),
    "N": (False, stroke((0, 0), (0, 1), (0.7, 0), (0.7, 1))),
    "O": (True, arc(0.45, 0.5, 0.45, 0.5, 90, 450)),
    "P": (False, stroke((0, 0), (0, 1), (0.3, 1), arc(0.3, 0.74, 0.26, 0.26, 90, -90), (0, 0.48))),
    "Q": (False, stroke(arc(0.45, 0.5, 0.45, 0.5, -50, 310), (0.6, 0.3), (0.9, -0.08))),
    "R": (False, stroke((0, 0), (0, 1), (0.3, 1), arc(0.3, 0.75, 0.25, 0.25, 90, -90), (0.2, 0.5), (0.6, 0))),
    "S": (False, stroke(arc(0.3, 0.75, 0.27, 0.25, 30, 270), arc(0.3, 0.25, 0.27, 0.25, 90, -150))),
    "T": (False, stroke((0, 1), (0.8, 1), (0.4, 1), (0.4, 0))),
    "U": (False, stroke((0, 1), (0, 0.32), arc(0.32, 0.32, 0.32, 0.32, 180, 360), (0.64, 1))),
    "V": (False, stroke((0, 1), (0.4, 0), (0.8, 1))),
    "W": (False, stroke((0, 1), (0.22, 0), (0.5, 0.75), (0.78, 0), (1, 1))),
    "X": (False, stroke((0, 1), (0.7, 0), (0.35, 0.5), (0.7, 1), (0, 0))),
    "Y": (False, stroke((0, 1), (0.4, 0.5), (0.8, 1), (0.4, 0.5), (0.4, 0))),
    "Z": (False, stroke((0, 1), (0.7, 1), (0, 0), (0.7, 0))),
}

OTHERS = {
    # Two circles, of which the inner one bites into the outer one.
    "moon": (True, stroke(arc(0, 0, 1, 1, 60, 300), arc(0.5, 0, 0.866, 0.866, 270, 90))),
    "triangle": (True, stroke((-1, -0.577), (1, -0.577), (0, 1.155), (-1, -0.577))),
    "hourglass": (True, stroke((-0.6, 1), (0.6, 1), (-0.6, -1), (0.6, -1), (-0.6, 1))),
    "trefoil": (True, polar(lambda a: 0.7 + 0.3 * math.cos(3 * a))),
    "clover": (True, polar(lambda a: 0.75 + 0.25 * math.cos(4 * a))),
    "arrow": (True, stroke((-1, 0.2), (0.2, 0.2), (0.2, 0.55), (1, 0), (0.2, -0.55), (0.2, -0.2), (-1, -0.2), (-1, 0.2))),
    "teardrop": (True, curve(lambda t: math.cos(t), lambda t: math.sin(t) * math.sin(t / 2) ** 1.5, 0, 2 * math.pi)),
    "bean": (True, polar(lambda a: 0.8 + 0.25 * math.sin(a) + 0.12 * math.cos(2 * a))),
    "house": (True, stroke((-0.7, 0), (0.7, 0), (0.7, 0.8), (0, 1.4), (-0.7, 0.8), (-0.7, 0))),
    "star": (True, polar(lambda a: 0.72 + 0.2 * math.cos(5 * a) + 0.05 * math.cos(10 * a))),
    "spiral": (False, curve(lambda t: t * math.cos(t) / 9, lambda t: t * math.sin(t) / 9, 3, 9)),
    "wave": (False, curve(lambda t: t / math.pi, lambda t: 0.35 * math.sin(2 * t), 0, 2 * math.pi)),
}

# The curves of the literature, whose points stand among its other problems: the name here, the name there, closed.
LITERATURE = HERE.parent / "literature" / "shapes"
CURVES = [
    ("square", "square", True),
    ("heart", "heart", True),
    ("figure-8", "figure-8", True),
    ("curve-D", "letter-D", True),
    ("curve-L", "L", True),
    ("curve-S", "S", False),
]


def evenly(line, closed):
    """POINTS points at equal distances along a polyline; of a closed one the first is not repeated."""
    along = [0.0]
    for (x, y), (u, v) in zip(line, line[1:]):
        along.append(along[-1] + math.hypot(u - x, v - y))
    count = POINTS if closed else POINTS - 1
    points, i = [], 0
    for k in range(POINTS):
        to = along[-1] * k / count
        while i + 2 < len(along) and along[i + 1] < to:
            i += 1
        length = along[i + 1] - along[i]
        share = (to - along[i]) / length if length > 0 else 0.0
        (x, y), (u, v) = line[i], line[i + 1]
        points.append((x + (u - x) * share, y + (v - y) * share))
    return points


def problem(name, file, closed, about):
    lines = [
        f"# {about}",
        "format = 1",
        f'name = "{name}"',
        "",
        "[task.path]",
        f'file = "{file}"',
        *(["closed = true"] if closed else []),
        "",
        "[design]",
        'mechanism = "six-bar"',
        "",
        "[require]",
        "transmission_deg_min = 30",
        "link_ratio_max = 100",
        "",
    ]
    return "\n".join(lines)


def files():
    """The name and the text of every file."""
    for name, (closed, line) in {**{f"letter-{k}": v for k, v in LETTERS.items()}, **OTHERS}.items():
        rows = "".join(f"{x:.6f},{y:.6f}\n".replace("-0.000000", "0.000000") for x, y in evenly(line, closed))
        yield f"{name}.csv", "x,y\n" + rows
        what = f"The letter {name[-1]} in one stroke" if name.startswith("letter-") else f"The shape '{name}'"
        yield f"{name}.toml", problem(name, f"{name}.csv", closed, f"{what}, by generate.py.")
    for name, there, closed in CURVES:
        yield f"{name}.csv", (LITERATURE / f"{there}.csv").read_text()
        yield f"{name}.toml", problem(name, f"{name}.csv", closed, "A curve of the literature on path synthesis.")


def main():
    check = sys.argv[1:] == ["--check"]
    wrong = []
    for name, text in files():
        path = HERE / name
        if not check:
            path.write_text(text)
        elif not path.is_file() or path.read_text() != text:
            wrong.append(name)
    if wrong:
        sys.exit(f"not as generate.py writes them: {', '.join(wrong)}")


if __name__ == "__main__":
    main()
