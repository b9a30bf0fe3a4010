"""A slow reader of coded trees, by spec/shadows.md: cells by their place, not by links."""

import itertools
from collections import defaultdict

FAR = 2**32 - 1
FROM = {"SPLIT": 0, "HAS": 16384, "SAME": 49152, "FAR": 49280, "BITS": 49284, "LOST": 49428, "STOP": 49436}


class Bits:
    def __init__(self):
        self.chances = defaultdict(lambda: (32768, 32768))

    def begin(self, data):
        self.data, self.at, self.width, self.value = data, 4, 2**32 - 1, int.from_bytes(data[:4], "big")

    def bit(self, context):
        q, s = self.chances[context]
        b = self.width // 4096 * ((q + s) // 32)
        bit = int(self.value >= b)
        if bit:
            self.value, self.width = self.value - b, self.width - b
            self.chances[context] = q - q // 16, s - s // 128
        else:
            self.width = b
            self.chances[context] = q + (65536 - q) // 16, s + (65536 - s) // 128
        while self.width < 2**24:
            byte = self.data[self.at] if self.at < len(self.data) else 0
            self.value, self.width, self.at = self.value * 256 + byte, self.width * 256, self.at + 1
        return bit


def value_of(bits, held, beyond, split):
    guesses = [value for value in dict.fromkeys(beyond) if value != held]
    for g, guess in enumerate(guesses):
        if bits.bit(FROM["SAME"] + (g * 8 + beyond.count(guess)) * 2 + split):
            return guess
    if bits.bit(FROM["FAR"] + 2 * (held == FAR) + split):
        return FAR
    texts = [f"{guess + 1:032b}"[-32:] for guess in [*guesses, held, held][:2]]
    read, p, q = "", 0, 0
    for d in range(32):
        a, b = (0 if lost else 1 + int(text[d]) for lost, text in ((p, texts[0]), (q, texts[1])))
        holds = p == 0 or q == 0
        bit = bits.bit(FROM["BITS"] + 16 * (3 * a + b) + min(d, 15) if holds else FROM["LOST"] + min(p, q, 7))
        read += str(bit)
        p, q = (
            lost + 1 if lost or text[d] != str(bit) else 0 for lost, text in ((p, texts[0]), (q, texts[1]))
        )
        if bit and bits.bit(FROM["STOP"] + 16 * (8 * min(p, q, 7) + min(max(p, q), 7)) + min(d, 15)):
            break
    return max(int(read.ljust(32, "0"), 2), 1) - 1


def decode(levels, children, root, parts, chunks):
    """Masks and values of each level, of a whole file."""
    dims = 3 if children == 8 else 2
    bits = Bits()
    masks, values = [], []
    ends = dict(zip([0, *(part + 1 for part in parts)], chunks, strict=False))
    bits.begin(ends[0])
    values.append([value_of(bits, FAR, [], int(root == 3))])
    nodes = {(0,) * dims: root == 3} if root == 3 else {}  # by place: whether it has a value itself
    known = {(0,) * dims: values[0][0]}  # of every cell of this level that a node with children has

    def value_at(table, level, place):
        """The value at a place of a level, or of the square it lies in that was divided no further."""
        if any(not 0 <= c < 1 << level for c in place):
            return values[0][0]
        while place not in table[level]:
            place, level = tuple(c // 2 for c in place), level - 1
        return table[level][place]

    table = [known]
    for level in range(levels):
        if level + 1 in ends:
            bits.begin(ends[level + 1])
        last = int(level == levels - 1)
        cells = {}
        for place in nodes:
            for i in range(children):
                cells[tuple(2 * c + (i >> axis & 1) for axis, c in enumerate(place))] = table[level][place]
        table.append(cells)
        masks.append([])
        values.append([])
        below = {}
        for place, inner in nodes.items():
            held, kinds = table[level][place], []
            for i in range(children):
                cell = tuple(2 * c + (i >> axis & 1) for axis, c in enumerate(place))
                beyond = [
                    value_at(table, level + 1, tuple(c + step * (k == axis) for k, c in enumerate(cell)))
                    for step, axis in itertools.product((-1, 1), range(dims))
                ]
                others = sum(value != held for value in beyond)
                history = sum(kind << 2 * k for k, kind in enumerate(kinds[::-1])) % 64
                c = (((2 * last + inner) * 8 + i) * 64 + history) * 8 + others
                split = 0 if last else bits.bit(FROM["SPLIT"] + c)
                has = bits.bit(FROM["HAS"] + 2 * c + split)
                kinds.append(2 * split + has)
                if has:
                    cells[cell] = value_of(bits, held, beyond, split)
                    values[-1].append(cells[cell])
                if split:
                    below[cell] = bool(has)
            masks[-1].append(sum(kind << 2 * i for i, kind in enumerate(kinds)))
        nodes = below
    return masks, values
