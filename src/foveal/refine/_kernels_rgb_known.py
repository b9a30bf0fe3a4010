# mypy: allow-untyped-defs, allow-untyped-calls
"""What is known of a vertex, and the list of what has to be known first."""

from foveal.base.jit import lean

from ._kernels_rgb_layout import BORN, LIMIT, STACK

#: What is asked of a vertex: where it was born, its limit.
ASK_BORN, ASK_LIMIT = 0, 1


@lean
def is_known(net, v, level):
    """Whether it is known where v is on a level not below its birth."""
    flags = net.vertices[v].flags
    return (flags & LIMIT) != 0 or ((flags & BORN) != 0 and net.vertices[v].birth == level)


@lean
def push(net, top, v, ask):
    """Ask something of a vertex before what is on the stack; returns the new top."""
    net.counts[STACK + top] = 2 * v + ask
    return top + 1


@lean
def push_unknown(net, top, v, level):
    """Ask for where v is on a level, if it is not known yet."""
    if is_known(net, v, level):
        return top
    return push(net, top, v, ASK_BORN if net.vertices[v].flags & BORN == 0 else ASK_LIMIT)


@lean
def set_born(net, v, x, y, z):
    """Where a vertex was born."""
    vertex = net.vertices[v]
    vertex.born[0], vertex.born[1], vertex.born[2] = x, y, z
    net.vertices[v].flags |= BORN
