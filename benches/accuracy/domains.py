"""Exact boundaries of the benchmark's domains, read from HOHQMesh control files without quadrel's help.

Reads what these files use: lines, circular arcs, equations and cubic splines. For Gmsh every curve becomes a curve of
OpenCASCADE that is the same but for rounding: lines, circles, Bezier curves (polynomial equations) and B-splines.
"""

import math
import re
from pathlib import Path

import numpy as np
from scipy.interpolate import BSpline
from scipy.spatial import cKDTree

# The domains of the benchmarks, in tests/domains.
DOMAINS = (
    "mech/unit-circle",
    "hohq/GingerbreadMan",
    "hohq/Pill",
    "hohq/NACA0012",
    "hohq/ABAQUS_IceCreamCone",
    "mech/turek-hron-fsi",
)
# Samples of a curve from which Newton's iteration finds the nearest point.
SAMPLES = 20000
# Samples that it starts from: where curves meet, the nearest one may lie on the wrong side of the joint.
STARTS = 3
# Largest gap between points along a curve, as a share of its length, at which they are said to follow it.
NEAR = 0.1
# Largest degree of a polynomial equation.
DEGREE = 12


class Curve:
    """`point` and its derivative on [0, 1]; `add` makes it curves of Gmsh's kernel between two of its points."""

    def __init__(self, point, add):
        self.point, self._add = point, add

    def add(self, kernel, start, end):
        added = self._add(kernel, start, end)
        return added if isinstance(added, list) else [added]

    def derivative(self, t):
        step = 1e-6
        low, high = np.clip(t - step, 0, 1), np.clip(t + step, 0, 1)
        return (self.point(high) - self.point(low)) / (high - low)[..., None]


def line(start, end):
    start, end = np.array(start), np.array(end)
    return Curve(lambda t: start + np.asarray(t)[..., None] * (end - start), lambda kernel, a, b: kernel.addLine(a, b))


def arc(center, radius, start, end):
    def point(t):
        angle = start + np.asarray(t) * (end - start)
        return np.stack([center[0] + radius * np.cos(angle), center[1] + radius * np.sin(angle)], axis=-1)

    def add(kernel, a, b):
        if a == b:
            # A whole circle, which starts at `start` and may run backwards: the side it bounds is the same.
            return kernel.addCircle(center[0], center[1], 0, radius, angle1=start, angle2=start + 2 * math.pi)
        # By a point between: half a circle has no side of its centre.
        return kernel.addCircleArc(a, kernel.addPoint(*point(0.5), 0), b, center=False)

    return Curve(point, add)


def bezier(point):
    """The polynomial curve that `point` is; None if it is none."""
    nodes = 0.5 - 0.5 * np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))

    def bernstein(t):
        binomial = np.array([math.comb(DEGREE, k) for k in range(DEGREE + 1)])
        k = np.arange(DEGREE + 1)
        return binomial * t[:, None] ** k * (1 - t[:, None]) ** (DEGREE - k)

    control = np.linalg.solve(bernstein(nodes), point(nodes))
    check = np.linspace(0, 1, 101)
    if np.abs(bernstein(check) @ control - point(check)).max() > 1e-11:
        return None

    def add(kernel, a, b):
        inner = [kernel.addPoint(x, y, 0) for x, y in control[1:-1]]
        return kernel.addBezier([a, *inner, b])

    return Curve(point, add)


def equation(x, y):
    """A curve of two expressions in t: a circle or a polynomial."""
    names = {name: getattr(np, name) for name in ("sin", "cos", "exp", "sqrt")} | {"pi": math.pi}

    def point(t):
        t = np.asarray(t, float)
        return np.stack([eval(e, {"__builtins__": {}}, names | {"t": t}) + 0 * t for e in (x, y)], axis=-1)

    at = point(np.array([0, 1 / 3, 2 / 3, 1]))
    center = at[:3].mean(axis=0)
    radius = np.hypot(*(at[0] - center))
    around = point(np.linspace(0, 1, 101)) - center
    if np.abs(np.hypot(*around.T) - radius).max() < 1e-12 * radius:
        start = math.atan2(*around[0][::-1])
        (a, b), (c, d) = around[:2]
        return arc(center, radius, start, start + math.copysign(2 * math.pi, a * d - b * c))
    curve = bezier(point)
    if curve is None:
        raise ValueError("an equation that is neither a circle nor a polynomial")
    return curve


