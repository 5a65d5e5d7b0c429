"""Execution of cases: by processes of this machine or a cluster, each stored as it ends."""
