"""Multiresolution patches: partition, simplify, bound, encode, build."""
