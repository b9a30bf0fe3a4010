"""The patch decoder as one would write it down from spec/patch.md: slow, plain, without kernels.

Read this first when a fast decoder looks wrong.
"""

from dataclasses import dataclass, field
from math import floor

FREE, LIVE, DEAD = range(3)
NEW, RIGHT, LEFT, END, BOUNDARY, SPLIT, MET, SPLIT_NEXT, SPLIT_PREVIOUS, START = range(10)


class Damaged(ValueError):
    pass


def signed(x, bits):
    """x modulo 2^bits, as a signed integer."""
    x &= (1 << bits) - 1
    return x - (1 << bits) if x >> (bits - 1) else x


def scale(x, most=63):
    e = (x + 1).bit_length() - 1
    return min(2 * e + (((x + 1) >> (e - 1)) & 1 if e > 0 else 0), most)


def small(x):
    return scale(x, 15)


def degree_class(degree):
    return min(max(degree - 4, 0), 4)


def cross(p, q):
    return [signed(p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3], 64) for k in range(3)]


class Tables:
    def __init__(self, data):
        data = iter(data)
        self.normal_bits, tables = next(data), next(data)
        rows = [[signed(next(data), 8) for _ in range(4)] for _ in range(80)]
        self.weights = [rows[16 * kind : 16 * kind + 16] for kind in range(5)]
        self.contexts = []
        while len(self.contexts) < 940:
            table, shift = next(data), next(data)
            self.contexts += [(table, shift)] * varint(data)
        self.slots = []
        for _ in range(tables):
            first, last = next(data), next(data)
            slots, start = [], 0
            for symbol in range(first, last + 1):
                frequency = varint(data)
                slots += [(symbol, frequency, start)] * frequency
                start += frequency
            self.slots.append(slots)
        assert next(data, None) is None


def varint(data):
    value = shift = 0
    while True:
        byte = next(data)
        value |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            return value


@dataclass
class Reader:
    """The words and the two states; `x` names the state to use, "a" or "b"."""

    tables: Tables
    states: dict
    words: list
    at: int = 0

    def refill(self, x):
        if self.states[x] < 1 << 16:
            if self.at == len(self.words):
                raise Damaged("no words left")
            self.states[x] = self.states[x] << 16 | self.words[self.at]
            self.at += 1

    def symbol(self, context, x="a"):
        state = self.states[x]
        symbol, frequency, start = self.tables.slots[self.tables.contexts[context][0]][state & 2047]
        self.states[x] = frequency * (state >> 11) + (state & 2047) - start
        self.refill(x)
        return symbol

    def raw(self, k, x="a"):
        value = self.states[x] & ((1 << k) - 1)
        self.states[x] >>= k
        self.refill(x)
        return value

    def number(self, x="a"):
        k = min(self.raw(6, x), 32)
        bits = self.raw(min(k, 16), x)
        if k > 16:
            bits |= self.raw(k - 16, x) << 16
        return ((1 << k) + bits - 1) % (1 << 32)

    def signed_number(self, x="a"):
        u = self.number(x)
        return u >> 1 if u % 2 == 0 else -(u >> 1) - 1

    def value(self, context, x="a"):
        symbol = self.symbol(context, x)
        if symbol == 63:
            return self.signed_number(x)
        shift = self.tables.contexts[context][1]
        return ((symbol - 31) << shift) + self.raw(shift, x)


@dataclass
class Slot:
    origin: int
    opposite: int
    next: "Slot | None" = None
    previous: "Slot | None" = None
    state: int = LIVE


def join(first, second):
    first.next, second.previous = second, first


@dataclass
class Region:
    """What the connectivity decodes to."""

    limit: int
    faces: list = field(default_factory=list)
    degree: list = field(default_factory=list)
    edge: set = field(default_factory=set)
    corners: dict = field(default_factory=dict)  # of NEW vertices: a, b, o, n, p
    followers: dict = field(default_factory=dict)  # of NEW vertices: the codes after, or None where N is dead

    def vertex(self):
        if len(self.degree) == self.limit:
            raise Damaged("more vertices than the patch has")
        self.degree.append(0)
        return len(self.degree) - 1

    def back(self, distance):
        if distance >= len(self.degree):
            raise Damaged("a vertex that is not there")
        return len(self.degree) - 1 - distance

    def add(self, *face):
        self.faces.append(face)
        for v in face:
            self.degree[v] += 1

    def kind(self, v):
        after = self.followers[v]
        if after is None:
            return 4
        first, second = (*after, START, START)[:2]
        if first == NEW and after:
            return 0
        if first == RIGHT:
            return 2 if second in (RIGHT, END) else 1
        return 1 if first == END else 3


