"""Camera, frustum and projected size."""
