"""The output of a study: its page, and designs as options or a piece of a scene."""