def read_connectivity(read, n, m):
    region = Region(n)
    slots, stack, codes = [], [], []
    placed = {}  # NEW vertex: how many codes there were when it came
    gate, last = None, START

    def new_slot(origin, opposite):
        slots.append(Slot(origin, opposite))
        return slots[-1]

    while len(region.faces) < m or gate:
        if not gate:
            pattern = read.raw(3)
            corners = []
            for k in range(3):
                corners.append(region.vertex() if pattern >> k & 1 else region.back(read.number()))
            region.add(*corners)
            three = [new_slot(corners[k], corners[(k + 2) % 3]) for k in range(3)]
            for k in range(3):
                join(three[k], three[(k + 1) % 3])
            gate, last = three[0], START
            codes.append(START)
            continue
        g, following, before = gate, gate.next, gate.previous
        a, b = g.origin, following.origin
        head = min(region.degree[b], 7) - 1
        dead = (following.state == DEAD) + 2 * (before.state == DEAD)
        if dead:
            context = 420 + 3 * head + dead - 1
        else:
            context = (head * 6 + min(region.degree[a], 6) - 1) * 10 + last
        last = read.symbol(context)
        codes.append(last)
        if last == BOUNDARY:
            region.edge |= {a, b}
            gate = close(g)
        else:
            if len(region.faces) == m:
                raise Damaged("more triangles than the patch has")
            if last == RIGHT:
                if following is g or following.state != LIVE:
                    raise Damaged("RIGHT without a neighbour")
                v = following.next.origin
                following.state = FREE
                join(g, following.next)
                g.opposite = b
            elif last == LEFT:
                if before is g or before.state != LIVE:
                    raise Damaged("LEFT without a neighbour")
                v = before.origin
                g.state = FREE
                join(before, following)
                before.opposite = a
                gate = before
            elif last == END:
                if following.state != LIVE or before.state != LIVE or following.next is not before:
                    raise Damaged("END of what is no triangle")
                if following is g or before is g or following is before:
                    raise Damaged("END of what is no triangle")
                v = before.origin
                g.state = following.state = before.state = FREE
                gate = None
            elif last in (NEW, MET):
                v = region.vertex() if last == NEW else region.back(read.number())
                if last == NEW:
                    alive = following.state == LIVE and following is not g
                    n_, p_ = (following.next.origin, following.opposite) if alive else (a, a)
                    region.corners[v] = (a, b, g.opposite, n_, p_)
                    region.followers[v] = [] if alive else None
                    placed[v] = len(codes)
                gate = new_slot(v, a)
                join(gate, following)
                join(g, gate)
                g.opposite = b
            else:
                s = find_split(read, last, g, slots)
                if s is None or s.state == FREE or s is g or s is following:
                    raise Damaged("SPLIT at a slot that is not there")
                v = s.origin
                stack.append(g)
                gate = new_slot(v, a)
                join(gate, following)
                join(s.previous, gate)
                join(g, s)
                g.opposite = b
            region.add(b, a, v)
        while not gate and stack:
            popped = stack.pop()
            gate = popped if popped.state == LIVE else None
    for v, at in placed.items():
        if region.followers[v] is not None:
            region.followers[v] = codes[at : at + 2]
    return region


def find_split(read, code, g, slots):
    if code == SPLIT_NEXT:
        return g.next.next.next
    if code == SPLIT_PREVIOUS:
        return g.previous.previous
    walk = read.symbol(441)
    s = g
    if walk < 16:
        for _ in range(walk + 4):
            s = s.next
    elif walk < 31:
        for _ in range(walk - 15):
            s = s.previous
    else:
        distance = read.number()
        s = slots[-1 - distance] if distance < len(slots) else None
    return s


def close(g):
    following, before = g.next, g.previous
    g.state = DEAD
    here = g
    if before is not g and before.state == DEAD:
        g.state = FREE
        join(before, following)
        here = before
    if following is not here and following.state == DEAD:
        following.state = FREE
        join(here, following.next)
    return here.next if here.next.state == LIVE else None


