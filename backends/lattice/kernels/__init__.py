"""All compiled code of this solver; what Python calls of it stands in `entries`."""
