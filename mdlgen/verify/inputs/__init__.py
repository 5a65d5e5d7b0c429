"""The inputs of a verification: a scene, the files that were given, and the scene's part of them."""
