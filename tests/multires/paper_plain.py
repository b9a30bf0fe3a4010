"""The paper's coding, decoded plainly: slow, without arrays, from the text of the package alone."""

import heapq

VERTEX, LEFT, RIGHT, SKIP, SPLIT, DELAY = range(6)


class Bits:
    """Bits of a stream, lowest first."""

    def __init__(self, data):
        self.number = int.from_bytes(data, "little")

    def take(self, count):
        value = self.number & (1 << count) - 1
        self.number >>= count
        return value


class Bytes:
    def __init__(self, data):
        self.data = list(data)

    def byte(self):
        return self.data.pop(0)

    def number(self):
        byte = self.byte()
        return byte if byte < 128 else byte - 128 + 128 * self.number()

    def signed(self):
        value = self.number()
        return -(value + 1) // 2 if value % 2 else value // 2

    def raw(self):
        count = self.number()
        taken, self.data = self.data[:count], self.data[count:]
        return bytes(taken)

    def symbols(self, count, word_bits):
        frequencies = [self.byte() for _ in range(self.byte())]
        words = Bits(self.raw())
        code = tunstall(frequencies, word_bits)
        out = []
        while len(out) < count:
            out += code[words.take(word_bits)] if len(code) > 1 else code[0]
        return out[:count]


def tunstall(frequencies, word_bits):
    """The sequences of a Tunstall code: columns of extensions, the expanded ones left out."""
    symbols = sorted((s for s, f in enumerate(frequencies) if f), key=lambda s: -frequencies[s])
    if len(symbols) < 2:
        return [[s] for s in symbols]
    weights = [max(frequencies[s] * 65536 // sum(frequencies), 1) for s in symbols]
    nodes = [(w << 16, [s]) for w, s in zip(weights, symbols, strict=True)]
    heap = [(-chance, rank, k) for k, (chance, _) in enumerate(nodes) for rank in [k]]
    heapq.heapify(heap)
    gone = set()
    while len(heap) + len(symbols) - 1 <= 1 << word_bits:
        chance, _, k = heapq.heappop(heap)
        gone.add(k)
        for rank, (weight, symbol) in enumerate(zip(weights, symbols, strict=True)):
            heapq.heappush(heap, (-(-chance * weight >> 16), rank, len(nodes)))
            nodes.append((-chance * weight >> 16, nodes[k][1] + [symbol]))
    return [sequence for k, (_, sequence) in enumerate(nodes) if k not in gone]


class Edge:
    def __init__(self, start, end, apex):
        self.start, self.end, self.apex = start, end, apex
        self.state = "active"

    def put(self, before, after):
        self.before, self.after = before, after
        before.after = after.before = self


def connectivity(codes, splits, triangles):
    """Triangles and the predictors of each vertex met."""
    faces, corners, queue, delayed, urgent = [], [], [], [], None
    codes = iter(codes)

    def meet(code, a, b, apex):
        if code == VERTEX:
            corners.append((a, b, apex))
            return len(corners) - 1
        assert code == SPLIT
        return splits.take((len(corners) - 1).bit_length())

    while len(faces) < triangles:
        while queue and queue[0].state != "active":
            queue.pop(0)
        while not queue and delayed and delayed[0].state != "delayed":
            delayed.pop(0)
        edge = urgent or (queue or delayed or [None])[0]
        urgent = None
        if edge is None:
            last = len(corners) - 1
            a = meet(next(codes), last, last, last)
            b = meet(next(codes), a, a, a)
            c = meet(next(codes), b, b, b)
            faces.append((a, b, c))
            ab, bc, ca = Edge(a, b, c), Edge(b, c, a), Edge(c, a, b)
            ab.put(ca, bc), bc.put(ab, ca), ca.put(bc, ab)
            queue += [ab, bc, ca]
            continue
        code = next(codes)
        edge.state = "delayed" if code == DELAY else "done"
        if code == DELAY:
            delayed.append(edge)
        elif code in (LEFT, RIGHT):
            other = edge.after if code == RIGHT else edge.before
            other.state = "done"
            if code == RIGHT:
                urgent = Edge(edge.start, other.end, edge.end)
                faces.append((edge.end, edge.start, other.end))
                urgent.put(edge.before, other.after)
            else:
                urgent = Edge(other.start, edge.end, edge.start)
                faces.append((edge.end, edge.start, other.start))
                urgent.put(other.before, edge.after)
            queue.append(urgent)
        elif code != SKIP:
            tip = meet(code, edge.start, edge.end, edge.apex)
            faces.append((edge.end, edge.start, tip))
            left, urgent = Edge(edge.start, tip, edge.end), Edge(tip, edge.end, edge.start)
            before, after = edge.before, edge.after
            left.put(before, edge), urgent.put(left, after)
            queue += [left, urgent]
    return faces, corners


def decode(data):
    """Positions and triangles of a patch with one class a vertex; normals and colours are not read."""
    stream = Bytes(data)
    flags, word_bits, _ = stream.byte(), stream.byte(), stream.byte()
    assert not flags & 4
    vertices, triangles, count = stream.number(), stream.number(), stream.number()
    base = [stream.signed() for _ in range(3)]
    codes = stream.symbols(count, word_bits)
    faces, corners = connectivity(codes, Bits(stream.raw()), triangles)
    corners += [(i - 1, i - 1, i - 1) for i in range(len(corners), vertices)]
    classes = stream.symbols(vertices, word_bits)
    raw = Bits(stream.raw())
    positions = []
    for k, (a, b, apex) in zip(classes, corners, strict=True):
        difference = [raw.take(k) - (1 << k) // 2 for _ in range(3)]
        guess = base
        if a >= 0:
            guess = [positions[a][j] + positions[b][j] - positions[apex][j] for j in range(3)]
        positions.append([(g + d + 2**31) % 2**32 - 2**31 for g, d in zip(guess, difference, strict=True)])
    return positions, faces
