"""Strict readers of HOHQMesh's mesh files: ISM, ISM-v2, ISM-MM, and Abaqus with HOHQMesh's comments.

Written from the formats' description (HOHQMesh's documentation, "The HOHQMesh mesh file formats"; Trixi.jl's
documentation, "P4est-based mesh"). Whatever is not as described there is an error.
"""

import re

import numpy as np

SIDES = ((0, 1), (1, 2), (3, 2), (0, 3))
NUMBER = re.compile(r"[+-]?\d+(\.\d*)?([eE][+-]?\d+)?")


class Malformed(Exception):
    """The file is not what the description says."""


def require(condition, text):
    if not condition:
        raise Malformed(text)


class Lines:
    """The lines of a file, each taken once."""

    def __init__(self, path):
        with open(path, encoding="utf-8", newline="") as file:
            content = file.read()
        require(content.endswith("\n") and "\r" not in content, "the last line does not end, or there are carriage returns")
        self.lines = content.split("\n")[:-1]
        self.at = 0

    def take(self):
        require(self.at < len(self.lines), "the file ends too early")
        self.at += 1
        return self.lines[self.at - 1]

    def words(self, count, prefix="", separator=None):
        line = self.take()
        require(line.startswith(prefix), f"line {self.at} does not start with {prefix!r}: {line!r}")
        words = [w.strip() for w in line[len(prefix):].split(separator)]
        require(len(words) == count, f"line {self.at} has not {count} words: {line!r}")
        return words

    def integers(self, count, prefix="", separator=None):
        words = self.words(count, prefix, separator)
        require(all(re.fullmatch(r"-?\d+", w) for w in words), f"line {self.at} has words that are no integers: {words}")
        return [int(w) for w in words]

    def point(self, prefix="", separator=None, first=None):
        words = self.words(3 if first is None else 4, prefix, separator)
        if first is not None:
            require(words.pop(0) == str(first), f"line {self.at} is not number {first}")
        require(all(NUMBER.fullmatch(w) for w in words), f"line {self.at} has words that are no numbers: {words}")
        x, y, z = map(float, words)
        require(z == 0.0, f"line {self.at} is out of the plane")
        return x, y

    def end(self):
        require(self.at == len(self.lines), f"line {self.at + 1} and what follows is too much")


class File:
    """What a file says: corners, elements (from 0), names of sides in the order of SIDES, curves."""

    def __init__(self, order, corners, elements, curves, names, edges=None, materials=None):
        self.order, self.corners, self.elements = order, np.array(corners), np.array(elements)
        self.curves, self.names, self.edges, self.materials = np.array(curves), names, edges, materials
        self.points = -np.cos(np.pi * np.arange(order + 1) / order)
        self._check()

    def _check(self):
        used = np.unique(self.elements)
        require(np.array_equal(used, np.arange(len(self.corners))), "there are corners without an element, or the reverse")
        owners = {}
        for e, corners in enumerate(self.elements):
            for s, (a, b) in enumerate(SIDES):
                ends = self.curves[e][s][[0, -1]]
                require(np.array_equal(ends, self.corners[[corners[a], corners[b]]]), f"side {s + 1} of element {e + 1} leaves its corners")
                owners.setdefault(frozenset((corners[a], corners[b])), []).append((e, s, corners[a]))
            x, y = self.corners[corners].T
            require(np.dot(x, np.roll(y, -1)) > np.dot(y, np.roll(x, -1)), f"element {e + 1} is clockwise")
        for own in owners.values():
            require(len(own) <= 2, f"{len(own)} elements at one side")
            inside = len(own) == 2
            for e, s, _ in own:
                require((self.names[e][s] == "---") == inside, f"the name of side {s + 1} of element {e + 1}")
            if inside:
                (e, s, a), (f, t, b) = own
                other = self.curves[f][t] if a == b else self.curves[f][t][::-1]
                require(np.array_equal(self.curves[e][s], other), f"elements {e + 1} and {f + 1} do not match")
        if self.edges is not None:
            self._check_edges(owners)

    def _check_edges(self, owners):
        require(len(self.edges) == len(owners), "the number of edges")
        for start, end, left, right, side, other in self.edges:
            own = owners.pop(frozenset((start - 1, end - 1)), None)
            require(own is not None, f"edge {start} {end} is listed twice or is none")
            places = {(e + 1, s + 1): a + 1 for e, s, a in own}
            require(places.get((left, side)) == start, f"edge {start} {end} does not start its left side")
            if right == 0:
                require(other == 0 and len(own) == 1, f"edge {start} {end} is not at the boundary")
            else:
                require(places.get((right, abs(other))) == (start if other > 0 else end), f"edge {start} {end}: its right side")

    def nodes(self):
        """The transfinite maps at the file's points: [element][j][i][2]."""
        share = 0.5 * (1 + self.points)
        x, y = share[None, None, :, None], share[None, :, None, None]
        bottom, right, top, left = (self.curves[:, s] for s in range(4))
        c = self.corners[self.elements][:, :, None, None, :]
        along = (1 - y) * bottom[:, None, :, :] + y * top[:, None, :, :]
        across = (1 - x) * left[:, :, None, :] + x * right[:, :, None, :]
        bilinear = (1 - x) * (1 - y) * c[:, 0] + x * (1 - y) * c[:, 1] + x * y * c[:, 2] + (1 - x) * y * c[:, 3]
        return along + across - bilinear