def spline(rows):
    """The C2 cubic through rows (t, x, y); its third derivative at each end is that of the cubic through the four
    points there (Forsythe, Malcolm and Moler 1977), which is what HOHQMesh means."""
    knots, points = rows[:, 0], rows[:, 1:3]
    padded = np.concatenate([[knots[0]] * 3, knots, [knots[-1]] * 3])
    count = len(knots) + 2

    def third(four):
        """Divided difference: a sixth of the third derivative."""
        t = knots[four]
        return sum(points[k] / np.prod([t[i] - t[j] for j in range(4) if j != i]) for i, k in enumerate(four))

    ends = [np.arange(4), np.arange(len(knots) - 4, len(knots))]
    matrix = np.empty((count, count))
    identity = BSpline(padded, np.eye(count), 3)
    matrix[1:-1] = identity(knots)
    thirds = identity.derivative(3)
    matrix[0] = thirds(0.5 * (knots[0] + knots[1]))
    matrix[-1] = thirds(0.5 * (knots[-2] + knots[-1]))
    right = np.concatenate([[6 * third(ends[0])], points, [6 * third(ends[1])]])
    control = np.linalg.solve(matrix, right)
    control[[0, -1]] = points[[0, -1]]
    curve = BSpline(padded, control, 3)

    def part(kernel, a, b, first, last):
        """From the knot `first` to the knot `last`: the same cubics, whose control points interpolation finds."""
        own = knots[first : last + 1]
        padded = np.concatenate([[own[0]] * 3, own, [own[-1]] * 3])
        greville = np.array([padded[k + 1 : k + 4].mean() for k in range(len(own) + 2)])
        control = np.linalg.solve(BSpline(padded, np.eye(len(own) + 2), 3)(greville), curve(greville))
        inner = [kernel.addPoint(x, y, 0) for x, y in control[1:-1]]
        multiple = [4] + [1] * (len(own) - 2) + [4]
        return kernel.addBSpline([a, *inner, b], degree=3, knots=list(own), multiplicities=multiple)

    def add(kernel, a, b):
        last = len(knots) - 1
        if a != b:
            return part(kernel, a, b, 0, last)
        # Gmsh takes a closed spline for a periodic one: two halves are none.
        middle = last // 2
        between = kernel.addPoint(*curve(knots[middle]), 0)
        return [part(kernel, a, between, 0, middle), part(kernel, between, a, middle, last)]

    return Curve(lambda t: curve(np.asarray(t)), add)


