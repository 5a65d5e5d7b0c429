"""What the user writes: one noun per file, validated by pydantic, held in internal units."""
