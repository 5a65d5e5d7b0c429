"""A local page that follows a scene's file, runs it again as its values are changed, and writes them back."""
