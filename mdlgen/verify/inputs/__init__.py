"""What is verified: a scene, the files that were given, and what of them is the scene's."""
