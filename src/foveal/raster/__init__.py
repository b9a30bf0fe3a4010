"""The CPU rasteriser: deterministic pictures without a GPU or a display."""
