"""The numbers of the lattice solver: each is halved and doubled on twelve short scenes."""
