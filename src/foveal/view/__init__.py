"""Camera, frustum and projected size.

Called, `foveal.view(...)` is the verb that shows something in the viewer: `help(foveal.server.view)`.
"""
