"""Sections of straight lines as .geo files: faces that share their edges, structures over them, named curves and points."""

import math
from dataclasses import dataclass, field, replace

CLOSE = 1e-9  # of the extent: places nearer than that are one


@dataclass
class Face:
    """A polygon: a region of the grid, or a structure, which shares no edge with others."""

    name: str
    corners: list  # [(x, y)] [m]
    h: float  # size of the cells [m], or a list of that at each corner
    structure: bool = False

    def sizes(self):
        return self.h if isinstance(self.h, list) else [self.h] * len(self.corners)


@dataclass
class Section:
    """The faces, with the names of curves, {name: [(start, end)]}, and of points, {name: place}."""

    faces: list
    curves: dict = field(default_factory=dict)
    points: dict = field(default_factory=dict)
    quadrangles: bool = False
    regular: bool = False  # rows and columns of cells where each face of the grid has four sides

    def moved(self, place, scale=1.0):
        """The section with each place mapped, and the sizes of cells scaled. Lines of curves that this bends go on along the sides of faces.

        >>> section = Section([Face("soil", box(0, 1, 0, 1), 1), Face("air", box(0, 1, 1, 2), 1)], {"side": [((0, 0), (0, 2))]})
        >>> section.moved(lambda x, y: (x + max(0, y - 1), y)).curves["side"]
        [((0, 0), (0, 1)), ((0, 1), (1, 2))]
        """
        corners = {corner for face in self.faces for corner in map(tuple, face.corners)}
        close = CLOSE * self.extent()

        def moved(a, b):
            """The line between two places once it is mapped, parted at the corners on it that are beside it then."""
            on = sorted((corner for corner in corners if is_on(corner, a, b, close)), key=lambda corner: math.dist(a, corner))
            bends = [corner for corner in on if not is_on(place(*corner), place(*a), place(*b), close * scale)]
            return [(place(*start), place(*end)) for start, end in zip([a, *bends], [*bends, b])]

        return replace(
            self,
            faces=[replace(face, corners=[place(*corner) for corner in face.corners], h=[h * scale for h in face.sizes()]) for face in self.faces],
            curves={name: [part for line in lines for part in moved(*line)] for name, lines in self.curves.items()},
            points={name: place(*point) for name, point in self.points.items()},
        )

    def extent(self):
        """The larger side of the box around all faces [m], and the largest coordinate."""
        places = [corner for face in self.faces for corner in face.corners]
        xs, ys = zip(*places)
        return max(max(xs) - min(xs), max(ys) - min(ys))

    def geo(self):
        """The text of the .geo."""
        return _Writer(self).text()


def area(corners):
    """Of a polygon, positive where it is anticlockwise [m²].

    >>> area([(0, 0), (2, 0), (2, 1), (0, 1)])
    2.0
    """
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(corners, [*corners[1:], corners[0]])) / 2


def clipped(corners, coordinate, limit, above):
    """The part of a polygon whose coordinate (0: x, 1: y) is above `limit`, or below.

    >>> clipped([(0, 0), (2, 0), (2, 1), (0, 1)], 0, 0.5, False)
    [(0, 0), (0.5, 0.0), (0.5, 1.0), (0, 1)]
    """
    sign = 1 if above else -1
    part = []
    for a, b in zip([corners[-1], *corners[:-1]], corners):
        da, db = sign * (a[coordinate] - limit), sign * (b[coordinate] - limit)
        if da * db < 0:
            t = da / (da - db)
            place = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
            place[coordinate] = limit
            part.append(tuple(place))
        if db >= 0:
            part.append(b)
    return part


