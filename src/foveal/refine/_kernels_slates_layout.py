# mypy: allow-untyped-defs, allow-untyped-calls
"""How a slate's points and a corner's ring lie in memory, and the small numbers that name kinds of things.

A slate holds LANES patches of one depth side by side: of a point the x of all lanes, then the y, then the z,
so that each rule of the table is a loop over twelve numbers without branches. Four lanes computed 53 million
triangles a second of a torus at depth 3, eight 49, and a slate for one patch alone, row by row, has rows too
short for vectors.

A ring is a vertex, its spokes e_0 .. and the vertices f_0 .. across its faces, x, y, z each, in the order
that the control mesh gives it, whichever patch looks.
"""

LANES = 4
WORDS = 3 * LANES
"""Numbers a point of the table takes."""

MOST_DEPTH = 8
"""Steps at most: 65,536 quadrangles for one."""

REGULAR, SMOOTH, TAGGED = 0, 1, 2
"""Kinds of a control vertex: four smooth faces around it; another number; a border, a crease, a corner."""

INFINITE = 10.0
"""A sharpness that does not decrease."""

LIMIT_SHARE = 1.0 / 36.0
"""Of 16 v + 4 sum e + sum f, the limit point of a vertex of four faces. A product: a division took longer."""
