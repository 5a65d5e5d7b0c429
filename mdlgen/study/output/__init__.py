"""What a study leaves: its page, and designs as options or a piece of a scene."""
