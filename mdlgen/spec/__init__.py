"""The scene as a user writes it: one noun per file, validated by pydantic, held in internal units."""
