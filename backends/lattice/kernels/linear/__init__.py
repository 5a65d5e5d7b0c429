"""Systems of linear equations: dense matrices, bands of blocks, their borders and couplings."""
