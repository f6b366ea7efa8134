import documents  # noqa: F401  puts plots/ on the path, for all tests
