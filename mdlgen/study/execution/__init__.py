"""How cases are run: by processes of this machine or a cluster, each kept as it ends."""
