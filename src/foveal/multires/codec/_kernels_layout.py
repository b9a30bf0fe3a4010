# mypy: allow-untyped-defs, allow-untyped-calls
"""Numbers that encoder, decoder and specification share. `spec/patch.md` explains each.

Its name begins like the kernels' because their machine code holds these numbers: `base/jit.py` looks at it.
"""

# Codes of the region growing, one a triangle or boundary edge.
NEW, RIGHT, LEFT, END, BOUNDARY, SPLIT, MET, SPLIT_NEXT, SPLIT_PREVIOUS, START = range(10)
CODES = 9  # START is never coded

#: Contexts of a code: (degree of the gate's head, of its tail, last code), or where a neighbour is dead.
HEAD_DEGREES, TAIL_DEGREES, LAST_CODES = 7, 6, 10
DEAD_CONTEXTS = HEAD_DEGREES * TAIL_DEGREES * LAST_CODES
CODE_CONTEXTS = DEAD_CONTEXTS + 3 * HEAD_DEGREES

#: A far walk along the front is named by the slot instead.
WALK_NEXT, WALK_PREVIOUS, WALK_FAR = 16, 15, 31

# The kind of a vertex: what follows the triangle that brings it in. The last two are yet to be decided;
# where no code follows, they count as FOLLOWED_OTHER and FOLLOWED_RIGHT.
FOLLOWED_NEW, FOLLOWED_RIGHT, FOLLOWED_RIGHTS, FOLLOWED_OTHER, AT_DEAD, FIRST, FRESH, FRESH_RIGHT = range(8)
KINDS = 5
#: Degrees 4 and less, 5, 6, 7, 8 and more.
DEGREES, LEAST_DEGREE = 5, 4
#: Weights of a prediction are in 64ths.
WEIGHT_BITS = 6
#: Per kind: a base, then corrections by degree of a, b and the new vertex; each for the points b, o, n, p.
WEIGHT_ROWS = 1 + 3 * DEGREES

#: Classes of a length, two an octave.
SCALES = 64
SMALL_SCALES = 16

#: Values -31 to 31 have a symbol each, symbol 63 announces any other.
SYMBOLS, ESCAPE, MIDDLE = 64, 63, 31

# Contexts, one after the other.
CODE_AT = 0
WALK_AT = CODE_AT + CODE_CONTEXTS
ALONG_AT = WALK_AT + 1
ACROSS_AT = ALONG_AT + SCALES * DEGREES
COLOUR_AT = ACROSS_AT + SCALES
NORMAL_AT = COLOUR_AT + 3 * SMALL_SCALES
COARSE_AT = NORMAL_AT + 4 * SMALL_SCALES
CONTEXTS = COARSE_AT + 2

#: A patch's coarse grid has steps of at most 2^15.
MOST_COARSE = 15

#: Probabilities are in 2^-PROBABILITY_BITS.
PROBABILITY_BITS = 11