class _Writer:
    """Numbers the vertices and lines of a section."""

    def __init__(self, section):
        self.section = section
        self.tolerance = CLOSE * section.extent()
        self.vertices = []  # (x, y)
        self.sizes = []
        self.lines = {}  # (first, second) of vertices, the lower one first: number from 1
        self.grid = set()  # lines of the grid
        self.loops = []  # of each face: signed lines, and the vertices of its corners

        grid = [face for face in section.faces if not face.structure]
        for face in grid:
            for corner, h in zip(face.corners, face.sizes()):
                self.vertex(corner, h)
        for place in [end for lines in section.curves.values() for line in lines for end in line] + list(section.points.values()):
            if any(self.on(place, a, b) for face in grid for a, b in edges(face.corners)):
                self.vertex(place, math.inf)
        shared = len(self.vertices)
        for face in section.faces:
            if face.structure:
                first = len(self.vertices)
                self.vertices += face.corners
                self.sizes += face.sizes()
                numbers = list(range(first, len(self.vertices)))
                corners = numbers
            else:
                corners = [self.vertex(corner, math.inf) for corner in face.corners]
                numbers = []
                for a, b in edges(face.corners):
                    on = [n for n in range(shared) if self.on(self.vertices[n], a, b)]
                    on.sort(key=lambda n: math.dist(a, self.vertices[n]))
                    for n in on:
                        self.sizes[n] = min(self.sizes[n], max(face.sizes()))
                    numbers += on[:-1]
            if area([self.vertices[n] for n in numbers]) < 0:
                numbers, corners = numbers[::-1], corners[::-1]
            loop = [self.line(a, b) for a, b in edges(numbers)]
            self.loops.append((loop, numbers, corners))
            if not face.structure:
                self.grid.update(abs(line) for line in loop)

    def vertex(self, place, size):
        for n, other in enumerate(self.vertices):
            if math.dist(place, other) < self.tolerance:
                self.sizes[n] = min(self.sizes[n], size)
                return n
        self.vertices.append(place)
        self.sizes.append(size)
        return len(self.vertices) - 1

    def on(self, place, a, b):
        return is_on(place, a, b, self.tolerance)

    def line(self, a, b):
        number = self.lines.setdefault((min(a, b), max(a, b)), len(self.lines) + 1)
        return number if a < b else -number

    def named(self):
        """The lines of each named curve: those of the grid, or where it has none there, of structures."""
        for name, parts in self.section.curves.items():
            on = [
                number
                for (a, b), number in self.lines.items()
                if any(self.on(self.vertices[a], *part) and self.on(self.vertices[b], *part) for part in parts)
            ]
            yield name, [number for number in on if number in self.grid] or on

    def text(self):
        out = [f"Point({n + 1}) = {{{x!r}, {y!r}, 0, {h!r}}};" for n, ((x, y), h) in enumerate(zip(self.vertices, self.sizes))]
        out += [f"Line({number}) = {{{a + 1}, {b + 1}}};" for (a, b), number in self.lines.items()]
        for n, (loop, _, _) in enumerate(self.loops, 1):
            out += [f"Curve Loop({n}) = {{{', '.join(map(str, loop))}}};", f"Plane Surface({n}) = {{{n}}};"]
        if self.section.regular:
            out += self.rows()
        if self.section.quadrangles:
            out.append("Recombine Surface {:};")
        names = {}
        for n, face in enumerate(self.section.faces, 1):
            names.setdefault(face.name, []).append(n)
        out += [f'Physical Surface("{name}") = {{{", ".join(map(str, numbers))}}};' for name, numbers in names.items()]
        out += [f'Physical Curve("{name}") = {{{", ".join(map(str, numbers))}}};' for name, numbers in self.named()]
        out += [f'Physical Point("{name}") = {{{self.vertex(place, math.inf) + 1}}};' for name, place in self.section.points.items()]
        return "\n".join(out) + "\n"

    def rows(self):
        """Transfinite faces; opposite sides have the same numbers of cells."""
        faces = list(zip(self.section.faces, self.loops))
        if any(not face.structure and (len(face.corners) != 4 or len(numbers) != 4) for face, (_, numbers, _) in faces):
            raise ValueError("a face of a regular section has four sides and shares them whole")
        group = {number: number for number in self.lines.values()}

        def root(number):
            while group[number] != number:
                number = group[number]
            return number

        length = {number: math.dist(self.vertices[a], self.vertices[b]) for (a, b), number in self.lines.items()}
        wanted = {}
        for face, (loop, _, _) in faces:
            if not face.structure:
                for one, other in [(loop[0], loop[2]), (loop[1], loop[3])]:
                    group[root(abs(one))] = root(abs(other))
        for face, (loop, _, _) in faces:
            if not face.structure:
                for number in map(abs, loop):
                    wanted[root(number)] = max(wanted.get(root(number), 1), round(length[number] / min(face.sizes())))
        out = [f"Transfinite Curve {{{number}}} = {wanted[root(number)] + 1};" for number in sorted(self.grid)]
        grid = [str(n) for n, face in enumerate(self.section.faces, 1) if not face.structure]
        return [*out, f"Transfinite Surface {{{', '.join(grid)}}};"]


def is_on(place, a, b, close):
    """Whether a place is on the line between two others, to a distance."""
    length = math.dist(a, b)
    along = ((place[0] - a[0]) * (b[0] - a[0]) + (place[1] - a[1]) * (b[1] - a[1])) / length
    across = ((place[0] - a[0]) * (b[1] - a[1]) - (place[1] - a[1]) * (b[0] - a[0])) / length
    return abs(across) < close and -close < along < length + close


def edges(corners):
    """Pairs of neighbours around a polygon."""
    return list(zip(corners, [*corners[1:], corners[0]]))


def box(x0, x1, y0, y1):
    """The corners of a rectangle, anticlockwise."""
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
