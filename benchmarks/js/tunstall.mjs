/**
 * Tunstall's code in JavaScript, for measuring: the same tables as `foveal.coding.tunstall` builds.
 *
 * All products stay below 2^53, so doubles are exact: chances are whole numbers of 2^-32, weights of 2^-16.
 */

/** Start and size of each word's sequence, and all sequences in a row, eight symbols longer than they are. */
export function buildTunstall(frequencies, wordBits) {
  const symbols = [...frequencies.keys()].filter((s) => frequencies[s] > 0);
  symbols.sort((a, b) => frequencies[b] - frequencies[a] || a - b);
  const m = symbols.length;
  const total = symbols.reduce((sum, s) => sum + frequencies[s], 0);
  const weights = symbols.map((s) => Math.max(1, Math.floor((frequencies[s] * 65536) / total)));
  const columns = 1 + Math.floor(((1 << wordBits) - m) / (m - 1));
  const chances = new Float64Array(columns * m);
  const lengths = new Int32Array(columns * m);
  const parents = new Int32Array(columns);
  const heads = new Int32Array(m);
  for (let rank = 0; rank < m; rank++) {
    chances[rank] = weights[rank] * 65536;
    lengths[rank] = 1;
  }
  for (let column = 1; column < columns; column++) {
    let best = 0;
    let chance = -1;
    for (let rank = 0; rank < m; rank++) {
      const candidate = heads[rank] < column ? chances[heads[rank] * m + rank] : -1;
      if (candidate > chance) {
        chance = candidate;
        best = rank;
      }
    }
    const parent = heads[best]++ * m + best;
    parents[column] = parent;
    for (let rank = 0; rank < m; rank++) {
      chances[column * m + rank] = Math.floor((chance * weights[rank]) / 65536);
      lengths[column * m + rank] = lengths[parent] + 1;
    }
  }
  return { wordBits, ...fillTable(symbols, columns, parents, heads, lengths) };
}

function fillTable(symbols, columns, parents, heads, lengths) {
  const m = symbols.length;
  let words = 0;
  let size = 0;
  for (let column = 0; column < columns; column++) {
    for (let rank = 0; rank < m; rank++) {
      if (column < heads[rank]) continue; // expanded, so no word
      words++;
      size += lengths[column * m + rank];
    }
  }
  const starts = new Int32Array(words);
  const sizes = new Int32Array(words);
  const table = new Uint8Array(size + 8);
  let longest = 0;
  let word = 0;
  let at = 0;
  for (let column = 0; column < columns; column++) {
    let kept = -1; // where the sequence of the column's last word begins
    for (let rank = 0; rank < m; rank++) {
      if (column < heads[rank]) continue;
      const length = lengths[column * m + rank];
      starts[word] = at;
      sizes[word++] = length;
      if (length > longest) longest = length;
      if (kept >= 0) {
        table.copyWithin(at, kept, kept + length - 1);
      } else {
        let here = parents[column];
        for (let k = at + length - 2; k >= at; k--) {
          table[k] = symbols[here % m];
          here = parents[(here / m) | 0];
        }
      }
      table[at + length - 1] = symbols[rank];
      kept = at;
      at += length;
    }
  }
  return { starts, sizes, table, longest };
}

/** Fill `out` from `bytes`; throws a RangeError where they end too early or name a word that is not there. */
export function decodeTunstall({ wordBits, starts, sizes, table, longest }, bytes, out) {
  const mask = (1 << wordBits) - 1;
  const count = out.length;
  const inside = count - longest;
  let held = 0;
  let filled = 0;
  let next = 0;
  let at = 0;
  while (at < count) {
    while (filled < wordBits) {
      if (next >= bytes.length) throw new RangeError("the words end too early");
      held |= bytes[next++] << filled;
      filled += 8;
    }
    const word = held & mask;
    held >>>= wordBits;
    filled -= wordBits;
    if (word >= starts.length) throw new RangeError("a word that the code does not have");
    const begin = starts[word];
    const size = at <= inside ? sizes[word] : Math.min(sizes[word], count - at);
    for (let k = 0; k < size; k++) out[at + k] = table[begin + k];
    at += size;
  }
}
