"""Ground floor: compilation, validation, progress, tasks, files, errors. Knows no geometry."""
