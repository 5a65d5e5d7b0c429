"""A local page that follows a scene's file, runs it anew as its values are turned, and writes them back."""
