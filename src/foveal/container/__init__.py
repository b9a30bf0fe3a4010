"""The .fov file: header, index, chunks with checksums."""
