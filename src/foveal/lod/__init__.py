"""The view-dependent cut of a patch graph, by projected error and budgets."""
