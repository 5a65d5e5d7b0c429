"""Each value of a text changed, in the text and in the scene, and what comes of it."""
