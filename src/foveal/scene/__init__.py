"""What joins the rooms: scene.json, views, cached builds, publish, export, render, info."""

from .asset_names import asset_names
from .scene import Layer, Scene, View, read_scene, scene_json, scene_of, write_scene

__all__ = ["Layer", "Scene", "View", "asset_names", "read_scene", "scene_json", "scene_of", "write_scene"]
