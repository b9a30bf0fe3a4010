"""The patch codec as published, kept to measure foveal's own against.

Based on: Ponchio and Dellepiane, Fast decompression for web-based view-dependent 3D rendering, 2015,
sections 3.3 and 3.4. Each patch alone: connectivity by a region that grows in spirals, one code an
edge; positions by the parallelogram rule; colours in luma and chroma as the difference to a corner of
the edge; normals as the difference to those of the decoded geometry; all differences as a log2 class
and raw bits; codes and classes by Tunstall.

Where the text leaves something open, or its letter does not work:

- VERTEX with a vertex met before is a code of its own, SPLIT, as the decoder must tell the two apart.
- A component begins where the queue is empty, with three VERTEX or SPLIT codes for its first triangle.
- DELAY, which is in the published program but not in the paper, leaves an edge for when the queue is
  empty, if it would be a split. Without it a quarter of the dragon's vertices are splits; with it two in
  a hundred, which is one in a hundred triangles, as the paper says.
- The one class a vertex of the published program is the default; one a component, which the text
  could mean, is an option.
- Colours are not quantised further, and the transform is one that whole numbers undo.

The bytes: flags, bits of Tunstall's words, bits of normals (a byte each); vertices, triangles, codes
(numbers); the first vertex's position (three signed numbers); codes (symbols); indices of splits (raw
bits); then positions, normals, colours as far as they are there, each as classes (symbols) and raw
bits, component by component where they have classes of their own. `streams` says how these are written.
"""

from .decode import decode
from .encode import encode, stream_sizes

__all__ = ["decode", "encode", "stream_sizes"]
