"""Integer and entropy streams; knows no geometry."""
