"""What joins the rooms: scene.json, views, publish."""
