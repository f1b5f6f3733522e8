"""Communication graphs: named ones, ones from a file, and what their Laplacian says."""