def read_positions(read, region, n, coarse):
    positions = []
    was_coarse = 0
    for v in range(n):
        if v not in region.corners:
            before = positions[-1] if v else [0, 0, 0]
            positions.append([signed(c + read.signed_number(), 32) for c in before])
            continue
        a, b, o, n_, p = region.corners[v]
        origin = positions[a]
        points = [[x - y for x, y in zip(positions[i], origin, strict=True)] for i in (b, o, n_, p)]
        degrees = [degree_class(region.degree[i]) for i in (a, b, v)]
        rows = read.tables.weights[region.kind(v)]
        chosen = [rows[0], rows[1 + degrees[0]], rows[6 + degrees[1]], rows[11 + degrees[2]]]
        weights = [sum(column) for column in zip(*chosen, strict=True)]
        prediction = [
            origin[k] + ((sum(w * q[k] for w, q in zip(weights, points, strict=True)) + 32) >> 6)
            for k in range(3)
        ]
        to_b, to_o, to_n, to_p = points
        size = sum(map(abs, to_b)) + sum(map(abs, to_o))
        side = [[q[k] - to_b[k] for k in range(3)] for q in (to_n, to_p)]
        normal = [signed(x + y, 64) for x, y in zip(cross(to_b, to_o), cross(*side), strict=True)]
        c = 0
        if coarse:
            was_coarse = int(read.value(938 + was_coarse, "b") != 0)
            c = coarse * was_coarse
        prediction = [(x + ((1 << c) >> 1)) >> c for x in prediction]
        size >>= c
        r = read.value(442 + 64 * degrees[2] + scale(size))
        s = read.value(442 + 64 * degrees[2] + scale(size), "b")
        t = read.value(762 + scale(size))
        reals = [float(x) for x in normal]
        k = max(range(3), key=lambda axis: abs(reals[axis]))
        i, j = (k + 1) % 3, (k + 2) % 3
        if reals[k] != 0:
            t += floor(0.5 - (reals[i] * r + reals[j] * s) / reals[k])
        here = [0, 0, 0]
        for axis, residual in ((i, r), (j, s), (k, t)):
            here[axis] = signed((prediction[axis] + residual) << c, 32)
        positions.append(here)
    return positions


def predicted_normals(positions, faces, bits):
    sums = [[0, 0, 0] for _ in positions]
    for face in faces:
        p, q, r = (positions[v] for v in face)
        product = cross(
            [y - x for x, y in zip(p, q, strict=True)], [y - x for x, y in zip(p, r, strict=True)]
        )
        for v in face:
            sums[v] = [signed(x + y, 64) for x, y in zip(sums[v], product, strict=True)]
    return [octahedral(x, y, z, (1 << (bits - 1)) - 1) for x, y, z in sums]


def octahedral(x, y, z, k):
    while max(abs(x), abs(y), abs(z)) >= 1 << 40:
        x, y, z = x >> 8, y >> 8, z >> 8
    total = abs(x) + abs(y) + abs(z)
    if total == 0:
        return [-k - 1, -k - 1]
    u, v = (2 * k * x + total) // (2 * total), (2 * k * y + total) // (2 * total)
    if z < 0:
        u, v = (k - abs(v)) * (-1 if x < 0 else 1), (k - abs(u)) * (-1 if y < 0 else 1)
    return [u, v]


def read_normals(read, region, positions):
    k = (1 << (read.tables.normal_bits - 1)) - 1
    normals = predicted_normals(positions, region.faces, read.tables.normal_bits)
    previous = 0
    for i, pair in enumerate(normals):
        e = 32 if i in region.edge else 0
        u = read.value(874 + e + small(previous))
        v = read.value(890 + e + small(abs(u)), "b")
        previous = abs(u) + abs(v)
        normals[i] = [min(max(x + d, -k - 1), k) for x, d in zip(pair, (u, v), strict=True)]
    return normals


def read_colours(read, region, n):
    sums, colours = [], []
    for i in range(n):
        contrast = 0
        if i in region.corners:
            a, b = (sums[v] for v in region.corners[i][:2])
            prediction = [(x + y) >> 1 for x, y in zip(a, b, strict=True)]
            contrast = abs(a[0] - b[0])
        else:
            prediction = sums[-1] if i else [0, 0, 0]
        y = read.value(826 + small(contrast))
        o = read.value(842 + small(abs(y)), "b")
        g = read.value(858 + small(abs(o) + (abs(y) >> 1)))
        y, o, g = (signed(p + d, 32) for p, d in zip(prediction, (y, o, g), strict=True))
        sums.append([y, o, g])
        middle = y - (g >> 1)
        blue = middle - (o >> 1)
        colours.append([(blue + o) % 256, (middle + g) % 256, blue % 256])
    return colours


def decode(data, tables, *, has_normals=False, has_colours=False):
    """Lists: positions, faces, normals or None, colours or None. Raises Damaged or runs out of bytes."""
    source = iter(data)
    n, m, coarse = varint(source), varint(source), next(source)
    rest = bytes(source)
    if len(rest) < 8 or len(rest) % 2 or coarse > 15:
        raise Damaged("lengths that do not fit")
    words = [rest[i] | rest[i + 1] << 8 for i in range(0, len(rest), 2)]
    states = {"a": words[0] | words[1] << 16, "b": words[2] | words[3] << 16}
    if min(states.values()) < 1 << 16:
        raise Damaged("states that are none")
    read = Reader(Tables(tables), states, words[4:])
    region = read_connectivity(read, n, m)
    positions = read_positions(read, region, n, coarse)
    normals = read_normals(read, region, positions) if has_normals else None
    colours = read_colours(read, region, n) if has_colours else None
    if set(states.values()) != {1 << 16} or read.at != len(read.words):
        raise Damaged("words left over")
    return positions, region.faces, normals, colours