def _corner_numbers(numbers, corners):
    require(all(1 <= n <= len(corners) for n in numbers), f"corner out of range: {numbers}")
    return [n - 1 for n in numbers]


def _curves(lines, order, corners, element, prefix=""):
    flags = lines.integers(4, prefix)
    require(set(flags) <= {0, 1}, f"line {lines.at}: flags are 0 or 1")
    share = 0.5 * (1 - np.cos(np.pi * np.arange(order + 1) / order))
    curves = []
    for flag, (a, b) in zip(flags, SIDES):
        first, last = (np.array(corners[element[k]]) for k in (a, b))
        if flag:
            curves.append([lines.point(prefix) for _ in range(order + 1)])
        else:
            straight = first + share[:, None] * (last - first)
            straight[-1] = last
            # The same from both sides.
            back = (last + share[:, None] * (first - last))[::-1]
            curves.append(straight if tuple(first) < tuple(last) else np.vstack([first[None], back[1:-1], last[None]]))
    return curves


def read_ism(path):
    """An ISM file of any of the three versions."""
    lines = Lines(path)
    version = lines.lines[0].strip() if lines.lines else ""
    if version in ("ISM-V2", "ISM-MM"):
        lines.take()
        corner_count, edge_count, count, order = lines.integers(4)
    else:
        version = "ISM"
        corner_count, count, order = lines.integers(3)
    require(min(corner_count, count, order) >= 1, "sizes are positive")
    corners = [lines.point() for _ in range(corner_count)]
    edges = [lines.integers(6) for _ in range(edge_count)] if version == "ISM-V2" else None
    elements, curves, names, materials = [], [], [], []
    for _ in range(count):
        if version == "ISM-MM":
            *numbers, material = lines.words(5)
            require(all(n.isdigit() for n in numbers), f"line {lines.at}: corners are numbers")
            elements.append(_corner_numbers([int(n) for n in numbers], corners))
            materials.append(material)
        else:
            elements.append(_corner_numbers(lines.integers(4), corners))
        curves.append(_curves(lines, order, corners, elements[-1]))
        names.append(lines.words(4))
    lines.end()
    if version == "ISM-MM":
        sides = {frozenset((e[a], e[b])) for e in elements for a, b in SIDES}
        require(edge_count == len(sides), "the number of edges")
    return File(order, corners, elements, curves, names, edges, materials or None)


def read_abaqus(path):
    """An Abaqus file with HOHQMesh's section."""
    lines = Lines(path)
    require(lines.take() == "*Heading", "the heading")
    require(lines.take() == " File created by HOHQMesh", "the heading's text, which Trixi.jl compares")
    require(lines.take() == "*NODE", "*NODE")
    corners = []
    while lines.at < len(lines.lines) and not lines.lines[lines.at].startswith("*"):
        corners.append(lines.point(separator=",", first=len(corners) + 1))
    require(lines.take() == "*ELEMENT, type=CPS4, ELSET=Surface1", "*ELEMENT")
    elements = []
    while lines.at < len(lines.lines) and not lines.lines[lines.at].startswith("*"):
        number, *numbers = lines.integers(5, separator=",")
        elements.append(_corner_numbers(numbers, corners))
        require(number == len(elements), f"line {lines.at} is not element {len(elements)}")
    require(lines.take() == "** ***** HOHQMesh boundary information ***** **", "the section's title")
    degree = re.fullmatch(r"\*\* mesh polynomial degree = (\d+)", lines.take())
    require(degree is not None, "the polynomial degree")
    order = int(degree[1])
    curves = []
    for element in elements:
        again = _corner_numbers(lines.integers(4, "** "), corners)
        require(again == element, f"line {lines.at} names other corners than the element")
        curves.append(_curves(lines, order, corners, element, "** "))
    names = []
    for _ in elements:
        left, right, bottom, top = lines.words(4, "** ")
        names.append([bottom, right, top, left])
    lines.end()
    return File(order, corners, elements, curves, names)
