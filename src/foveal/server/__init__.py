"""HTTP on localhost: byte ranges, the viewer, the scene."""