def numbers(text):
    return [float(x) for x in re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?", text.replace("d", "e"))]


def expression(text):
    """The right-hand side of `x(t) = ...` in Python."""
    return text.split("=", 1)[1].strip().replace("^", "**")


class Block(dict):
    """A control file's block: keys and the blocks inside it."""

    def __init__(self, kind):
        super().__init__()
        self.kind, self.children, self.rows = kind, [], []


def parse(text):
    stack = [Block("FILE")]
    for raw in text.splitlines():
        text_line = raw.split("%")[0].strip()
        if match := re.match(r"\\begin\{(\w+)\}", text_line):
            stack.append(Block(match[1]))
            stack[-2].children.append(stack[-1])
        elif re.match(r"\\end\{(\w+)\}", text_line):
            if len(stack) > 1:
                stack.pop()
        elif stack[-1].kind == "SPLINE_DATA" and text_line:
            stack[-1].rows.append([float(x) for x in text_line.split()])
        elif "=" in text_line:
            key, value = text_line.split("=", 1)
            stack[-1][key.strip()] = value.strip()
    return stack[0]


def find(block, kind):
    for child in block.children:
        if child.kind == kind:
            return child
        if (inside := find(child, kind)) is not None:
            return inside
    return None


def curve_of(block):
    if block.kind == "END_POINTS_LINE":
        return line(numbers(block["xStart"])[:2], numbers(block["xEnd"])[:2])
    if block.kind == "CIRCULAR_ARC":
        unit = math.pi / 180 if block.get("units", "degrees") == "degrees" else 1.0
        start, end = (unit * numbers(block[f"{k} angle"])[0] for k in ("start", "end"))
        return arc(numbers(block["center"])[:2], numbers(block["radius"])[0], start, end)
    if block.kind == "PARAMETRIC_EQUATION_CURVE":
        return equation(expression(block["xEqn"]), expression(block["yEqn"]))
    if block.kind == "SPLINE_CURVE":
        return spline(np.array(find(block, "SPLINE_DATA").rows))
    raise ValueError(f"curves of kind {block.kind} are not read")


class Domain:
    """Loops of curves, the outer one first."""

    def __init__(self, path):
        file = parse(Path(path).read_text(encoding="utf-8"))
        self.path, self.name = Path(path), Path(path).stem
        model = find(file, "MODEL")
        outer, inner = find(model, "OUTER_BOUNDARY"), find(model, "INNER_BOUNDARIES")
        self.loops = []
        if outer is not None:
            self.loops.append([curve_of(c) for c in outer.children])
        else:
            grid = find(file, "BACKGROUND_GRID")
            low = np.array(numbers(grid["x0"])[:2])
            high = low + np.array(numbers(grid["dx"])[:2]) * np.array(numbers(grid["N"])[:2])
            corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]]
            self.loops.append([line(a, b) for a, b in zip(corners, corners[1:] + corners[:1])])
        for chain in inner.children if inner is not None else []:
            self.loops.append([curve_of(c) for c in chain.children])
        self.curves = [curve for loop in self.loops for curve in loop]
        t = np.linspace(0, 1, SAMPLES + 1)
        lines = [c.point(t) for c in self.curves]
        samples = np.concatenate(lines)
        self._lines = [(x[:: SAMPLES // 100], float(np.hypot(*np.diff(x, axis=0).T).sum())) for x in lines]
        self.diagonal = float(np.hypot(*np.ptp(samples, axis=0)))
        self._tree = cKDTree(samples)

    def distance(self, points):
        """The largest distance of `points` from the boundary, in diagonals."""
        _, nearest = self._tree.query(points, STARTS)
        least = np.full(len(points), np.inf)
        for starts in nearest.T:
            which, t = starts // (SAMPLES + 1), starts % (SAMPLES + 1) / SAMPLES
            for k in np.unique(which):
                own, s = points[which == k], t[which == k]
                curve = self.curves[k]
                for _ in range(4):
                    apart, slope = curve.point(s) - own, curve.derivative(s)
                    s = np.clip(s - np.sum(apart * slope, axis=1) / np.sum(slope * slope, axis=1), 0, 1)
                least[which == k] = np.minimum(least[which == k], np.hypot(*(curve.point(s) - own).T))
        return float(least.max()) / self.diagonal

    def followed(self, points):
        """Whether `points`, all along a mesh's boundary, lie along every curve: some meshes lose small loops."""
        tree = cKDTree(points)
        return all(tree.query(line)[0].max() <= NEAR * length for line, length in self._lines)

    def add_to(self, kernel):
        """Makes the domain a surface of Gmsh's kernel."""
        wires = []
        for loop in self.loops:
            ends = [c.point(np.array([0.0, 1.0])) for c in loop]
            starts = [kernel.addPoint(*e[0], 0) for e in ends]
            tags = [t for c, a, b in zip(loop, starts, starts[1:] + starts[:1]) for t in c.add(kernel, a, b)]
            wires.append(kernel.addWire(tags))
        return kernel.addPlaneSurface(wires)

