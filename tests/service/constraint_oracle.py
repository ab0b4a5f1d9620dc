"""Constraints re-verified on a labels.json from the request alone, the slow and plain way."""

import base64
import itertools
import struct
import zlib


def grey_png(rows):
    """A PNG of grey values 0 ... 255 as a data: URI."""
    def chunk(name, data):
        return (struct.pack(">I", len(data)) + name + data +
                struct.pack(">I", zlib.crc32(name + data)))
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    pixels = b"".join(b"\0" + bytes(row) for row in rows)
    png = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
           chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b""))
    return "data:image/png;base64," + base64.b64encode(png).decode()


def grey_rows(uri):
    """The rows of such a PNG."""
    png = base64.b64decode(uri.split(",", 1)[1])
    width, height = struct.unpack(">II", png[16:24])
    start = png.index(b"IDAT")
    length, = struct.unpack(">I", png[start - 4:start])
    pixels = zlib.decompress(png[start + 4:start + 4 + length])
    rows = [pixels[row * (width + 1):(row + 1) * (width + 1)] for row in range(height)]
    assert all(row[0] == 0 for row in rows), "a filter that is not read here"
    return [list(row[1:]) for row in rows]


class Oracle:
    """One model: the names of its pieces by place, and which axes are periodic."""

    def __init__(self, labels, boundary):
        self.size = tuple(labels["size"])
        width, _, depth = self.size
        self.at = {
            place: labels["pieces"][labels["cells"][place[0] + width * (place[2] + depth * place[1])]]
            for place in itertools.product(*map(range, self.size))}
        self.wraps = [boundary[side] == "periodic" for side in ("east", "top", "south")]

    def violation(self, constraint):
        """What is wrong, or None."""
        places = {place for place in self.at if self._value(constraint, place) >= 0.5}
        members = {place for place in places if self.at[place] in constraint.get("pieces", [])}
        return getattr(self, "_" + constraint["kind"])(constraint, places, members)

    def _value(self, constraint, place):
        if not {"box", "cells", "voxels", "mask"} & set(constraint):
            return 1
        value = 0
        if "box" in constraint:
            box = constraint["box"]
            value = max(value, all(low <= p < high for p, low, high in
                                   zip(place, box["min"], box["max"])))
        if list(place) in constraint.get("cells", []):
            value = 1
        if "mask" in constraint:
            rows = grey_rows(constraint["mask"])
            row = rows[int((place[2] + 0.5) / self.size[2] * len(rows))]
            value = max(value, row[int((place[0] + 0.5) / self.size[0] * len(row))] / 255)
        if "voxels" in constraint:
            grid = constraint["voxels"]["size"]
            x, y, z = (int((p + 0.5) / extent * other)
                       for p, extent, other in zip(place, self.size, grid))
            value = max(value, constraint["voxels"]["values"][x + grid[0] * (z + grid[2] * y)])
        return value

    def _beside(self, place):
        for axis, step in itertools.product(range(3), (1, -1)):
            beside = list(place)
            beside[axis] += step
            if self.wraps[axis]:
                beside[axis] %= self.size[axis]
            if 0 <= beside[axis] < self.size[axis]:
                yield tuple(beside)

    def _groups(self, members):
        """Members that hang together through faces."""
        left, groups = set(members), []
        while left:
            group, edge = set(), {left.pop()}
            while edge:
                group |= edge
                edge = {beside for place in edge for beside in self._beside(place)} & left
                left -= edge
            groups.append(group)
        return groups

    def _fixed(self, constraint, places, members):
        return None if places == members else f"others at {sorted(places - members)[:3]}"

    def _forbidden(self, constraint, places, members):
        return f"they stand at {sorted(members)[:3]}" if members else None

    def _probability(self, constraint, places, members):
        full = {place for place in members if self._value(constraint, place) == 1}
        return f"removed ones at {sorted(full)[:3]}" if constraint["weight"] == 0 and full else None

    def _count(self, constraint, places, members):
        low, high = constraint.get("min", 0), constraint.get("max", len(self.at))
        return None if low <= len(members) <= high else f"{len(members)} of them"

    def _separation(self, constraint, places, members):
        for a, b in itertools.combinations(sorted(members), 2):
            steps = sum(min(abs(p - q), extent - abs(p - q)) if wraps else abs(p - q)
                        for p, q, extent, wraps in zip(a, b, self.size, self.wraps))
            if steps < constraint["distance"]:
                return f"{a} and {b} are {steps} apart"
        return None

    def _max_run(self, constraint, places, members):
        for axis in ([0, 1, 2] if "axis" not in constraint else ["xyz".index(constraint["axis"])]):
            for start in members:
                place, length = list(start), 0
                while tuple(place) in members and length < self.size[axis]:
                    length += 1
                    place[axis] += 1
                    if self.wraps[axis]:
                        place[axis] %= self.size[axis]
                if length > constraint["max"]:
                    return f"{length} in a row from {start}"
        return None

    def _connected(self, constraint, places, members):
        groups = self._groups(members)
        return None if len(groups) <= 1 else f"{len(groups)} groups"

    def _acyclic(self, constraint, places, members):
        faces = sum(beside in members for place in members for beside in self._beside(place)) // 2
        return None if faces == len(members) - len(self._groups(members)) else "there is a ring"

    def _path(self, constraint, places, members):
        ends = {tuple(constraint["from"]), tuple(constraint["to"])}
        linked = any(ends <= group for group in self._groups(members))
        return None if linked else "no way between the ends"

    def _moved(self, constraint, place):
        box = constraint.get("box", {"min": [0, 0, 0], "max": self.size})
        dx, dz = (2 * place[axis] + 1 - box["min"][axis] - box["max"][axis] for axis in (0, 2))
        if "translate" in constraint:
            moved = [p + step for p, step in zip(place, constraint["translate"])]
            moved = [p % extent if wraps else p
                     for p, extent, wraps in zip(moved, self.size, self.wraps)]
        else:
            if "reflect" in constraint:
                to = (-dx, dz) if constraint["reflect"] == "x" else (dx, -dz)
            else:
                to = (-dx, -dz) if constraint["rotate"] == 2 else (dz, -dx)
            x, z = ((d - 1 + box["min"][axis] + box["max"][axis]) // 2
                    for d, axis in zip(to, (0, 2)))
            moved = [x, place[1], z]
        return tuple(moved) if tuple(moved) in self.at else None

    def _symmetry(self, constraint, places, members):
        """For a mirror of pairs, each named once or both ways, or of all that are not their own."""
        mirror = constraint.get("mirror", {})
        image = {**{b: a for a, b in mirror.items()}, **mirror}
        for place in places:
            to = self._moved(constraint, place)
            if to in places and self.at[to] != image.get(self.at[place], self.at[place]):
                return f"{self.at[place]} at {place}, {self.at[to]} at {to}"
        return None

    def error_of(self, constraint, term, empty=None):
        """Of a term of an objective or of best_of."""
        places = {place for place in self.at if self._value(constraint, place) >= 0.5}
        holds = {place for place in self.at
                 if self.at[place] in term.get("pieces", []) or
                 ("pieces" not in term and self.at[place] != empty)}
        if term["term"] == "height_profile":
            floors, profile = range(self.size[1]), term["profile"]
            shares = []
            for floor in floors:
                here = {place for place in places if place[1] == floor}
                shares.append(len(here & holds) / len(here) if here else 0)
            return sum(abs(share - profile[int((y + 0.5) / len(floors) * len(profile))])
                       for y, share in zip(floors, shares)) / len(floors)
        if term["term"] == "shape":
            return sum(abs((place in holds) - self._value(constraint, place))
                       for place in self.at) / len(self.at)
        value = len(places & holds) / (len(places) if term["term"] == "density" else 1)
        return abs(value - term["target"]) if "target" in term else -value

    def sum_of(self, constraint, empty=None):
        return sum(term.get("weight", 1) * self.error_of(constraint, term, empty)
                   for term in constraint["terms"])

    def _objective(self, constraint, places, members):
        """Of one that has targets that can be reached."""
        total = self.sum_of(constraint)
        return None if total < 0.01 else f"the terms come to {total}"

    def _resemblance(self, constraint, places, members):
        return None

    def _best_of(self, constraint, places, members):
        return None
